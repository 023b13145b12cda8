"""How a plan was found, in the panel's words."""

from __future__ import annotations

from typing import Any

import pytest

from tamp.errors import InputError
from tamp.view.story import MOST, planning_summary

PLAN: dict[str, Any] = {"actions": [{}, {}], "duration": 12.34, "seed": 3}


def skeleton(rounds: int, bound: bool, failures: tuple[str, ...] = ()) -> dict[str, Any]:
    return {
        "actions": ["pick cup", "place cup"],
        "rounds": rounds,
        "bound": bound,
        "failures": list(failures),
    }


@pytest.mark.parametrize(
    ("document", "head"),
    [
        (PLAN, "2 actions, 12.3 s of motion, found · seed 3"),
        ({**PLAN, "timing": {"total": 1.234}}, "2 actions, 12.3 s of motion, found in 1.23 s · seed 3"),
        ({"actions": [{}], "duration": 0.0}, "1 action, 0.0 s of motion, found"),
        ({"message": "no plan in 30 s", "outcome": "timeout", "seed": 0, "timing": {"total": 30.0}},
         "no plan in 30 s · 30.00 s · seed 0"),
        ({**PLAN, "message": "solved it", "outcome": "solved"}, "2 actions, 12.3 s of motion, found · seed 3"),
    ],
)  # fmt: skip
def test_the_first_line(document: dict[str, Any], head: str) -> None:
    assert planning_summary(document).head == head


def test_counts_are_told_in_the_singular_and_the_plural() -> None:
    story = planning_summary(
        {**PLAN, "statistics": {"skeletons": 1, "searches": 12, "expanded": 34567}}
    )
    assert story.search == "1 skeleton · 12 searches · 34,567 states expanded"
    assert planning_summary({**PLAN, "statistics": {}}).search == ""


def test_skeletons_with_their_fate() -> None:
    made = [
        skeleton(0, True),
        skeleton(1, False, ("no grasp",)),
        skeleton(3, True),
        skeleton(0, False),
    ]
    story = planning_summary({**PLAN, "statistics": {}, "record": {"skeletons": made}})
    assert [text for text, _ in story.skeletons] == [
        "2 actions: became the plan",
        "2 actions: failed 1 time",
        "2 actions: failed 3 times, then became the plan",
        "2 actions: not finished",
    ]
    assert story.skeletons[1][1] == ("1. pick cup", "2. place cup", "no grasp")
    many = planning_summary(
        {**PLAN, "statistics": {}, "record": {"skeletons": [skeleton(1, False)] * (MOST + 5)}}
    )
    assert len(many.skeletons) == MOST


def test_streams_that_were_asked_with_their_commonest_refusals() -> None:
    streams = {
        "sample-on": {
            "calls": 40,
            "successes": 10,
            "rejections": {"a": 1, "hits box": 20, "too far": 6, "b": 3},
        },
        "sample-grasp": {"calls": 1200, "successes": 1200},
        "never": {"calls": 0, "successes": 0},
    }
    story = planning_summary(
        {
            **PLAN,
            "statistics": {"streams": streams},
            "timing": {"sample-on": 0.5, "search": 0.25, "total": 1.0},
        }
    )
    assert story.streams == (
        ("sample-on", "20 hits box, 6 too far, 3 b", "40", "25 %", "0.50 s"),
        ("sample-grasp", "", "1,200", "100 %", "0.00 s"),
    )
    assert story.time == (("search", "", "0.250"), ("total", "", "1.000"))


def test_why_there_is_no_plan() -> None:
    document = {
        "message": "no plan",
        "outcome": "infeasible",
        "statistics": {},
        "explanation": ["too wide", "no room"],
    }
    assert planning_summary(document).why == ("too wide", "no room")


@pytest.mark.parametrize(
    ("document", "words"),
    [
        ({}, "'actions' is missing"),
        ({**PLAN, "timing": {"total": -1}}, "timing.total: -1 is less than 0"),
        (
            {**PLAN, "statistics": {"streams": {"s": {"calls": 1}}}},
            "statistics.streams.s: 'successes' is missing",
        ),
    ],
)
def test_what_is_not_of_the_format_is_refused(document: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        planning_summary(document)
