"""The language of the code: docstrings that open with a verb, air, short lines, short functions."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.house import first_word, opens_with_verb

ROOT = Path(__file__).parent.parent

VERB_FOLDERS = ("grounding", "tamp")
"""Folders whose docstrings open with a verb."""

AIR_FOLDERS = ("grounding", "tamp")
"""Folders whose lines are short, and whose longer functions have air."""

LINE_CHARACTERS = 100
FUNCTION_LINES = 60
LONGER: set[str] = set()
"""Functions that are longer still, to be split: nothing may be added."""

AIR_FROM_LINES = 20
"""Lines of code from which on a function has a blank line or a comment between its steps."""

RELATIVE = {
    "what", "whether", "where", "which", "who", "whose", "why", "how", "when", "that", "of",
}  # fmt: skip
"""First words with which no docstring of a module or class begins."""

Documented = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def _files(folder: str) -> list[Path]:
    files = sorted((ROOT / folder).rglob("*.py"))
    assert files, f"{folder} has no files: the list of folders is out of date"
    return files


def _nodes(folder: str) -> Iterator[tuple[str, Documented, list[str]]]:
    """Yield the place of each module, class and function, its node, and the lines of its file."""
    for path in _files(folder):
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, Documented):
                line = getattr(node, "lineno", 1)
                yield f"{path.relative_to(ROOT)}:{line}", node, text.splitlines()


def _code(node: ast.FunctionDef | ast.AsyncFunctionDef) -> range:
    """Return the lines of a function's body, its docstring aside, counted from 1."""
    documented = ast.get_docstring(node) is not None
    body = node.body[1:] if documented else node.body
    return range(body[0].lineno, (node.end_lineno or 0) + 1) if body else range(0)


@pytest.mark.parametrize(
    ("docstring", "verb"),
    [
        ("Return the pose.", True),
        ("Cross-validate a classifier.", True),
        ("The pose.", False),
        ("Whether it holds.", False),
        ("`count` poses.", False),
        ("T_world_body (4, 4).", False),
        ("PDDL's names.", False),
        ("Wilson's interval.", False),
        ("Rotations (n, 3, 3).", False),
        ("Pass the pose on.", True),
        ("", False),
    ],
)
def test_the_first_word_is_judged(docstring: str, verb: bool) -> None:
    assert opens_with_verb(docstring) == verb


@pytest.mark.parametrize("folder", VERB_FOLDERS)
def test_docstrings_of_functions_open_with_a_verb(folder: str) -> None:
    wrong, count = [], 0
    for place, node, _ in _nodes(folder):
        docstring = ast.get_docstring(node)
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or docstring is None:
            continue
        count += 1
        if not opens_with_verb(docstring):
            wrong.append(f"{place}: {docstring.splitlines()[0]}")

    assert count
    assert len(wrong) <= 0.01 * count, "\n".join(wrong)


@pytest.mark.parametrize("folder", VERB_FOLDERS)
def test_no_docstring_of_a_module_or_class_opens_with_a_relative_clause(folder: str) -> None:
    wrong = [
        f"{place}: {docstring.splitlines()[0]}"
        for place, node, _ in _nodes(folder)
        if isinstance(node, ast.Module | ast.ClassDef)
        and (docstring := ast.get_docstring(node))
        and first_word(docstring).lower() in RELATIVE
    ]
    assert not wrong, "\n".join(wrong)


def test_docstrings_are_in_the_imperative_mood() -> None:
    found = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--select", "D401", "--no-cache", *VERB_FOLDERS],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 0, found.stdout + found.stderr


@pytest.mark.parametrize("folder", AIR_FOLDERS)
def test_longer_functions_have_air(folder: str) -> None:
    dense, count = [], 0
    for place, node, lines in _nodes(folder):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        code = _code(node)
        if len(code) < AIR_FROM_LINES:
            continue
        count += 1
        texts = [lines[number - 1].strip() for number in code]
        if all(text and not text.startswith("#") for text in texts):
            dense.append(f"{place} {node.name}")

    assert len(dense) <= 0.05 * count, "\n".join(dense)


@pytest.mark.parametrize("folder", AIR_FOLDERS)
def test_no_function_is_too_long(folder: str) -> None:
    found = {
        node.name: f"{place} {node.name}: {len(_code(node))} lines"
        for place, node, _ in _nodes(folder)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and len(_code(node)) > FUNCTION_LINES
    }
    assert set(found) == (LONGER if folder == "tamp" else set()), "\n".join(found.values())


@pytest.mark.parametrize("folder", AIR_FOLDERS)
def test_no_line_is_too_long(folder: str) -> None:
    found = [
        f"{path.relative_to(ROOT)}:{number}: {len(line)} characters"
        for path in _files(folder)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if len(line) > LINE_CHARACTERS
    ]
    assert not found, "\n".join(found)


HOMONYMS = {
    "standing": (),
    "settle": ("tamp/simulation/settle.py",),
    "known": (
        "tamp/geometric/collision/edge_decision.py",
        "tamp/planner/own_relations.py",
        "tamp/symbolic/search/instantiation/instantiator.py",
    ),
}
"""Words that once meant three things each, and the files where what is left of them is defined:
bodies that physics lets come to rest, and what is known to hold."""


def _names(tree: ast.Module) -> Iterator[str]:
    """Yield the names that a module defines: functions, classes, arguments, variables, attributes."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr


@pytest.mark.parametrize("word", HOMONYMS)
def test_a_name_means_one_thing(word: str) -> None:
    found = {
        str(path.relative_to(ROOT))
        for folder in VERB_FOLDERS
        for path in _files(folder)
        if any(
            name.strip("_").lower() == word
            for name in _names(ast.parse(path.read_text(encoding="utf-8")))
        )
    }
    assert found == set(HOMONYMS[word])


SAME_CLASS_NAMES = {
    "Action": "PDDL's schema; what `tamp` and `tamp.pddlstream` return, by their public names",
    "Run": "a run of planning; the command `tamp-bench run`",
    "Solution": "what `tamp` and `tamp.pddlstream` return, by their public names",
}
"""Class names that stand in several files, and why."""


def test_a_class_name_stands_in_one_file() -> None:
    homes: dict[str, list[str]] = {}
    for folder in VERB_FOLDERS:
        for path in _files(folder):
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.ClassDef):
                    homes.setdefault(node.name, []).append(str(path.relative_to(ROOT)))

    assert len(homes) > 400
    shared = {name: files for name, files in homes.items() if len(files) > 1}
    assert set(shared) == set(SAME_CLASS_NAMES), shared
