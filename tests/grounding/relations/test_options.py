"""Names of relations of one's own: which are none, and which are taken."""

from __future__ import annotations

import pytest

from grounding.relations.options import TAKEN, check_name
from tamp.errors import InputError


@pytest.mark.parametrize("name", ["a", "left_of", "Left-of-2"])
def test_a_name_is_a_letter_then_letters_digits_and_lines(name: str) -> None:
    check_name(name)


@pytest.mark.parametrize("name", ["", "2nd", "_a", "left of", "a.b", "near\n", "n(", "ä"])
def test_what_is_no_name_is_refused(name: str) -> None:
    with pytest.raises(InputError, match="is no name: a letter, then letters, digits"):
        check_name(name)


@pytest.mark.parametrize("name", ["on", "ON", "At-Pose", *sorted(TAKEN)])
def test_what_means_something_else_is_taken(name: str) -> None:
    with pytest.raises(InputError, match=f"the name '{name}' is taken"):
        check_name(name)


def test_a_long_one_is_cut_in_the_message() -> None:
    with pytest.raises(InputError) as told:
        check_name(" " * 300)
    assert len(str(told.value)) < 150
