"""A Python file that the user names is run once, as a text of its own, and its errors name it."""

from __future__ import annotations

import sys
import traceback
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.system.python_object import OBJECT_NAME, python_object, python_source


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "mine.py"


def test_what_it_calls_by_the_name_is_returned(file: Path) -> None:
    file.write_text(f"{OBJECT_NAME} = [1, 2]\nother = 3\n")
    assert python_object(file) == [1, 2]
    file.write_text("other = 3\n")
    assert python_object(file) is None


def test_each_call_runs_it_anew_and_leaves_nothing_behind(file: Path) -> None:
    file.write_text(f"{OBJECT_NAME} = []\n")
    known = set(sys.modules)
    assert python_object(file) is not python_object(file)
    assert not {name for name in set(sys.modules) - known if "mine" in name}
    assert list(file.parent.iterdir()) == [file]  # no compiled copy beside it


def test_it_knows_its_file_and_not_the_main_program(file: Path) -> None:
    file.write_text(f"{OBJECT_NAME} = (__file__, __name__ == '__main__')\n")
    assert python_object(file) == (str(file), False)


def test_a_text_read_before_counts_more_than_the_file(file: Path) -> None:
    file.write_text(f"{OBJECT_NAME} = 1\n")
    assert python_object(file, f"{OBJECT_NAME} = 2\n") == 2


def test_an_encoding_that_it_says_is_obeyed(file: Path) -> None:
    file.write_bytes(f"# coding: latin-1\n{OBJECT_NAME} = 'Grüße'\n".encode("latin-1"))
    assert python_object(file) == "Grüße"
    file.write_bytes(f"{OBJECT_NAME} = 'Grüße'\n".encode("latin-1"))
    with pytest.raises(InputError, match="this is no Python file"):
        python_source(file)


@pytest.mark.parametrize(
    ("text", "words", "line"),
    [
        ("x = 1\ny = (\n", "it cannot be run: SyntaxError", 2),
        ("import gone_for_good\n", "ModuleNotFoundError: No module named 'gone_for_good'", None),
        ("raise ValueError('mine')\n", "it cannot be run: ValueError: mine", None),
        ("assert False\n", "it cannot be run: AssertionError", None),
    ],
)
def test_a_file_that_fails_is_bad_input(
    file: Path, text: str, words: str, line: int | None
) -> None:
    file.write_text(text)
    with pytest.raises(InputError, match=words) as told:
        python_object(file)
    assert (told.value.file, told.value.line) == (str(file), line)


def test_the_cause_leads_to_the_line_that_failed(file: Path) -> None:
    file.write_text("def f():\n    return 1 / 0\nf()\n")
    with pytest.raises(InputError) as told:
        python_object(file)
    assert told.value.__cause__ is not None
    last = traceback.extract_tb(told.value.__cause__.__traceback__)[-1]
    assert (last.filename, last.lineno, last.line) == (str(file), 2, "return 1 / 0")


def test_a_missing_file(file: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        python_object(file)
