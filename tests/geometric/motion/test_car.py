"""A base that drives like a car: its curves, samples where it reverses, ways out of narrow places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
import pytest

from tamp.geometric.motion.car import CURVE_STEP_RAD, drive_curves
from tamp.geometric.motion.sampling_based import PlaneSpace, curve
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline

ROOM = Room((-3.0, 3.0), (-3.0, 3.0))


def assert_driven(path: Array, radius: float) -> None:
    """No chord leads aside of the mean heading, none turns tighter than the circle."""
    steps, heading = np.diff(path, axis=0), (path[:-1, 2] + path[1:, 2]) / 2
    long = np.linalg.norm(steps[:, :2], axis=1)
    aside = np.abs(steps[:, 1] * np.cos(heading) - steps[:, 0] * np.sin(heading))
    assert aside.max() < 1e-4
    assert np.all(np.abs(steps[:, 2]) <= 1.001 * long / radius + 1e-5)


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


@pytest.mark.parametrize("seed", range(40))
def test_the_samples_of_a_curve_are_a_cars(seed: int) -> None:
    rng = np.random.default_rng(seed)
    radius = float(rng.choice([0.3, 1.0, 2.0]))
    start = np.array([*rng.uniform(-1, 1, 2), rng.uniform(-3, 3)])
    goal = start + np.array(
        [*rng.normal(size=2) * rng.choice([0.05, 0.5, 2.0]), rng.uniform(-3, 3)]
    )
    step = min(0.05, CURVE_STEP_RAD * radius)

    path = curve(PlaneSpace(ROOM.x, ROOM.y, radius), start, goal, step)

    assert np.array_equal(path[0], start) and np.array_equal(path[-1], goal)
    path[:, 2] = np.unwrap(path[:, 2])
    assert_driven(path, radius)
    assert np.all(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1) <= step + 1e-9)


def test_where_it_reverses_is_a_sample() -> None:
    # Half a metre to the side, the heading kept, takes a turn that is not driven in one direction.
    path = curve(PlaneSpace(ROOM.x, ROOM.y, 1.0), np.zeros(3), np.array([0.0, 0.5, 0.0]), 0.03)
    steps = np.diff(path[:, :2], axis=0)
    heading = (path[:-1, 2] + path[1:, 2]) / 2
    ahead = steps[:, 0] * np.cos(heading) + steps[:, 1] * np.sin(heading)
    reversals = int(np.sum(np.sign(ahead[1:]) != np.sign(ahead[:-1])))
    assert reversals in (1, 2)
    assert_driven(path, 1.0)


def test_two_places_that_are_one_need_no_curve() -> None:
    path = curve(PlaneSpace(ROOM.x, ROOM.y, 1.0), np.zeros(3), np.zeros(3), 0.03)
    assert path.shape == (2, 3)


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
