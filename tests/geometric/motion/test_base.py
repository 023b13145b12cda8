from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tamp.geometric.motion.base import plan_base
from tamp.geometric.motion.result import Failure, MotionResult
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline
from tests.geometric.motion.synthetic import Sampled, round_table

ARM = np.linspace(-1.0, 1.0, 7)
ROOM = Room((-3.0, 3.0), (-3.0, 3.0))
START, GOAL = np.array([-2.0, 0.0, 3.0]), np.array([2.0, 0.0, -3.0])


def _plan(
    checker: Sampled, start: Array = START, goal: Array = GOAL, seed: int = 0, steering: str = "se2"
) -> MotionResult:
    return plan_base(
        checker,
        ARM,
        start,
        goal,
        ROOM,
        np.random.default_rng(seed),
        Deadline(20),
        steering=steering,
    )


def _certified(checker: Sampled, path: Array) -> bool:
    confs = [np.concatenate([base, ARM]) for base in path]
    return all(checker.edge_free(a, b) for a, b in pairwise(confs))


def _same_place(a: Array, b: Array) -> bool:
    return bool(np.array_equal(a[:2], b[:2]) and np.isclose(np.cos(a[2] - b[2]), 1.0))


def test_an_empty_room_is_crossed_straight_turning_the_shorter_way() -> None:
    path = _plan(Sampled(lambda _: False)).path
    assert path is not None and np.allclose(
        path, np.array([START, np.array([2.0, 0.0, 2 * np.pi - 3.0])])
    )


@pytest.mark.parametrize("steering", ["se2", "reeds-shepp", "differential"])
@pytest.mark.parametrize("seed", range(3))
def test_a_table_is_driven_round(steering: str, seed: int) -> None:
    checker = Sampled(round_table, 0.02)
    path = _plan(checker, seed=seed, steering=steering).path
    assert path is not None and len(path) > 2
    assert np.array_equal(path[0], START) and _same_place(path[-1], GOAL)
    assert np.all(np.abs(np.diff(path[:, 2])) <= np.pi)
    assert np.all(np.abs(path[:, :2]) <= 3.0)
    assert _certified(checker, path)


def test_what_cannot_turn_where_it_stands_backs_away_first() -> None:
    # What the robot holds, 0.7 m ahead of it, reaches through a narrow slot in a wall at x = 0.6.
    def collides(conf: Array) -> bool:
        x, y = conf[0] + 0.7 * np.cos(conf[2]), conf[1] + 0.7 * np.sin(conf[2])
        return bool((x > 0.6 and abs(y) > 0.1) or conf[0] > 0.3)

    checker = Sampled(collides, 0.02)
    planned = _plan(checker, np.array([0.0, 0.0, 0.0]), np.array([-1.0, 1.0, np.pi]))
    assert planned.path is not None and _certified(checker, planned.path)
    assert planned.checks < 60  # found without sampling
    assert np.allclose(planned.path[-1], [-1.0, 1.0, np.pi])


def test_reeds_shepp_keeps_the_turning_radius() -> None:
    path = _plan(Sampled(round_table, 0.02), steering="reeds-shepp").path
    assert path is not None
    steps = np.diff(path, axis=0)
    assert np.all(np.abs(steps[:, 2]) <= 0.051 / 0.5)
    heading = 0.5 * (path[1:, 2] + path[:-1, 2])
    sideways = np.abs(-np.sin(heading) * steps[:, 0] + np.cos(heading) * steps[:, 1])
    assert np.all(
        sideways <= 0.002
    )  # a car does not slide; where it reverses, the samples cut the tip of the cusp


def test_the_failure_says_why() -> None:
    assert _plan(Sampled(round_table), np.zeros(3)).failure is Failure.START
    assert _plan(Sampled(round_table), START, np.zeros(3)).failure is Failure.GOAL
    assert _plan(Sampled(round_table), START, np.array([9.0, 0.0, 0.0])).failure is Failure.LIMITS
    assert _plan(Sampled(lambda conf: bool(abs(conf[0]) < 0.1), 0.05)).failure is Failure.EXHAUSTED


def test_unknown_steering_is_refused_with_the_choices() -> None:
    with pytest.raises(
        ValueError, match=r"unknown steering 'dubins'. Choices: se2, reeds-shepp, differential"
    ):
        _plan(Sampled(lambda _: False), steering="dubins")


@pytest.mark.parametrize("steering", ["se2", "reeds-shepp"])
def test_the_seed_decides(steering: str) -> None:
    first, second = (_plan(Sampled(round_table, 0.05), seed=4, steering=steering) for _ in range(2))
    assert first.path is not None and second.path is not None
    assert np.array_equal(first.path, second.path) and first.checks == second.checks


@pytest.mark.parametrize("steering", ["se2", "reeds-shepp"])
@pytest.mark.parametrize("yaw", [np.pi, -np.pi, 3 * np.pi, np.radians(179.99999)])
def test_a_start_turned_round_drives_off(steering: str, yaw: float) -> None:
    checker = Sampled(round_table, 0.05)
    for start, goal in (
        ((-2.0, 0.0, yaw), GOAL),
        (START, (2.0, 0.0, yaw)),
        ((-2.0, 0.0, yaw), (2.0, 0.0, yaw)),
    ):
        planned = _plan(checker, np.array(start), np.array(goal), steering=steering)
        assert planned.path is not None and len(planned.path) > 2
        assert np.array_equal(planned.path[0], start) and _same_place(
            planned.path[-1], np.array(goal)
        )
        assert _certified(checker, planned.path)


@pytest.mark.parametrize("seed", range(5))
def test_a_differential_drive_turns_or_drives_straight(seed: int) -> None:
    rng = np.random.default_rng(seed)
    start, goal = (
        np.array([side * 2.0, *rng.uniform((-2.0, -3.0), (2.0, 3.0))]) for side in (-1.0, 1.0)
    )
    path = _plan(Sampled(round_table, 0.02), start, goal, seed, "differential").path
    assert path is not None and np.array_equal(path[0], start) and _same_place(path[-1], goal)
    for a, b in pairwise(path):
        moved = b[:2] - a[:2]
        if (
            np.linalg.norm(moved) > 1e-9
        ):  # then it does not turn, and goes where it looks, or straight back
            assert abs(b[2] - a[2]) < 1e-9
            assert abs(moved[1] * np.cos(a[2]) - moved[0] * np.sin(a[2])) < 1e-9


def test_a_differential_drive_backs_out_before_it_turns() -> None:
    def collides(conf: Array) -> bool:  # furniture to both sides of what is in front of it
        return bool(abs(np.sin(conf[2])) > 0.2 and conf[0] > -0.5)

    start, goal = np.array([0.0, 0.0, 0.0]), np.array([-1.5, 1.0, 2.0])
    planned = _plan(Sampled(collides, 0.02), start, goal, steering="differential")
    assert planned.path is not None and _certified(Sampled(collides, 0.02), planned.path)
    assert planned.path[1][0] < -0.5 and planned.path[1][2] == 0.0
