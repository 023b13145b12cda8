"""Input errors: place, words, choices and remedy in one line that a terminal shows as it is."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.errors import LONGEST, MOST_CHOICES, InputError, closest, one_line, printable


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (InputError("it is empty"), "it is empty"),
        (InputError("it is empty", file="a.yaml"), "a.yaml: it is empty"),
        (InputError("no", file="a.yaml", line=3, column=7), "a.yaml:3:7: no"),
        (InputError("no", line=3), "3: no"),
        (InputError("no", choices=("a", "b")), "no. Choices: a, b"),
        (InputError("no", choices=("mug", "cup"), found="mgu"), "no. Choices: mug, cup. Did you mean 'mug'?"),
        (InputError("no", choices=("mug",), found="mgu", remedy="Name it"),
         "no. Choices: mug. Did you mean 'mug'? Name it"),
        (InputError("no", remedy="Name it"), "no. Name it"),
        (InputError("no", choices=("mug",), found="table"), "no. Choices: mug"),
    ],
)  # fmt: skip
def test_the_text(error: InputError, text: str) -> None:
    assert str(error) == text


def test_many_choices_are_counted() -> None:
    text = str(InputError("no", choices=[f"c{i}" for i in range(MOST_CHOICES + 1234)]))
    assert text.endswith(f"c{MOST_CHOICES - 1} and 1,234 more") and f"c{MOST_CHOICES}," not in text


def test_a_place_is_filled_in_where_it_is_missing() -> None:
    bare = InputError("no", found="mgu", choices=("mug",), remedy="Name it")
    assert str(bare.at("a.yaml", 5)) == "a.yaml:5: no. Choices: mug. Did you mean 'mug'? Name it"
    placed = InputError("no", file="b.yaml", line=2)
    assert str(placed.at("a.yaml", 5)) == "b.yaml:2: no"
    assert (
        str(bare) == "no. Choices: mug. Did you mean 'mug'? Name it"
    )  # the first one stays as it was


@given(st.text(max_size=40))
@settings(max_examples=50)
def test_whatever_a_name_holds_the_message_is_one_visible_line(name: str) -> None:
    text = str(InputError(f"no '{name}'", file=name))
    assert "\n" not in text and "\r" not in text
    assert all(char.isprintable() or char.isspace() for char in text)
    assert "\x1b" not in text and "\u202e" not in text


def test_a_message_of_a_megabyte_is_cut() -> None:
    assert len(one_line("a" * 10**6)) == LONGEST + 4
    assert one_line("a" * LONGEST) == "a" * LONGEST


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain, Grüße, 日本", "plain, Grüße, 日本"),
        ("\x1b[31mred", "\\x1b[31mred"),
        ("a\u202eb", "a\\u202eb"),
        ("tab\there", "tab\\there"),
        ("\ud800", "\\ud800"),
    ],
)
def test_what_a_terminal_obeys_or_hides_is_escaped(text: str, shown: str) -> None:
    assert printable(text) == shown


def test_line_breaks_may_be_kept() -> None:
    assert printable("a\n\tb\x07", kept="\n\t") == "a\n\tb\\x07"


@pytest.mark.parametrize(
    ("word", "meant"),
    [("tabel", "table"), ("chair", "chair"), ("xyz", None), ("t" * 101, None), ("", None)],
)
def test_the_closest_word(word: str, meant: str | None) -> None:
    assert closest(word, ("table", "chair", "shelf")) == meant
