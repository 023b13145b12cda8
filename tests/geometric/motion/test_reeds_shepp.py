"""Reeds-Shepp curves as a car drives them: pieces by hand, samples where it reverses and steers otherwise."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.motion.car import CURVE_STEP_RAD
from tamp.geometric.motion.reeds_shepp import KIND_STEP_M, _CurvePiece, curve
from tamp.geometric.motion.sampling_based import PlaneSpace
from tamp.geometric.scene.pose import Array
from tests.geometric.motion.driven import assert_driven

ROOM = (-3.0, 3.0)


@pytest.mark.parametrize("seed", range(40))
def test_the_samples_of_a_curve_are_a_cars(seed: int) -> None:
    rng = np.random.default_rng(seed)
    radius = float(rng.choice([0.3, 1.0, 2.0]))
    start = np.array([*rng.uniform(-1, 1, 2), rng.uniform(-3, 3)])
    goal = start + np.array(
        [*rng.normal(size=2) * rng.choice([0.05, 0.5, 2.0]), rng.uniform(-3, 3)]
    )
    step = min(0.05, CURVE_STEP_RAD * radius)

    path = curve(PlaneSpace(ROOM, ROOM, radius), start, goal, step)

    assert np.array_equal(path[0], start) and np.array_equal(path[-1], goal)
    path[:, 2] = np.unwrap(path[:, 2])
    assert_driven(path, radius)
    assert np.all(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1) <= step + 1e-9)


def test_where_it_reverses_is_a_sample() -> None:
    # Half a metre to the side, the heading kept, takes a turn that is not driven in one direction.
    path = curve(PlaneSpace(ROOM, ROOM, 1.0), np.zeros(3), np.array([0.0, 0.5, 0.0]), 0.03)
    steps = np.diff(path[:, :2], axis=0)
    heading = (path[:-1, 2] + path[1:, 2]) / 2
    ahead = steps[:, 0] * np.cos(heading) + steps[:, 1] * np.sin(heading)
    reversals = int(np.sum(np.sign(ahead[1:]) != np.sign(ahead[:-1])))
    assert reversals in (1, 2)
    assert_driven(path, 1.0)


def test_two_places_that_are_one_need_no_curve() -> None:
    path = curve(PlaneSpace(ROOM, ROOM, 1.0), np.zeros(3), np.zeros(3), 0.03)
    assert path.shape == (2, 3)


def test_a_curve_keeps_its_turning_radius() -> None:
    plane = PlaneSpace((-5.0, 5.0), (-5.0, 5.0), turning_radius=0.5)
    rng = np.random.default_rng(0)
    looked = 0
    for _ in range(20):
        start, end = rng.uniform([-2, -2, -3], [2, 2, 3], (2, 3))
        samples = curve(plane, start, end, 0.02)
        assert np.array_equal(samples[0], start) and np.array_equal(samples[-1], end)
        steps = np.diff(samples, axis=0)
        turns = np.abs((steps[:, 2] + np.pi) % (2 * np.pi) - np.pi)
        travelled = np.hypot(steps[:, 0], steps[:, 1])
        assert np.all(
            turns <= 0.02 / 0.5 + 1e-6
        )  # a step along the curve turns by its length over the radius
        assert np.all(travelled <= 0.02 + 1e-9)
        looked += 1
    assert looked == 20


QUARTER = math.pi / 2


@pytest.mark.parametrize(
    ("direction", "side", "end"),
    [
        (1.0, 0, (math.pi, 0.0, 0.0)),
        (-1.0, 0, (-math.pi, 0.0, 0.0)),
        (1.0, 1, (2.0, 2.0, QUARTER)),
        (1.0, -1, (2.0, -2.0, -QUARTER)),
        (-1.0, 1, (-2.0, -2.0, QUARTER)),
        (-1.0, -1, (-2.0, 2.0, -QUARTER)),
    ],
)
def test_a_piece_is_a_line_or_a_quarter_of_a_circle(
    direction: float, side: int, end: tuple[float, float, float]
) -> None:
    """Pi metres along, with a radius of 2 m; then the same from another pose."""
    piece = _CurvePiece(0.0, 0.0, 0.0, 2.0, direction, side)
    assert piece.poses(np.array([0.0, math.pi])) == pytest.approx(np.array([(0, 0, 0), end]))
    moved = _CurvePiece(5.0, 1.0, QUARTER, 2.0, direction, side)
    wanted = np.array([5.0 - end[1], 1.0 + end[0], QUARTER + end[2]])
    assert moved.poses(np.array([math.pi]))[0] == pytest.approx(wanted)
    assert moved.passes(math.pi, wanted + 2 * math.tau * np.eye(3)[2])
    for k in range(3):
        assert not moved.passes(math.pi, wanted + 1e-6 * np.eye(3)[k])


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize("side", [-1, 0, 1])
@pytest.mark.parametrize("yaw", [0.0, 2.5, math.pi])
def test_the_next_pose_tells_which_piece_it_is(direction: float, side: int, yaw: float) -> None:
    """Also where the yaw passes a half turn."""
    piece = _CurvePiece(1.0, -1.0, yaw, 0.7, direction, side)
    here, after = piece.poses(np.array([0.0, KIND_STEP_M]))
    after[2] = math.remainder(after[2], math.tau)
    assert _CurvePiece.through(here, after, 0.7) == piece


def sampled(end: Array, radius: float | None, step: float = 0.05) -> Array:
    return curve(PlaneSpace(ROOM, ROOM, radius), np.zeros(3), end, step)


def test_a_quarter_of_a_circle_is_the_shortest_way_there() -> None:
    path = sampled(np.array([1.0, 1.0, QUARTER]), 1.0)
    assert np.hypot(path[:, 0], path[:, 1] - 1.0) == pytest.approx(np.ones(len(path)), abs=1e-6)
    assert path[:, 2] == pytest.approx(np.linspace(0.0, QUARTER, len(path)), abs=1e-6)
    assert len(path) == math.ceil(QUARTER / 0.05) + 1


def test_straight_on_and_back_it_does_not_steer() -> None:
    for x in (2.0, -2.0):
        path = sampled(np.array([x, 0.0, 0.0]), 1.0)
        assert path[:, 0] == pytest.approx(np.linspace(0.0, x, 41), abs=1e-6)
        assert np.abs(path[:, 1:]).max() < 1e-6


def test_a_base_that_needs_no_circle_goes_straight_there() -> None:
    assert sampled(np.array([0.0, 1.0, 2.0]), None).tolist() == [[0.0, 0.0, 0.0], [0.0, 1.0, 2.0]]


def test_yaws_go_on_from_the_start_s() -> None:
    """From just below half a turn on to the left: no jump to minus half a turn but at the end, which is as given."""
    start, end = np.array([0.0, 0.0, 3.0]), np.array([-1.0, -1.0, -QUARTER])
    path = curve(PlaneSpace(ROOM, ROOM, 1.0), start, end, 0.05)
    assert np.abs(np.diff(path[:-1, 2])).max() < 0.06 and path[-2, 2] > math.pi
    assert np.array_equal(path[-1], end)
