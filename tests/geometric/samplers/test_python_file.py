"""A grounding in a Python file is run from a command line alone, and what is none is said."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.samplers.python_file import given_by_files, parted, python_grounding

GOOD = "class Mine:\n    def propose(self, scene, arguments, count, rng):\n        return [count]\ngrounding = Mine()\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "mine.py"
    path.write_text(GOOD)
    return path


def test_an_object_with_propose_or_classify_is_one(file: Path) -> None:
    assert python_grounding(file).propose(None, (), 3, None) == [3]  # type: ignore[union-attr, arg-type]
    file.write_text(
        GOOD.replace(
            "propose(self, scene, arguments, count, rng)", "classify(self, scene, arguments)"
        )
    )
    assert hasattr(python_grounding(file), "classify")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = 1\n", "it defines no 'grounding'. grounding = Mine.., an object with the methods"),
        ("grounding = 5\n", "'grounding' has neither propose nor classify"),
        (GOOD.replace("Mine()\n", "Mine\n"), "'grounding' is a class, not an object"),
        ("x = (\n", "it cannot be run: SyntaxError"),
        (
            "import no_such_module\n",
            "it cannot be run: ModuleNotFoundError: No module named 'no_such_module'",
        ),
        ("1 / 0\n", "it cannot be run: ZeroDivisionError"),
        ("# coding: no-such\n", "this is no Python file"),
    ],
)
def test_what_is_none_is_said_with_its_file(file: Path, text: str, words: str) -> None:
    file.write_text(text)
    with pytest.raises(InputError, match=words) as told:
        python_grounding(file)
    assert told.value.file == str(file)


def test_a_text_that_was_read_before_needs_no_file(tmp_path: Path) -> None:
    assert python_grounding(tmp_path / "gone.py", GOOD).propose(None, (), 1, None) == [1]  # type: ignore[union-attr, arg-type]
    with pytest.raises(InputError, match=r"gone.py"):
        python_grounding(tmp_path / "gone.py")


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("mine.py", ("mine.py", "")),
        ("mine.py:alone", ("mine.py", ":alone")),
        ("a:b.py:mixed", ("a:b.py", ":mixed")),
        ("mine.py:other", ("mine.py:other", "")),
    ],
)
def test_a_mode_is_parted_from_a_name(text: str, parts: tuple[str, str]) -> None:
    assert parted(text) == parts


def test_names_stay_names_and_files_become_objects(file: Path) -> None:
    names, objects = given_by_files(
        {"on": "uniform:alone", "upright": f"{file}:alone", "inside": str(file)}
    )
    assert names == {"on": "uniform:alone", "upright": "given:alone", "inside": "given"}
    assert objects.keys() == {"upright", "inside"}
    _, read_before = given_by_files({"on": "gone.py:mixed"}, {"gone.py": GOOD})
    assert read_before["on"].propose(None, (), 7, None) == [7]  # type: ignore[union-attr, arg-type]
