"""A violation says its kind, where and when, in one line that a terminal can show."""

from __future__ import annotations

import pytest

from tamp.plan.violation import KINDS, Violation


@pytest.mark.parametrize(
    ("violation", "text"),
    [
        (Violation("goal", "(on a b) does not hold"), "goal         (on a b) does not hold"),
        (
            Violation("cost", "it costs 2, not 1", 0, "pick"),
            "cost         1 pick: it costs 2, not 1",
        ),
        (
            Violation("collision", "hand in cup", 2, "place", 1.234),
            "collision    3 place, 1.23 s: hand in cup",
        ),
        (Violation("support", "it falls", time=10.0), "support      10.00 s: it falls"),
    ],
)
def test_it_is_said_in_one_line(violation: Violation, text: str) -> None:
    assert str(violation) == text


def test_names_out_of_files_cannot_break_the_line() -> None:
    said = str(Violation("hash", "the mesh a\nb\x1b[31m is another one"))
    assert "\n" not in said and "\x1b" not in said and "a b\\x1b[31m" in said


def test_every_kind_is_explained_and_fits_its_column() -> None:
    assert all(len(kind) <= 12 and KINDS[kind] for kind in KINDS)
