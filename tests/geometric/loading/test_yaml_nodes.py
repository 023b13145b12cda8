"""YAML values know their line and their dotted name, and their readers say what is wrong in those terms."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.yaml_nodes import YamlNode
from tests.geometric.making import yaml


@pytest.fixture
def value(tmp_path: Path) -> Callable[[str], YamlNode]:
    """The value of the key `v` in line 2 of a file."""

    def make(text: str) -> YamlNode:
        return yaml(tmp_path, f"first: 1\nv: {text}\n").mapping()["v"]

    return make


@pytest.mark.parametrize(
    ("text", "radians"),
    [
        ("90 deg", math.pi / 2),
        ("-180°", -math.pi),
        ("720 deg", 4 * math.pi),
        ("1.5", 1.5),
        ("7 rad", 7.0),
        ("6.283185307179586", 2 * math.pi),
        ("1e-1", 0.1),
    ],
)
def test_angles_are_radians_unless_they_say_degrees(
    value: Callable[[str], YamlNode], text: str, radians: float
) -> None:
    assert value(text).angle() == pytest.approx(radians)


def test_a_plain_angle_beyond_a_turn_was_meant_in_degrees(value: Callable[[str], YamlNode]) -> None:
    with pytest.raises(
        InputError, match=r"v: 90 radians are more than a full turn. Write '90 deg' or 'rad'"
    ) as told:
        value("90").angle()
    assert told.value.line == 2


@pytest.mark.parametrize(
    ("text", "read", "words"),
    [
        ("a word", lambda v: v.number(), "v: 'a word' is not a number"),
        (".inf", lambda v: v.number(), "v: .inf is not a finite number"),
        (".nan", lambda v: v.number(), "v: .nan is not a finite number"),
        ("0", lambda v: v.number(positive=True), "v: must be positive, found 0"),
        ("-3", lambda v: v.number(low=-1.0), "v: must be at least -1, found -3"),
        ("4", lambda v: v.number(high=2.0), "v: must be at most 2, found 4"),
        ("2.5", lambda v: v.integer(low=1), "v: 2.5 is not a whole number"),
        ("0", lambda v: v.integer(low=1), "v: must be at least 1, found 0"),
        ("", lambda v: v.number(), "v: has no value"),
        ("''", lambda v: v.text(), "v: has no value"),
        ("~", lambda v: v.text(), "v: has no value"),
        ("[1, 2]", lambda v: v.text(), "v: expected text, found a list"),
        ("{a: 1}", lambda v: v.items(), "v: expected a list, found a mapping"),
        ("5", lambda v: v.numbers(3), "v: expected 3 numbers, found '5'"),
        ("[1, 2]", lambda v: v.numbers(3), "v: expected 3 numbers, found 2"),
        ("[1, x]", lambda v: v.numbers(2), r"v\[1\]: 'x' is not a number"),
        ("maybe", lambda v: v.flag(), "v: 'maybe' is neither true nor false"),
        ("5", lambda v: v.mapping(("a", "b")), "v: expected a mapping with a, b, found '5'"),
        ("{a: 1}", lambda v: v.mapping(("a", "b"), ("b",)), "v: 'b' is missing"),
        ("{a: 1, a: 2}", lambda v: v.mapping(), "v: 'a' stands twice, first in line 2"),
        ("{[1]: 2}", lambda v: v.mapping(), "v: a key must be a word"),
        ("{<<: 3}", lambda v: v.mapping(), "v: '<<' merges mappings only"),
    ],
)
def test_what_is_wrong_is_said(
    value: Callable[[str], YamlNode], text: str, read: Callable[[YamlNode], Any], words: str
) -> None:
    with pytest.raises(InputError, match=words) as told:
        read(value(text))
    assert told.value.line == 2 and str(told.value.file).endswith("given.yaml")


def test_a_misspelt_word_gets_its_neighbour(value: Callable[[str], YamlNode]) -> None:
    with pytest.raises(
        InputError, match=r"unknown colour 'gren'.*Choices: red, green. Did you mean 'green'?"
    ):
        value("gren").text(("red", "green"), "colour")
    with pytest.raises(InputError, match=r"unknown key 'radios'.*Did you mean 'radius'?"):
        value("{radios: 1}").mapping(("radius", "height"))


def test_an_unknown_key_stands_in_its_own_line(tmp_path: Path) -> None:
    node = yaml(tmp_path, "a: 1\n\n\nb: 2\n")
    with pytest.raises(InputError, match="unknown key 'b'") as told:
        node.mapping(("a",))
    assert told.value.line == 4 and f"{tmp_path / 'given.yaml'}:4: " in str(told.value)


def test_words_are_taken_as_they_are_written(tmp_path: Path) -> None:
    node = yaml(tmp_path, "on: table\nyes: no\n012: 1_0\n")
    assert list(node.mapping()) == ["on", "yes", "012"]
    assert node.mapping()["yes"].text() == "no" and node.mapping()["yes"].flag() is False


def test_names_lead_to_a_value_and_lines_are_those_of_keys(tmp_path: Path) -> None:
    node = yaml(tmp_path, "bodies:\n  mug:\n    at:\n      - 1\n      - two\n")
    at = node.mapping()["bodies"].mapping()["mug"].mapping()["at"]
    assert (at.name, at.line) == ("bodies.mug.at", 3)
    second = at.items()[1]
    assert (second.name, second.line) == ("bodies.mug.at[1]", 5)


def test_merged_entries_give_way_to_own_ones_and_earlier_to_later(tmp_path: Path) -> None:
    node = yaml(tmp_path, "x: &x {a: 1, b: 1}\ny: &y {b: 2, c: 2}\nz: {<<: [*x, *y], c: 3}\n")
    merged = node.mapping()["z"].mapping()
    assert {key: entry.number() for key, entry in merged.items()} == {"a": 1.0, "b": 1.0, "c": 3.0}
    assert (merged["a"].line, merged["c"].line) == (
        1,
        3,
    )  # where they stand, not where they were merged


@pytest.mark.parametrize(
    ("text", "passage", "line", "column"),
    [
        ("goal: (on a b)\n", "(on a b)", 1, 7),
        ("goal:   (and (on a b)\n   (on c d))  # so\n", "(and (on a b)\n   (on c d))", 1, 9),
        ("goal: '(on a b)'\n", "(on a b)", 1, 8),
        ("goal: |\n  (on a b)\n  (on c d)\nnext: 1\n", "  (on a b)\n  (on c d)", 2, 1),
        ("goal: >\n\n    (on a b)\n\n    (on c d)\n", "\n    (on a b)\n\n    (on c d)", 2, 1),
    ],
)
def test_a_passage_stands_as_it_does_in_the_file(
    tmp_path: Path, text: str, passage: str, line: int, column: int
) -> None:
    found = yaml(tmp_path, text).mapping()["goal"].passage()
    assert (found.text, found.line, found.column) == (passage, line, column)
    first = found.text.split("\n")[0]
    assert text.split("\n")[line - 1][column - 1 :].startswith(first)
