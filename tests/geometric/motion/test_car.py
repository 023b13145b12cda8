"""A base that drives like a car: round what is in its way, out of narrow places, within the room."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from tamp.geometric.motion.car import drive_curves
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline
from tests.geometric.motion.driven import assert_driven

ROOM = Room((-3.0, 3.0), (-3.0, 3.0))


def drive(
    blocked: Callable[[Array], bool], start: Sequence[float], goal: Sequence[float],
    radius: float = 0.5, seed: int = 1,
) -> Array | None:  # fmt: skip
    def edge_free(a: Array, b: Array) -> bool:
        return not any(blocked(base) for base in np.linspace(a, b, 4))

    return drive_curves(
        np.array(start, dtype=float), np.array(goal, dtype=float), ROOM, edge_free,
        turning_radius=radius, seed=seed, checks=400, deadline=Deadline(60),
    )  # fmt: skip


def test_it_drives_round_what_stands_in_the_way() -> None:
    path = drive(lambda base: float(np.hypot(base[0], base[1])) < 0.8, [-2, 0, 0], [2, 0, 0])
    assert path is not None
    assert np.allclose(path[0], [-2, 0, 0])
    assert np.allclose(path[-1, :2], [2, 0]) and np.isclose(np.cos(path[-1, 2]), 1.0)
    assert np.hypot(path[:, 0], path[:, 1]).min() >= 0.79
    assert_driven(path, 0.5)


def test_it_backs_out_of_a_bay_before_it_turns() -> None:
    # A bay open to -x, 0.2 m to either side of its middle: within it nothing but straight on fits.
    def blocked(base: Array) -> bool:
        in_bay = base[0] > 0.0
        return bool(in_bay and (abs(base[1]) > 0.2 or abs(np.sin(base[2])) > 0.3))

    path = drive(blocked, [0.8, 0, 0], [-1.5, 1.5, np.pi])
    assert path is not None
    first = path[path[:, 0] > 0.0]
    assert np.all(np.diff(first[: len(first) - 1, 0]) < 0.0)
    assert not any(blocked(base) for base in path)
    assert_driven(path, 0.5)


def test_no_way_is_none() -> None:
    assert drive(lambda base: abs(base[0]) < 0.3, [-2, 0, 0], [2, 0, 0]) is None


def test_all_of_a_path_is_in_the_room() -> None:
    path = drive(lambda _: False, [2.9, 2.9, 0.7], [2.9, 2.9, -2.4], radius=1.0)
    assert path is not None
    assert np.all(np.abs(path[:, :2]) <= 3.0)


def test_the_seed_decides() -> None:
    def wall(base: Array) -> bool:
        return abs(base[0]) < 0.1 and base[1] < 1.2

    first, second = (drive(wall, [-2, -1, 0], [2, -1, 0], seed=3) for _ in range(2))
    assert first is not None and np.array_equal(first, second)
    assert all(not wall(base) for a, b in pairwise(first) for base in np.linspace(a, b, 4))
