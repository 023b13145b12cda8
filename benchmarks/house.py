"""Measure the house: how the code is cut, laid out and documented, a row a measure.

    python -m benchmarks.house

The limits are those that `tests/test_house.py` holds the code to.
"""

from __future__ import annotations

import ast
import configparser
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import networkx as nx

from benchmarks.common import without_options

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("tamp", "grounding")
AIR_FROM_LINES = 20
"""Lines of code from which on a function should have a blank line or a comment."""

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Measure:
    """A row: what is measured, today's value, and the limit ("<=" or ">=" and a number)."""

    name: str
    value: float
    limit: str

    @property
    def holds(self) -> bool:
        sign, number = self.limit.split()
        return self.value <= float(number) if sign == "<=" else self.value >= float(number)

    @property
    def shown(self) -> str:
        return f"{self.value:.3f}".rstrip("0").rstrip(".")


def sources(*folders: str) -> list[Path]:
    files = sorted(file for folder in folders for file in (ROOT / folder).rglob("*.py"))
    assert files, folders
    return files


def functions() -> Iterator[tuple[Function, list[str]]]:
    """Yield the functions of both packages, each with the lines of its body, its docstring aside."""
    for file in sources(*PACKAGES):
        text = file.read_text(encoding="utf-8")
        lines = text.splitlines()
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, Function):
                body = node.body[1:] if ast.get_docstring(node) is not None else node.body
                first = body[0].lineno - 1 if body else node.end_lineno
                yield node, [line.strip() for line in lines[first : node.end_lineno]]


def entries_at_top() -> int:
    """Count folders and Python files at the top of `tamp`, `__init__` aside."""
    return sum(
        (one.is_dir() and any(one.rglob("*.py"))) or (one.suffix == ".py" and one.stem != "__init__")
        for one in (ROOT / "tamp").iterdir()
    )


def layers() -> list[str]:
    """Return the layers of `tamp` from `.importlinter`, the highest first."""
    parser = configparser.ConfigParser()
    parser.read(ROOT / ".importlinter", encoding="utf-8")
    return parser["importlinter:contract:layers"]["layers"].split("\n")[1:]


def names_of_modules() -> dict[str, Path]:
    """Return the file of each module by its dotted name."""
    return {
        ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): file
        for file in sources(*PACKAGES)
    }


def imports(*, late: bool) -> nx.DiGraph:
    """Return which module imports which, those for types aside; `late` ones in functions, too."""
    graph = nx.DiGraph()
    names = names_of_modules()
    for name, file in names.items():
        tree = ast.parse(file.read_text(encoding="utf-8"))
        skipped = {
            id(inner)
            for node in ast.walk(tree)
            if (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test))
            or (isinstance(node, Function) and not late)
            for inner in ast.walk(node)
        }
        for node in ast.walk(tree):
            if id(node) in skipped:
                continue
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                whole = [f"{node.module}.{one.name}" for one in node.names]
                graph.add_edges_from((name, one if one in names else node.module) for one in whole)
            elif isinstance(node, ast.Import):
                graph.add_edges_from((name, one.name) for one in node.names)
    return graph.subgraph(names)


def circles() -> list[list[str]]:
    """Return groups of modules that import each other, those within functions included."""
    return [sorted(group) for group in nx.strongly_connected_components(imports(late=True)) if len(group) > 1]


def upward() -> list[tuple[str, str]]:
    """Return imports between folders of `tamp` that run up the layers."""
    floor = {part.strip(): number for number, line in enumerate(layers()) for part in line.replace("|", ":").split(":")}
    return [
        (one, other)
        for one, other in imports(late=True).edges
        if one.startswith("tamp.") and other.startswith("tamp.")
        and floor[one.split(".")[1]] > floor[other.split(".")[1]]
    ]  # fmt: skip


def _named(node: ast.AST) -> Iterator[str]:
    """Yield modules that an import names, or a string of code that is run in a process of its own."""
    if isinstance(node, ast.ImportFrom) and node.module:
        yield node.module
        yield from (f"{node.module}.{one.name}" for one in node.names)
    elif isinstance(node, ast.Import):
        yield from (one.name for one in node.names)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield from re.findall(r"\b(?:tamp|grounding)(?:\.\w+)+", node.value)


def untested() -> list[str]:
    """Return modules that no test asks directly: none names them, and no test file has their name."""
    tests = {file: file.read_text(encoding="utf-8") for file in (ROOT / "tests").rglob("*.py")}
    own = {file.stem.removeprefix("test_") for file in tests}
    asked = {name for text in tests.values() for node in ast.walk(ast.parse(text)) for name in _named(node)}
    return [
        name
        for name, file in names_of_modules().items()
        if file.stem != "__init__" and file.stem not in own and name not in asked
    ]


DECISIONS = (
    ast.If, ast.IfExp, ast.Match, ast.BoolOp, ast.Compare, ast.While, ast.For, ast.comprehension, ast.Try,
)  # fmt: skip
"""What a function decides something by."""


def decides(file: Path) -> bool:
    """Check that a function of a module holds a branch, a loop or a comparison."""
    return any(
        isinstance(inner, DECISIONS)
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        for inner in ast.walk(node)
    )


def file_of_tests(module: str) -> Path:
    """Return where the tests of a module lie: tests/ mirrors tamp/, and grounding/ in a folder of that name."""
    words = module.removeprefix("tamp.").split(".")
    return (ROOT / "tests").joinpath(*words[:-1], f"test_{words[-1]}.py")


def without_test_file() -> list[str]:
    """Return modules that decide something and have no test file of their name in the mirrored folder."""
    return [
        name
        for name, file in names_of_modules().items()
        if file.stem not in ("__init__", "__main__") and decides(file) and not file_of_tests(name).is_file()
    ]


def lines_of(*folders: str) -> int:
    return sum(len(file.read_text(encoding="utf-8").splitlines()) for file in sources(*folders))


def measures() -> list[Measure]:
    """Measure everything."""
    bodies = [lines for _, lines in functions()]
    longer = [lines for lines in bodies if len(lines) >= AIR_FROM_LINES]
    dense = [lines for lines in longer if all(line and not line.startswith("#") for line in lines)]
    docstrings = [text for node, _ in functions() if (text := ast.get_docstring(node))]
    verbs = [text for text in docstrings if opens_with_verb(text)]
    every = [line for file in sources(*PACKAGES) for line in file.read_text(encoding="utf-8").splitlines()]
    return [
        Measure("entries at the top of tamp/", entries_at_top(), "<= 16"),
        Measure("imports up the layers", len(upward()), "<= 0"),
        Measure("import circles", len(circles()), "<= 0"),
        Measure("lines of the layers", len(layers()), "<= 15"),
        Measure("functions of 20+ lines without air, share", len(dense) / len(longer), "<= 0.05"),
        Measure("lines over 100 characters", sum(len(line) > 100 for line in every), "<= 0"),
        Measure(
            "docstrings of functions that open with a verb, share",
            len(verbs) / len(docstrings), ">= 0.99",
        ),
        Measure("modules that no test asks directly", len(untested()), "<= 3"),
        Measure("modules that decide something without a test file of their name", len(without_test_file()), "<= 0"),
        Measure("longest function, lines", max(map(len, bodies)), "<= 60"),
        Measure(
            "lines of tests a line of source", lines_of("tests") / lines_of(*PACKAGES), ">= 0.6"
        ),
    ]  # fmt: skip


NO_VERB = {
    "a", "all", "an", "and", "any", "as", "at", "both", "by", "each", "every", "few", "for",
    "from", "if", "in", "its", "least", "many", "most", "my", "no", "none", "not", "nothing",
    "of", "on", "one", "only", "or", "our", "some", "such", "than", "that", "the", "their",
    "there", "these", "this", "those", "to", "two", "what", "when", "where", "whether", "which",
    "while", "who", "whose", "why", "how", "with", "within", "without",
}  # fmt: skip
"""First words of docstrings that are no verbs, beside what ruff's D401 tells."""


def first_word(docstring: str) -> str:
    """Return the first word of a docstring as it stands, without punctuation at its end."""
    return docstring.split()[0].rstrip(".,:;") if docstring.split() else ""


def opens_with_verb(docstring: str) -> bool:
    """Check that a docstring opens with a capitalized word which can be a verb, and no plural."""
    word = first_word(docstring)
    named = "_" in word or "'" in word or word.isupper()
    plural = word.endswith("s") and not word.endswith("ss")
    return word[:1].isupper() and not named and not plural and word.lower() not in NO_VERB


if __name__ == "__main__":
    without_options(__doc__)
    for one in measures():
        print(f"{one.name:55} {one.shown:>8}   {one.limit:>8}{'' if one.holds else '   NOT HELD'}")
