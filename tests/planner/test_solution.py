"""A solution's cost, duration and gap."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.planner.solution import Action, Solution
from tamp.planner.timed_trajectories import Segment, Trajectory
from tamp.symbolic.algorithms.result import Outcome


def action(cost: float, *seconds: float) -> Action:
    segments = (Segment("base", np.array([0.0, last]), np.zeros((2, 3)), 0.08) for last in seconds)
    return Action("move", (), (), Trajectory(tuple(segments)), 0.0, cost)


def solution(*actions: Action, bound: float | None = None) -> Solution:
    return Solution(None, Outcome.SOLVED, 0, "adaptive", actions, bound=bound)


def test_costs_and_durations_add_up() -> None:
    made = solution(action(1.0, 2.0, 0.5), action(2.5, 1.0))
    assert made.solved and (made.cost, made.duration) == (3.5, 3.5)
    assert action(1.0, 2.0, 0.5).trajectory.duration == 2.5 and solution().duration == 0.0


@pytest.mark.parametrize(
    ("cost", "bound", "gap"),
    [(4.0, 4.0, 0.0), (4.0, 3.0, 0.25), (4.0, 0.0, 1.0), (4.0, 5.0, 0.0), (0.0, 0.0, 0.0)],
)
def test_the_gap_is_the_share_of_the_cost_that_the_bound_leaves(
    cost: float, bound: float, gap: float
) -> None:
    assert solution(action(cost, 1.0), bound=bound).gap == pytest.approx(gap)


def test_without_a_bound_or_a_plan_there_is_no_gap() -> None:
    assert solution(action(1.0, 1.0)).gap is None and solution(bound=3.0).gap is None
