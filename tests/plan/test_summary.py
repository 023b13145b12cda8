"""What --json prints of a solution: the plan without its trajectories, or why there is none."""

from __future__ import annotations

from collections import Counter

from tamp.plan.summary import summary_document
from tamp.planner.solution import Improvement
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount
from tamp.symbolic.algorithms.result import Outcome
from tests.plan.solutions import solution_of


def test_a_plan_is_told_without_its_trajectories() -> None:
    found = summary_document(solution_of(seconds={"total": 1.23456789}))
    assert (found["outcome"], found["message"], found["seed"]) == ("solved", "Solved", 3)
    assert found["actions"][1] == {
        "name": "pick",
        "objects": ["soup_can"],
        "arguments": ["soup_can", "p0", "g0"],
        "start": 2.0,
        "duration": 3.0,
        "cost": 1.0,
    }
    assert (found["duration"], found["cost"]) == (5.0, 2.0)
    assert found["timing"] == {"total": 1.234568}
    assert "optimization" not in found and found["causes"] == found["tried"] == []


def test_without_a_plan_it_says_why_and_what_was_tried_the_commonest_reason_first() -> None:
    tally = FailureCount("pick can", "ik", 5, 1, Counter({"collision": 1, "out of reach": 3}))
    found = summary_document(
        solution_of(
            outcome=Outcome.EXHAUSTED,
            plan=(),
            causes=(Cause("the can is far", CauseKind.FAILED, ("can",)),),
            tallies=(tally,),
        )
    )
    assert found["outcome"] == "exhausted" and found["explanation"] == ["the can is far"]
    assert found["causes"] == [{"kind": "failed", "text": "the can is far", "objects": ["can"]}]
    (tried,) = found["tried"]
    assert (tried["tries"], tried["successes"]) == (5, 1)
    assert list(tried["reasons"].items()) == [("out of reach", 3), ("collision", 1)]


def test_better_plans_are_told_where_the_first_was_not_enough() -> None:
    steps = (Improvement(0.5, 4.0, 4, 9.0), Improvement(1.5, 2.0, 2, 5.0))
    found = summary_document(solution_of(improvements=steps, bound=1.5))["optimization"]
    assert (found["bound"], found["gap"]) == (1.5, 0.25)  # a cost of 2 is a quarter above 1.5
    assert [one["cost"] for one in found["improvements"]] == [4.0, 2.0]
