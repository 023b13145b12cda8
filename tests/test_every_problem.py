"""Every shipped problem: a plan that the independent judge accepts, or the reason why there is none."""

from __future__ import annotations

import json
import re
import time

import pytest

from grounding.registry import GROUNDINGS
from tamp.plan.write import plan_text
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.files import shipped
from tamp.verification.verify import verify

PROBLEMS = sorted(path.stem for path in shipped("problems").glob("*.yaml"))
IMPOSSIBLE = {"impossible_reach": ("soup_can", "reach"), "impossible_size": ("pitcher", "0.24")}
"""Problems without a plan: the object that the reason must name, and what it must say of it."""

LADDER = {
    *(
        "one_object",
        "two_objects",
        "four_objects",
        "eight_objects",
        "twelve_objects",
        "twenty_objects",
        "cluttered",
        "shelves",
        "blocked",
        "swap",
        "packed",
        "drawers",
        "stack",
        "pack",
        "set_table",
        "stack_learned",
        "pack_learned",
    ),
    *IMPOSSIBLE,
}


def test_the_ladder_is_complete() -> None:
    assert set(PROBLEMS) >= LADDER


@pytest.mark.parametrize("name", [name for name in PROBLEMS if name not in IMPOSSIBLE])
def test_solved_and_verified(name: str) -> None:
    problem = load_problem(name, registry=GROUNDINGS)
    began = time.process_time()
    solution = solve(problem, max_time=400.0, seed=0)  # of a clock that others' load makes go fast
    assert solution.outcome is Outcome.SOLVED, solution.explanation
    assert time.process_time() - began < 30.0
    assert not solution.warnings
    report = verify(json.loads(plan_text(solution)))
    assert report.holds, report.text()
    assert report.states > 100 * len(solution.plan)
    moved = {
        body
        for action in solution.plan
        if action.name in ("pick", "ride")
        for body in action.objects
    }
    goes = set(re.findall(r"\((?:on|inside|stack|pack|left_of|between) (\w+)", problem.goal))
    wanted = set(problem.scene.movable) & goes
    assert wanted and moved >= wanted


@pytest.mark.timeout(60)
@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_impossible_and_why(name: str) -> None:
    body, reason = IMPOSSIBLE[name]
    solution = solve(load_problem(name), max_time=30.0, seed=0)
    assert solution.outcome in (Outcome.INFEASIBLE, Outcome.EXHAUSTED)
    text = "\n".join(solution.explanation)
    assert body in text and reason in text, text
    assert solution.seconds["total"] < 5.0
    assert not solution.plan
