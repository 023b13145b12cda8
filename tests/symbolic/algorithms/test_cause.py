"""Causes are told once each, with the objects of all that say the same, by PDDL's names."""

from __future__ import annotations

from tamp.symbolic.algorithms.cause import Cause, CauseKind, distinct_causes, named_objects


def test_what_says_the_same_is_one_cause_with_the_objects_of_all() -> None:
    full = Cause("no room", CauseKind.NO_VALUE, ("mug", "shelf"))
    again = Cause("no room", CauseKind.NO_VALUE, ("shelf", "can"))
    other = Cause("too far", CauseKind.FAILED, ("mug", "mug"))
    assert distinct_causes((full, other, again)) == (
        Cause("no room", CauseKind.NO_VALUE, ("mug", "shelf", "can")),
        Cause("too far", CauseKind.FAILED, ("mug",)),
    )


def test_objects_are_found_by_the_scenes_names_and_listed_by_those_of_pddl() -> None:
    words = ("Mug", "?g", "mug", "#p1", "table")
    assert named_objects(words, {"mug", "table", "can"}) == ("mug", "table")


def test_programs_get_the_same_as_people() -> None:
    cause = Cause("mug is too wide", CauseKind.NO_VALUE, ("mug",))
    assert cause.document() == {"kind": "no-value", "text": "mug is too wide", "objects": ["mug"]}
