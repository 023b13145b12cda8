"""RRT-Connect compiled as a whole, asked directly: which ends it joins, what it keeps still, when it gives up."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M, Arrangement
from tamp.geometric.collision.collisions import Collisions
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.motion.tree_kernel import connected
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body, Box
from tests.geometric.making import body, scene

ROBOT = ROBOTS["ur5"]()
HOME = np.array(ROBOT.home)
LOWER, UPPER = np.array([-2.5, -2.5, -3.2]), np.array([2.5, 2.5, 3.2])
WALL = body("wall", Box((0.1, 2.4, 1.0)), (0.0, 1.3, 0.5), movable=False)


def among(*bodies: Body) -> Arrangement:
    return Collisions(scene(*bodies), ROBOT, Kinematics(ROBOT)).arrangement({})


@pytest.fixture(scope="module")
def walled() -> Arrangement:
    """A wall between left and right, which leaves a way in front of it (y < 0.1)."""
    return among(WALL)


def conf(x: float, y: float, yaw: float = 0.0) -> Array:
    return np.array([x, y, yaw, *HOME])


def drive(
    arrangement: Arrangement, start: Array, *goals: Array, seed: int = 1, most: int = 3000,
    rows: int = 600, reach: float = 0.5, tries: int = 0, periodic: int = -1,
) -> tuple[Array, int]:  # fmt: skip
    return connected(
        start, np.array(goals), LOWER, UPPER, 0, np.array([1.0, 1.0, 0.5]), periodic, reach, 2.0,
        TRANSIT_CLEARANCE_M, most, rows, tries, 10, seed, arrangement.packed,
    )  # fmt: skip


def length(path: Array) -> float:
    return float(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1).sum())


LEFT, RIGHT = conf(-1.2, 1.3), conf(1.2, 1.3)


def test_the_way_around_a_wall_is_free_and_joins_the_ends(walled: Arrangement) -> None:
    assert not walled.edge_free(LEFT, RIGHT)
    path, asked = drive(walled, LEFT, RIGHT)
    assert np.array_equal(path[0], LEFT) and np.array_equal(path[-1], RIGHT)
    assert all(walled.edge_free(a, b) for a, b in pairwise(path))
    assert path[:, 1].min() < 0.1  # in front of the wall
    assert np.all(path[:, 3:] == HOME)  # the arm is not moved
    assert np.all((path[:, :3] >= LOWER) & (path[:, :3] <= UPPER))
    assert 0 < asked <= 3000 + 2


def test_the_same_seed_gives_the_same_path_and_another_another(walled: Arrangement) -> None:
    first, again, other = (drive(walled, LEFT, RIGHT, seed=seed)[0] for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert first.shape != other.shape or not np.array_equal(first, other)


def test_edges_are_no_longer_than_the_reach(walled: Arrangement) -> None:
    path, _ = drive(walled, LEFT, RIGHT, reach=0.3)
    steps = np.diff(path[:, :3], axis=0) * [1.0, 1.0, 0.5]
    assert np.linalg.norm(steps, axis=1).max() <= 0.3 + 1e-9


def test_of_several_goals_one_that_can_be_reached_is_taken(walled: Arrangement) -> None:
    within = conf(0.0, 1.3)  # in the wall
    path, _ = drive(walled, LEFT, within, RIGHT)
    assert np.array_equal(path[-1], RIGHT)


def test_nothing_is_found_where_nothing_leads_and_no_more_is_asked_than_allowed() -> None:
    closed = among(WALL, body("rest", Box((0.1, 4.0, 1.0)), (0.0, -1.5, 0.5), movable=False))
    path, asked = drive(closed, LEFT, RIGHT, most=200)
    assert path.shape == (0, 9)
    assert 100 < asked <= 202
    path, few = drive(closed, LEFT, RIGHT, most=200, rows=10)
    assert path.shape == (0, 9) and few < asked  # trees of ten are full before


def test_shortening_makes_it_shorter_and_keeps_it_free(walled: Arrangement) -> None:
    shorter = 0
    for seed in range(4):
        rough, cut = (drive(walled, LEFT, RIGHT, seed=seed, tries=tries)[0] for tries in (0, 60))
        assert np.array_equal(cut[0], LEFT) and np.array_equal(cut[-1], RIGHT)
        assert all(walled.edge_free(a, b) for a, b in pairwise(cut))
        assert length(cut) <= length(rough) + 1e-9
        shorter += length(cut) < 0.95 * length(rough)
    assert shorter > 0


def test_a_coordinate_that_wraps_goes_the_short_way_round() -> None:
    """From yaw 3 to -3: 0.28 rad over the seam, not 6; the end is the goal but for a whole turn."""
    free = among()
    path, _ = drive(free, conf(0.0, 0.0, 3.0), conf(0.3, 0.0, -3.0), periodic=2)
    turns = (np.diff(path[:, 2]) + np.pi) % (2 * np.pi) - np.pi
    assert np.abs(turns).sum() < 1.0
    assert turns.sum() == pytest.approx(2 * np.pi - 6.0)
    whole = (path[-1, 2] + 3.0) / (2 * np.pi)
    assert whole == pytest.approx(round(whole), abs=1e-9)
    assert path[-1, :2].tolist() == [0.3, 0.0]
