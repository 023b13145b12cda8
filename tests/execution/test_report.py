"""The report of an execution, for people and for programs."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

from tamp.execution.deviation import Deviation
from tamp.execution.monitoring import ContactEvent
from tamp.execution.report import ActionOutcome, BodyDisplacement, Execution, GoalFact

MOVE = ActionOutcome("move", (), 0.0, 3.25, 0.0012, math.radians(0.5))
PICK = ActionOutcome(
    "pick", ("cup",), 3.25, 5.0, 0.0, 0.0, (ContactEvent("hand", "box", 12.4),),
    (BodyDisplacement("box", 0.021, math.radians(30)),),
    (Deviation("lost", "cup", "cup is not in the hand"),), "cup is dropped", "planned anew",
)  # fmt: skip
RUN = Execution(
    "plan",
    "friction",
    0,
    (MOVE, PICK),
    (GoalFact("(on cup table)", True),),
    True,
    simulated=8.25,
    seconds=2.0,
)


def test_a_calm_action_is_one_line_with_its_lag() -> None:
    first = RUN.text().splitlines()[0]
    assert first.split() == ["1", "move", "3.2", "s", "lags", "1.2", "mm,", "0.50°"]


def test_what_happened_in_an_action_follows_it() -> None:
    assert [line.strip() for line in RUN.text().splitlines()[2:7]] == [
        "! cup is dropped",
        "touches: hand - box, 12 N",
        "moved: box by 21 mm, 30°",
        "lost: cup is not in the hand",
        "-> planned anew",
    ]


@pytest.mark.parametrize(
    ("change", "last"),
    [
        ({}, "Goal reached: 2 actions, 8.2 s in physics, friction grasp, 1 lost, in 2.0 s"),
        ({"reached": False}, "Goal not reached: 2 actions, 8.2 s in physics, friction grasp, 1 lost, in 2.0 s"),
        ({"replans": 2, "kept": 1, "actions": (MOVE,)},
         "Goal reached: 1 actions, 8.2 s in physics, friction grasp, planned anew 2x, went on after 1 deviations, "
         "in 2.0 s"),
        ({"on_trust": ("upright",), "actions": ()},
         "Goal reached, on trust: upright: 0 actions, 8.2 s in physics, friction grasp, in 2.0 s"),
    ],
)  # fmt: skip
def test_the_last_line_sums_up(change: dict, last: str) -> None:
    assert replace(RUN, **change).text().splitlines()[-1] == last


@pytest.mark.parametrize(
    ("fact", "line"),
    [
        (GoalFact("(on cup table)", True), "(on cup table) holds"),
        (GoalFact("(on cup table)", False), "(on cup table) does not hold"),
        (
            GoalFact("(on cup table)", False, "it is in the hand"),
            "(on cup table) does not hold: it is in the hand",
        ),
        (
            GoalFact("(upright cup)", True, None, "mine.py", 0.876),
            "(upright cup) holds   mine.py says 0.88",
        ),
    ],
)
def test_a_part_of_the_goal_says_whether_and_why_not(fact: GoalFact, line: str) -> None:
    assert f"\n  {line}\n" in replace(RUN, goal=(fact,)).text()


def test_names_do_nothing_to_a_terminal() -> None:
    hostile = replace(MOVE, objects=("cup\x1b[31m",), event="a\nb")
    text = replace(RUN, actions=(hostile,)).text()
    assert "\x1b" not in text and "cup\\x1b[31m" in text and "a\\nb" in text


def test_kinds_are_counted_in_order() -> None:
    lost, moved = Deviation("lost", "a", ""), Deviation("displaced", "b", "")
    made = replace(
        RUN, actions=(replace(MOVE, deviations=(lost, moved)), replace(MOVE, deviations=(lost,)))
    )
    assert list(made.kinds.items()) == [("displaced", 1), ("lost", 2)]


def test_programs_get_everything_as_json() -> None:
    document = json.loads(json.dumps(RUN.json()))
    assert (document["format"], document["version"], document["kinds"]) == (
        "tamp-execution",
        1,
        {"lost": 1},
    )
    assert document["actions"][1]["touches"] == [{"first": "hand", "second": "box", "force": 12.4}]
    assert document["goal"][0]["holds"] is True and document["simulated"] == 8.25


def test_the_time_that_it_took_makes_no_other_run() -> None:
    assert replace(RUN, seconds=99.0) == RUN and replace(RUN, simulated=99.0) != RUN
