"""Documents of unknown shape: every surprise is an error that says where it stands."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.errors import InputError
from tamp.system.json_fields import LARGEST_NUMBER, Field, clipped

DOCUMENT = {"actions": [{"name": "pick", "times": [0, 1.5]}], "cost": 3, "none": None, "flag": True}


def root(document: Any = DOCUMENT) -> Field:
    return Field(document, "", Path("plan.json"))


def test_places_are_told_as_one_would_write_them() -> None:
    times = root()["actions"].items()[0]["times"]
    assert times.where == "actions[0].times"
    assert [item.where for item in times.items()] == ["actions[0].times[0]", "actions[0].times[1]"]
    assert str(times.wrong("too long")) == "plan.json: actions[0].times: too long"


def test_null_is_as_good_as_nothing() -> None:
    assert root().get("none") is None and root().get("absent") is None
    assert "none" not in root() and "cost" in root()
    with pytest.raises(InputError, match="'none' is null"):
        root()["none"]


@pytest.mark.parametrize(
    ("value", "read", "words"),
    [
        ([], Field.mapping, "an object is expected, not an array"),
        ("x", Field.items, "an array is expected, not a string"),
        (None, Field.text, "a string is expected, not null"),
        ({}, Field.number, "a number is expected, not an object"),
        (True, Field.number, "a number is expected, not true or false"),
        ("1", Field.number, "a number is expected, not a string"),
        (math.nan, Field.number, "a finite number is expected"),
        (math.inf, Field.number, "a finite number is expected"),
        (10**400, Field.number, "a finite number is expected"),
        (2 * LARGEST_NUMBER, Field.number, "2e.12 is larger than anything"),
        (-2 * LARGEST_NUMBER, Field.number, "-2e.12 is larger than anything"),
        (-1, lambda f: f.number(0.0), "-1 is less than 0"),
        ("leg", lambda f: f.text(("arm", "base")), "'leg' is unknown.*Choices: arm, base"),
        ([1, 2], lambda f: f.numbers(3), "3 numbers are expected, not 2"),
        ([1, "2"], Field.numbers, r"here\[1\]: a number is expected, not a string"),
        ([1, True], Field.numbers, r"here\[1\]: a number is expected, not true or false"),
        ([1, math.nan], Field.numbers, r"here\[1\]: a finite number is expected"),
        ([1, 2e12], Field.numbers, r"here\[1\]: 2e.12 is larger than"),
        (5, Field.numbers, "an array is expected, not a number"),
        ([], lambda f: f.rows(2), "at least one row is expected"),
        ([[1, 2], [3]], lambda f: f.rows(2), r"here\[1\]: 2 numbers are expected, not 1"),
    ],
)
def test_what_is_not_expected_is_said(value: Any, read: Callable[[Field], Any], words: str) -> None:
    with pytest.raises(InputError, match=words) as told:
        read(Field(value, "here", Path("plan.json")))
    assert str(told.value).startswith("plan.json: here")


@given(st.lists(st.one_of(st.integers(-(10**12), 10**12), st.floats(-1e12, 1e12)), max_size=8))
def test_plain_numbers_are_read_as_they_are(numbers: list[float]) -> None:
    found = root(numbers).numbers()
    assert found.dtype == np.float64 and found.tolist() == [float(number) for number in numbers]
    assert [item.number() for item in root(numbers).items()] == found.tolist()


def test_rows_and_members() -> None:
    assert root([[1, 2], [3, 4]]).rows(2).tolist() == [[1.0, 2.0], [3.0, 4.0]]
    members = Field({"a": 1, "b": 2}, "values", None).fields()
    assert {name: field.where for name, field in members.items()} == {
        "a": "values.a",
        "b": "values.b",
    }


def test_a_word_of_a_megabyte_is_told_by_its_beginning() -> None:
    assert clipped("a" * 60) == "a" * 60 and clipped("a" * 61) == "a" * 60 + "..."
    with pytest.raises(InputError) as told:
        root("w" * 10**6).text(("x",))
    assert len(told.value.message) < 100
