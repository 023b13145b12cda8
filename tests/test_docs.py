"""The documents name what there is: every folder of the code is in the map, every path and name in them exists."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from benchmarks import module_index

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted([*ROOT.glob("docs/*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
MAP = ROOT / "docs" / "how-it-works.md"
README = ROOT / "README.md"
PATHS = re.compile(
    r"(?<![\w/.-])((?:tamp|grounding|tests|benchmarks|examples|domains|problems|docs)/[\w./-]*\w/?)(?![\w*<>{}])"
)


def rows(page: Path, heading: str, until: str) -> list[tuple[str, str, str]]:
    """The rows of all tables between two headings of a page (`until` without its words)."""
    text = page.read_text(encoding="utf-8").partition(f"\n{heading}\n")[2]
    text = text.partition(f"\n{until} ")[0]

    found: list[tuple[str, str, str]] = []
    for part in text.split("\n\n"):
        lines = part.strip().splitlines()
        if lines and lines[0].startswith("| "):
            cells = [line.strip("| ").split(" | ") for line in lines[2:]]
            found.extend((row[0], row[1], row[2]) for row in cells)
    return found


def named(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


FOLDERS = [(named(folder)[0], named(files)) for _, folder, files in rows(MAP, "## The map", "###")]
DECISIONS = [
    (question, named(file)[0], named(name)[0])
    for question, file, name in rows(README, "## Where is it in the code?", "##")
]
ASIDES = [
    (question, file, name)
    for question, _, _ in DECISIONS
    for name, file in re.findall(r"`(\w+)` in `((?:tamp|grounding)/[\w/]+\.py)`", question)
]


def test_every_module_is_in_a_folder_that_the_map_names() -> None:
    modules = [path for path in (ROOT / "tamp").rglob("*.py") if path.name != "__init__.py"]
    assert len(modules) > 200

    folders = {folder for folder, _ in FOLDERS}
    lost = {
        str(path.relative_to(ROOT))
        for path in modules
        if str(path.parent.relative_to(ROOT)) not in folders
    }
    assert lost == set()


@pytest.mark.parametrize(("folder", "files"), FOLDERS, ids=[folder for folder, _ in FOLDERS])
def test_the_map_names_folders_and_first_files_that_exist(folder: str, files: list[str]) -> None:
    assert files
    assert [file for file in files if not (ROOT / folder / file).is_file()] == []


@pytest.mark.parametrize("folder", [folder for folder, _ in FOLDERS])
def test_every_folder_says_in_one_line_what_it_is_for(folder: str) -> None:
    said = ast.get_docstring(ast.parse((ROOT / folder / "__init__.py").read_text(encoding="utf-8")))
    assert said and len(said.splitlines()[0]) > 20


@pytest.mark.parametrize(
    ("question", "file", "name"),
    [*DECISIONS, *ASIDES],
    ids=[name for _, _, name in [*DECISIONS, *ASIDES]],
)
def test_what_decides_is_where_the_map_says(question: str, file: str, name: str) -> None:
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    defined = {
        node.name
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
    }
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        defined |= {target.id for target in targets if isinstance(target, ast.Name)}
    assert name in defined, f"{question}: {file} defines no {name}"


def test_the_page_of_modules_is_that_of_the_code() -> None:
    written = module_index.PAGE.read_text(encoding="utf-8")
    assert written == module_index.index(), "python -m benchmarks.module_index writes it"
    assert written.count("\n| `") > 500
    assert "`verify.py`" in written and "`LIKELY_PROBABILITY`" in written


def test_every_table_of_decisions_is_read() -> None:
    """The tables lie under headings of their own: a reader of the first one alone would miss the others."""
    files = {file.split("/")[1] for _, file, _ in DECISIONS if file.startswith("tamp/")}
    assert {"commands", "geometric", "symbolic", "verification", "execution", "view"} <= files
    assert len(DECISIONS) > 100
    assert len(ASIDES) > 5


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_paths_that_a_page_names_exist(page: Path) -> None:
    text = re.sub(
        r"\]\([^)]*\)", "]", page.read_text(encoding="utf-8")
    )  # links: test_readme follows them
    missing = {path for path in PATHS.findall(text) if not (ROOT / path).exists()}
    assert missing == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_modules_that_a_page_names_exist(page: Path) -> None:
    """`tamp.system.reading`, `python -m benchmarks.search`, `grounding.collect`: the longest part that is a module."""
    for dotted in re.findall(
        r"\b((?:tamp|grounding|benchmarks)(?:\.[a-z_0-9]+)+)\b", page.read_text(encoding="utf-8")
    ):
        words = dotted.split(".")
        if words[-1] in {"py", "md", "json", "jsonl", "toml", "pddl", "yaml"}:
            continue
        module = ROOT.joinpath(*words)
        parent = ROOT.joinpath(*words[:-1])
        found = [
            path for path in (module, parent) if path.is_dir() or path.with_suffix(".py").is_file()
        ]
        assert found, f"{dotted} is no module"
        if found[0] == parent:
            source = parent / "__init__.py" if parent.is_dir() else parent.with_suffix(".py")
            assert words[-1] in source.read_text(encoding="utf-8"), (
                f"{dotted}: {source} has no {words[-1]}"
            )


def test_tests_stand_in_the_folders_of_what_they_test() -> None:
    shared = {"random_streams"}
    """Helpers of several folders' tests."""
    folders = {path.parent.relative_to(ROOT / "tests") for path in (ROOT / "tests").rglob("*.py")}
    strange = {
        str(folder)
        for folder in folders
        if not (
            (ROOT / "tamp" / folder).is_dir() or (ROOT / folder).is_dir() or str(folder) in shared
        )
    }
    assert strange == set()
    assert (ROOT / "tests" / "geometric" / "robot").is_dir()


def test_readme_and_contributing_lead_to_the_map() -> None:
    for page in ("README.md", "CONTRIBUTING.md"):
        assert "docs/how-it-works.md#the-map" in (ROOT / page).read_text(encoding="utf-8")
