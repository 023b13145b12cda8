"""Differential drive: every edge turns on the spot or drives along its heading, the way that turns less first."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.geometric.motion.differential import RETREATS_M, turn_and_drive, ways
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline

ROOM = Room((-2.0, 2.0), (-2.0, 2.0))
place = st.floats(-2.0, 2.0)
yaw = st.floats(-7.0, 7.0)
base = st.tuples(place, place, yaw).map(np.array)


def check(path: Array, start: Array, goal: Array) -> None:
    """It leads from start to goal, and each edge turns or drives straight, never more than half around."""
    assert np.allclose(path[0], start)
    assert np.allclose(path[-1][:2], goal[:2])
    assert math.cos(path[-1][2] - goal[2]) == pytest.approx(1.0)
    for a, b in pairwise(path):
        step = b - a
        assert abs(step[2]) <= math.pi + 1e-9
        if np.hypot(*step[:2]) > 1e-9:
            assert abs(step[2]) < 1e-9, "it does not turn while it drives"
            aside = step[0] * math.sin(a[2]) - step[1] * math.cos(a[2])
            assert abs(aside) < 1e-9 * max(1.0, np.hypot(*step[:2])) + 1e-9


@given(base, base)
def test_ways_turn_and_drive_forwards_or_backwards_the_lesser_turn_first(
    start: Array, goal: Array
) -> None:
    found = ways(start, goal)
    assert len(found) == (2 if np.hypot(*(goal - start)[:2]) >= 1e-9 else 1)
    turned = [float(np.abs(np.diff(path[:, 2])).sum()) for path in found]
    assert turned == sorted(turned)
    for path in found:
        check(path, start, goal)


def test_straight_ahead_is_one_edge_and_straight_back_is_one() -> None:
    for x, heading in ((1.0, 0.0), (-1.0, 0.0)):
        (first, second) = ways(np.array([0.0, 0.0, heading]), np.array([x, 0.0, heading]))
        assert len(first) == 2 and len(second) == 4


def test_a_turn_on_the_spot_goes_the_short_way() -> None:
    (path,) = ways(np.array([1.0, 1.0, 3.0]), np.array([1.0, 1.0, -3.0]))
    assert path.shape == (2, 3) and path[1, 2] == pytest.approx(2 * math.pi - 3.0)


def planned(start: Array, goal: Array, edge_free: object, tries: int = 0) -> Array | None:
    return turn_and_drive(
        start, goal, ROOM, edge_free, np.random.default_rng(0), seed=0, checks=4000,  # type: ignore[arg-type]
        deadline=Deadline(math.inf), tries=tries,
    )  # fmt: skip


@given(base, base)
def test_in_a_free_room_it_is_the_way_that_turns_less(start: Array, goal: Array) -> None:
    path = planned(start, goal, lambda a, b: True)
    assert path is not None
    assert np.allclose(path, ways(start, goal)[0])


def test_where_it_must_not_turn_at_first_it_backs_away_straight() -> None:
    """Furniture in front: turning within 0.2 m of the start hits it."""
    start, goal = np.array([1.0, 0.0, 0.0]), np.array([-1.0, 1.0, 0.0])

    def free(a: Array, b: Array) -> bool:
        return a[2] == b[2] or not (a[0] > 0.8 and b[0] > 0.8)

    path = planned(start, goal, free)
    assert path is not None
    check(path, start, goal)
    assert path[1] == pytest.approx([1.0 - RETREATS_M[0], 0.0, 0.0])


def test_there_is_none_where_nothing_is_free() -> None:
    start, goal = np.array([1.0, 0.0, 0.0]), np.array([-1.0, 1.0, 0.0])
    assert planned(start, goal, lambda a, b: False) is None
    ended = Deadline(0.0)
    assert turn_and_drive(
        start, goal, ROOM, lambda a, b: True, np.random.default_rng(0), seed=0, checks=10,
        deadline=ended, tries=0,
    ) is None  # fmt: skip


@pytest.mark.parametrize("tries", [0, 30])
def test_around_a_wall_it_goes_by_stations(tries: int) -> None:
    """A wall along y from the lower end of the room, with a way around its upper end."""
    start, goal = np.array([-1.0, -1.0, 0.0]), np.array([1.0, -1.0, 0.0])
    asked = 0

    def free(a: Array, b: Array) -> bool:
        nonlocal asked
        asked += 1
        share = np.linspace(0.0, 1.0, 60)[:, None]
        rows = a[:2] + share * (b - a)[:2]
        return not ((np.abs(rows[:, 0]) < 0.1) & (rows[:, 1] < 1.0)).any()

    path = planned(start, goal, free, tries)
    assert path is not None and asked > 20
    check(path, start, goal)
    assert path[:, 1].max() > 1.0
    assert all(free(a, b) for a, b in pairwise(path))
