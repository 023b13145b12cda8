"""Goals that exclude each other are named within seconds, however many bodies could be moved besides."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from tamp.planner.problem import load_problem
from tamp.planner.solution import Solution
from tamp.planner.solve import solve
from tamp.symbolic.algorithms.explanation import explanation
from tamp.symbolic.algorithms.result import Outcome

SCENE = """
domain: cupboard
robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [2.0, 0.8, 0.72], at: [0.0, 1.8, 0.0]}}
  desk: {{furniture: table, size: [1.0, 0.7, 0.72], at: [0.0, -1.8, 0.0]}}
  cupboard: {{furniture: cupboard, size: [0.9, 0.42, 0.9], compartments: 2, at: [-1.6, 0.4, 0.0], yaw: 90 deg}}
{things}
goal: {goal}
"""


@pytest.fixture(autouse=True)
def _without_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a loaded machine the clock ends the search for conflicts: what it uses is asserted instead."""
    monkeypatch.setattr(explanation, "CONFLICT_SECONDS", 100.0)


def solved(
    goal: str, count: int, folder: Path, algorithm: str = "adaptive"
) -> tuple[Solution, float]:
    """The solution, and the seconds of CPU that it took."""
    at = [(-0.8 + 0.17 * (i % 10), 0.3 * (i // 10) - 0.2) for i in range(count)]
    box = "box: [0.05, 0.05, 0.1], on: table"
    things = "".join(f"  b{i}: {{{box}, at: [{x:.2f}, {y:.1f}]}}\n" for i, (x, y) in enumerate(at))
    path = folder / "scene.yaml"
    path.write_text(SCENE.format(things=things, goal=goal), encoding="utf-8")
    problem = load_problem(path)
    used = time.process_time()
    return solve(problem, max_time=100.0, algorithm=algorithm), time.process_time() - used


GOALS = [
    (
        "(and (inside b0 cupboard_1) (on b0 cupboard_top))",
        ("(inside b0 cupboard_1)", "(on b0 cupboard_top)"),
        1,
    ),
    ("(and (on b0 desk) (inside b0 cupboard_2))", ("(on b0 desk)", "(inside b0 cupboard_2)"), 1),
    (
        "(and (forall (?o - movable) (on ?o desk)) (on b1 cupboard_top))",
        ("(on b1 desk)", "(on b1 cupboard_top)"),
        2,
    ),
    (
        "(and (on b1 desk) (exists (?g - grasp) (holding b0 ?g)) (on b0 table))",
        ("(exists (?g - grasp) (holding b0 ?g))", "(on b0 table)"),
        2,
    ),
    (
        "(and (exists (?g - grasp) (holding b0 ?g)) (exists (?g - grasp) (holding b1 ?g)))",
        ("(exists (?g - grasp) (holding b0 ?g))", "(exists (?g - grasp) (holding b1 ?g))"),
        2,
    ),
    (
        "(and (hand-empty) (exists (?g - grasp) (holding b0 ?g)))",
        ("(hand-empty)", "(holding b0 ?g)"),
        1,
    ),
    ("(and (on b0 desk) (not (on b0 desk)))", ("(on b0 desk)", "(not (on b0 desk))"), 1),
]


@pytest.mark.parametrize("count", [1, 2, 4, 8, 20])
@pytest.mark.parametrize(("goal", "named", "least"), GOALS)
def test_both_are_named(
    goal: str, named: tuple[str, str], least: int, count: int, tmp_path: Path
) -> None:
    if count < least:
        pytest.skip("it takes more bodies")
    solution, used = solved(goal, count, tmp_path)
    assert solution.outcome is Outcome.INFEASIBLE and used < 5.0
    first = solution.explanation[0]
    assert all(name in first for name in named) and "cannot both hold at the end" in first, first


def test_the_reference_algorithm_names_them_too(tmp_path: Path) -> None:
    solution, used = solved(GOALS[0][0], 2, tmp_path, "incremental")
    assert solution.outcome is Outcome.INFEASIBLE and used < 10.0
    assert all(name in solution.explanation[0] for name in GOALS[0][1])


@pytest.mark.parametrize(
    "goal",
    ["(and (on b0 desk) (on b1 desk))", "(and (on b0 desk) (exists (?g - grasp) (holding b1 ?g)))"],
)
def test_what_can_be_had_together_is_planned(goal: str, tmp_path: Path) -> None:
    solution, _ = solved(goal, 4, tmp_path)
    assert solution.outcome is Outcome.SOLVED


def test_a_body_that_may_be_nowhere_is_told_in_the_goal_s_words(tmp_path: Path) -> None:
    """The search that proves it is over poses that only exist in its mind: none of them is named."""
    nowhere = ["(on b0 table)", "(on b0 desk)", "(on b0 cupboard_top)"]
    nowhere += ["(inside b0 cupboard_1)", "(inside b0 cupboard_2)"]
    denied = [f"(not {place})" for place in nowhere]
    solution, _ = solved(f"(and {' '.join(denied)} (hand-empty))", 1, tmp_path)

    assert solution.outcome is Outcome.INFEASIBLE
    assert all(words in solution.explanation[0] for words in (*denied, "(hand-empty)"))
    assert "#" not in solution.explanation[0]
