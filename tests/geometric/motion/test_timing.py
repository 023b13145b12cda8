from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tamp.geometric.motion import timing
from tamp.geometric.motion.corner_blending import TIME_STEP_S, BlendedPath
from tamp.geometric.motion.retiming import speeds
from tamp.geometric.motion.timing import Timed, time_path
from tamp.geometric.scene.pose import Array

VELOCITY = np.array([2.175] * 4 + [2.61] * 3)
ACCELERATION = np.array([3.75, 1.9, 2.5, 3.1, 3.75, 5.0, 5.0])


def _random_paths(count: int = 12) -> list[Array]:
    rng = np.random.default_rng(0)
    return [rng.uniform(-1.5, 1.5, (rng.integers(2, 9), 7)) for _ in range(count)]


def _respects_limits(
    timed: Timed, velocity: Array = VELOCITY, acceleration: Array = ACCELERATION
) -> bool:
    """By finite differences: velocities between samples, accelerations between their middles; at rest around."""
    spans = np.diff(timed.times)
    rates = np.diff(timed.positions, axis=0) / spans[:, None]
    zero = np.zeros((1, rates.shape[1]))
    middles = 0.5 * (np.append(0.0, spans) + np.append(spans, 0.0))
    changes = np.diff(np.concatenate([zero, rates, zero]), axis=0) / middles[:, None]
    return bool(
        np.all(np.abs(rates) <= velocity + 1e-6) and np.all(np.abs(changes) <= acceleration + 1e-6)
    )


def _distance(point: Array, polyline: Array) -> float:
    """From a point to the nearest of a polyline's edges."""
    nearest = np.inf
    for a, b in pairwise(polyline):
        share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        nearest = min(nearest, float(np.linalg.norm(point - a - share * (b - a))))
    return nearest


@pytest.mark.parametrize("rounded", [False, True])
def test_limits_order_and_ends(rounded: bool) -> None:
    looked = 0
    for path in _random_paths():
        timed = time_path(path, VELOCITY, ACCELERATION, (lambda _a, _b: True) if rounded else None)
        assert timed.times[0] == 0.0 and np.all(np.diff(timed.times) > 0.0)
        assert np.array_equal(timed.positions[0], path[0]) and np.array_equal(
            timed.positions[-1], path[-1]
        )
        assert _respects_limits(timed)
        assert np.max(np.diff(timed.times)) < 0.1
        looked += 1
    assert looked == 12


def test_without_certificate_the_polyline_is_kept_exactly() -> None:
    looked = 0
    for path in _random_paths():
        timed = time_path(path, VELOCITY, ACCELERATION)
        assert all(any(np.array_equal(vertex, row) for row in timed.positions) for vertex in path)
        assert max(_distance(point, path) for point in timed.positions) < 1e-12
        looked += 1
    assert looked == 12


def test_what_is_rounded_was_certified() -> None:
    """Every edge of the trajectory lies on the given polyline or within an edge that the checker allowed."""
    looked = 0
    for seed, path in enumerate(_random_paths()):
        rng = np.random.default_rng(seed)
        allowed: list[Array] = []

        def edge_free(
            a: Array, b: Array, rng: np.random.Generator = rng, allowed: list[Array] = allowed
        ) -> bool:
            free = bool(rng.uniform() < 0.9)
            if free:
                allowed.append(np.array([a, b]))
            return free

        timed = time_path(path, VELOCITY, ACCELERATION, edge_free)
        assert _respects_limits(timed)
        for a, b in pairwise(timed.positions):
            certified = [path[k : k + 2] for k in range(len(path) - 1)] + allowed
            assert any(max(_distance(a, edge), _distance(b, edge)) < 1e-9 for edge in certified)
            looked += 1
    assert looked > 500


def test_rounding_saves_time() -> None:
    for path in _random_paths():
        if len(path) > 2:
            rounded = time_path(path, VELOCITY, ACCELERATION, lambda _a, _b: True)
            assert rounded.duration < time_path(path, VELOCITY, ACCELERATION).duration


def test_a_refused_rounding_rests_at_the_corner() -> None:
    path = np.array([[0.0] * 7, [1.0] * 7, [0.0, 1.0] * 3 + [0.0]])
    timed = time_path(path, VELOCITY, ACCELERATION, lambda _a, _b: False)
    corner = next(i for i, row in enumerate(timed.positions) if np.array_equal(row, path[1]))
    before = (
        np.abs(timed.positions[corner] - timed.positions[corner - 1])
        / np.diff(timed.times)[corner - 1]
    )
    assert np.all(before <= ACCELERATION * TIME_STEP_S)


def test_a_straight_line_takes_the_least_time() -> None:
    timed = time_path(np.array([[0.0, 0.0], [2.0, 0.5]]), np.ones(2), np.ones(2))
    assert np.isclose(
        timed.duration, 3.0
    )  # one second to speed up, one at full speed, one to brake
    short = time_path(np.array([[0.0, 0.0], [0.25, 0.0]]), np.ones(2), np.ones(2))
    assert np.isclose(short.duration, 1.0)


def test_a_smooth_curve_is_run_through_without_resting() -> None:
    s = np.linspace(0.0, 2.0, 60)
    curve = np.stack([np.cos(s), np.sin(s), 0.3 * s, 0 * s, 0 * s, 0 * s, 0.1 * s], axis=1)
    timed = time_path(curve, VELOCITY, ACCELERATION)
    assert _respects_limits(timed)
    assert timed.duration < 2.5  # resting at every vertex takes 10
    assert all(any(np.array_equal(vertex, row) for row in timed.positions) for vertex in curve)


def test_back_and_forth_and_standing_still() -> None:
    there = np.array([[0.0] * 7, [1.0] * 7, [0.0] * 7])
    assert _respects_limits(time_path(there, VELOCITY, ACCELERATION))
    assert _respects_limits(time_path(there, VELOCITY, ACCELERATION, lambda _a, _b: True))
    still = time_path(np.zeros((3, 7)), VELOCITY, ACCELERATION)
    assert still.duration == 0.0 and still.positions.shape == (1, 7)


def test_uneven_and_nearly_repeated_vertices() -> None:
    rng = np.random.default_rng(1)
    looked = 0
    for scale in (1e-9, 1e-6, 1e-3, 0.03):
        path = np.cumsum(rng.normal(size=(12, 7)) * rng.choice([scale, 0.3], (12, 1)), axis=0)
        for edge_free in (None, lambda _a, _b: True):
            timed = time_path(path, VELOCITY, ACCELERATION, edge_free)
            assert np.all(np.isfinite(timed.times)) and np.all(np.diff(timed.times) > 0.0)
            assert _respects_limits(timed)
            looked += 1
    assert looked == 8


def test_a_node_that_is_passed_at_almost_no_rate_makes_it_rest_at_the_corners(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    limits = np.ones(2), np.ones(2)
    usual = time_path(path, *limits, lambda a, b: True)

    def standing(rail: BlendedPath, velocity: Array, acceleration: Array) -> Array | None:
        rates = speeds(rail, velocity, acceleration)
        assert rates is not None
        rates[-3:-1] = 1e-8
        return rates

    monkeypatch.setattr(timing, "speeds", standing)
    timed = time_path(path, *limits, lambda a, b: True)
    assert usual.duration < timed.duration < 5.0
