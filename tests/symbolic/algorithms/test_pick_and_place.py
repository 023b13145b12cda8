"""Blocks on a line, planned for and replayed with real values and a real collision test."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.result import Outcome
from tests.symbolic.algorithms.line import Line
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve


def crowded(pairs: int, bystanders: int = 0) -> Line:
    """Each narrow slot is taken by a blocker; who belongs there waits on the bench, where others just stand."""
    blocks = {f"a{i}": 100.0 + 2 * i for i in range(pairs)} | {
        f"b{i}": 10.0 * i + 5.8 for i in range(pairs)
    }
    blocks |= {f"c{i}": 110.0 + 2 * i for i in range(bystanders)}
    regions = {f"slot{i}": (10.0 * i + 5.0, 10.0 * i + 6.6) for i in range(pairs)}
    return Line(blocks, regions | {"bench": (99.0, 120.0)})


@pytest.mark.parametrize(
    ("algorithm", "pairs", "bystanders"),
    [("adaptive", 1, 0), ("adaptive", 2, 0), ("adaptive", 2, 2), ("incremental", 1, 0)],
)
def test_blockers_are_moved_first(algorithm: str, pairs: int, bystanders: int) -> None:
    line = crowded(pairs, bystanders)
    goal = {f"a{i}": f"slot{i}" for i in range(pairs)}
    problem = line.problem(f"(and {' '.join(f'(on {a} {r})' for a, r in goal.items())})")
    result = solve(algorithm, problem, seconds=60.0)  # some seconds of work
    replay(problem, result)
    line.replay(result, goal)
    picked = [action.arguments[0] for action in result.actions if action.name == "pick"]
    assert all(picked.index(f"b{i}") < picked.index(f"a{i}") for i in range(pairs))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_free_goals_move_each_block_once(algorithm: str, seed: int) -> None:
    line = Line({"a": 0.5, "b": 2.5}, {"left": (0.0, 4.0), "right": (10.0, 20.0)})
    problem = line.problem("(and (on a right) (on b right))")
    result = solve(algorithm, problem, seed=seed)
    replay(problem, result)
    line.replay(result, {"a": "right", "b": "right"})
    assert sorted(action.arguments[0] for action in result.actions if action.name == "pick") == [
        "a",
        "b",
    ]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_two_blocks_exchange_their_slots(algorithm: str) -> None:
    line = Line(
        {"a": 0.7, "b": 10.7}, {"left": (0.0, 1.6), "right": (10.0, 11.6), "bench": (20.0, 25.0)}
    )
    problem = line.problem("(and (on a right) (on b left))")
    result = solve(algorithm, problem)
    replay(problem, result)
    line.replay(result, {"a": "right", "b": "left"})
    assert sum(action.name == "pick" for action in result.actions) == 3


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_goal_that_holds_needs_no_action(algorithm: str) -> None:
    line = Line({"a": 0.7}, {"left": (0.0, 1.6)})
    result = solve(algorithm, line.problem("(on a left)"))
    assert result.outcome is Outcome.SOLVED and result.actions == ()


def test_three_blocks_packed_into_little_room() -> None:
    line = Line({"a": 20.0, "b": 22.0, "c": 24.0}, {"left": (0.0, 3.7), "bench": (19.0, 25.0)})
    problem = line.problem("(and (on a left) (on b left) (on c left))")
    result = solve("adaptive", problem)
    replay(problem, result)
    line.replay(result, dict.fromkeys("abc", "left"))
