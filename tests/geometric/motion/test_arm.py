from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tamp.geometric.motion.arm import MAX_EDGE_CHECKS, plan_arm
from tamp.geometric.motion.path import length
from tamp.geometric.motion.result import Failure, MotionResult
from tamp.geometric.scene.pose import Array
from tamp.system.deadline import Deadline
from tests.clock import unhindered
from tests.geometric.motion.synthetic import JointLimits, Sampled, wall_with_gap

START, GOAL = np.array([-1.0, *[0.0] * 6]), np.array([1.0, *[0.0] * 6])
BASE = np.array([0.3, -0.2, 1.0])


def _plan(checker: Sampled, goals: Array = GOAL, seed: int = 0, **options: int) -> MotionResult:
    return plan_arm(
        checker,
        BASE,
        START,
        goals,
        JointLimits(),
        np.random.default_rng(seed),
        Deadline(20),
        **options,
    )


def _certified(checker: Sampled, path: Array) -> bool:
    confs = [np.concatenate([BASE, arm]) for arm in path]
    return all(checker.edge_free(a, b) for a, b in pairwise(confs))


def test_nothing_in_the_way_is_a_straight_line() -> None:
    checker = Sampled(lambda _: False)
    planned = _plan(checker)
    assert planned.path is not None and np.array_equal(planned.path, [START, GOAL])
    assert planned.checks == checker.edges == 1


@pytest.mark.parametrize("seed", range(5))
def test_a_wall_is_passed_through_its_gap(seed: int) -> None:
    checker = Sampled(wall_with_gap)
    path = _plan(checker, seed=seed).path
    assert path is not None and np.array_equal(path[0], START) and np.array_equal(path[-1], GOAL)
    assert _certified(checker, path)
    assert length(path) < 12.0  # the shortest is 3.8; unshortened ones are 10 to 20


def test_the_checks_are_counted_and_bounded() -> None:
    checker = Sampled(lambda conf: abs(conf[3]) < 0.2, 0.1)  # a wall without a gap
    planned = _plan(checker, effort=0)
    assert not planned and planned.failure is Failure.EXHAUSTED
    assert planned.checks == checker.edges <= MAX_EDGE_CHECKS + 5


def test_more_effort_allows_more_checks() -> None:
    checker = Sampled(lambda conf: abs(conf[3]) < 0.2, 0.2)
    assert _plan(checker, effort=1).checks >= 4 * MAX_EDGE_CHECKS


def test_the_failure_names_the_end_that_collides() -> None:
    at = {Failure.START: START, Failure.GOAL: GOAL}
    for failure, arm in at.items():
        where = np.concatenate([BASE, arm])
        checker = Sampled(lambda conf, where=where: bool(np.linalg.norm(conf - where) < 0.1))
        planned = _plan(checker)
        assert planned.path is None and planned.failure is failure and checker.edges == 0


def test_the_failure_names_the_limits() -> None:
    planned = _plan(Sampled(lambda _: False), np.array([4.0, *[0.0] * 6]))
    assert planned.failure is Failure.LIMITS


def test_goals_in_collision_are_left_out() -> None:
    blocked = np.array([-0.5, *[0.0] * 6])
    checker = Sampled(lambda conf: bool(np.linalg.norm(conf[3:] - blocked) < 0.1))
    path = _plan(checker, np.array([blocked, GOAL])).path
    assert path is not None and np.array_equal(path[-1], GOAL)


def test_the_seed_decides() -> None:
    first, second = _plan(Sampled(wall_with_gap), seed=3), _plan(Sampled(wall_with_gap), seed=3)
    assert first.path is not None and second.path is not None
    assert np.array_equal(first.path, second.path) and first.checks == second.checks


def test_the_deadline_is_kept() -> None:
    began = unhindered()
    planned = plan_arm(
        Sampled(lambda conf: abs(conf[3]) < 0.2, 0.1), BASE, START, GOAL, JointLimits(),
        np.random.default_rng(0), Deadline(0.1), effort=9,
    )  # fmt: skip
    assert planned.failure is Failure.TIME and unhindered() - began < 0.4
