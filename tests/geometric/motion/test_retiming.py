"""Time-optimal rates along a rail, against the bang-bang profile of a straight line and the limits in a rounding."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.motion.corner_blending import BlendedPath, blend, corners
from tamp.geometric.motion.retiming import speeds
from tests.geometric.motion import toppra_reference as reference

FAST = np.array([1e3, 1e3])


def straight(end: tuple[float, float], count: int = 201) -> BlendedPath:
    """A straight rail with many nodes, at which the acceleration may change."""
    station = np.linspace(0.0, math.hypot(*end), count)
    u = np.array(end) / math.hypot(*end)
    rows, zero = np.tile(u, (count, 1)), np.zeros((count, 2))
    return BlendedPath(
        station[:, None] * u,
        station,
        rows,
        np.abs(rows),
        zero,
        zero,
        np.ones(count - 1, dtype=bool),
    )


def test_a_straight_line_is_run_at_full_push_then_full_brake() -> None:
    rail = straight((2.0, 0.0))
    rates = speeds(rail, FAST, np.array([0.5, 9.0]))
    assert rates is not None
    # v^2 = 2 a s up to the middle and mirrored behind it.
    expected = np.sqrt(2 * 0.5 * np.minimum(rail.stations, 2.0 - rail.stations))
    assert rates == pytest.approx(expected, abs=0.02)


def test_the_speed_limit_makes_a_plateau() -> None:
    rail = straight((2.0, 0.0))
    rates = speeds(rail, np.array([0.4, 9.0]), np.array([0.5, 9.0]))
    assert rates is not None
    assert rates.max() == pytest.approx(0.4)
    ramp = 0.4**2 / (2 * 0.5)
    on = (rail.stations > ramp + 0.02) & (rail.stations < 2.0 - ramp - 0.02)
    assert rates[on] == pytest.approx(np.full(int(on.sum()), 0.4))


def test_the_joint_with_the_tightest_limit_for_its_way_decides() -> None:
    rail = straight((3.0, 4.0))
    rates = speeds(rail, np.array([0.6, 0.1]), np.array([5.0, 5.0]))
    assert rates is not None
    assert rates.max() == pytest.approx(
        0.1 / 0.8
    )  # the second coordinate moves 0.8 of each station


def test_it_begins_and_ends_at_rest() -> None:
    rates = speeds(straight((1.0, 1.0)), FAST, np.array([1.0, 1.0]))
    assert rates is not None
    assert rates[0] == pytest.approx(0.0, abs=1e-9) and rates[-1] == pytest.approx(0.0, abs=1e-9)
    assert (rates[1:-1] > 0.0).all()


def test_through_a_rounding_it_goes_no_faster_than_the_bend_allows() -> None:
    push = np.array([1.0, 1.0])
    passed = corners(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]]), push, lambda a, b: True)
    rail = blend(passed)
    rates = speeds(rail, FAST, push)
    assert rates is not None
    # At a constant rate r the acceleration is bend r^2 in each coordinate; there is no slower way than that.
    bent = np.abs(rail.curvature_before).max(axis=1) > 0.0
    assert bent.any()
    assert (np.abs(rail.curvature_before[bent]) * rates[bent, None] ** 2 <= push + 1e-6).all()
    assert rates[bent].min() > 0.5 * math.sqrt(
        1.0 / np.abs(passed[1].bend).max()
    )  # and not needlessly slow


def test_random_rails_take_as_long_as_with_toppra(rng: np.random.Generator) -> None:
    compared = 0
    for _ in range(40):
        d = int(rng.integers(2, 8))
        path = np.cumsum(rng.normal(0.0, 0.5, (int(rng.integers(3, 7)), d)), axis=0)
        velocity, acceleration = rng.uniform(0.3, 2.0, d), rng.uniform(0.5, 5.0, d)
        rail = blend(corners(path, acceleration, lambda _a, _b: True))
        ours, theirs = (f(rail, velocity, acceleration) for f in (speeds, reference.speeds))
        if theirs is None:
            continue
        compared += 1
        assert ours is not None
        gaps = np.diff(rail.stations)
        lasted = [float((2.0 * gaps / (r[:-1] + r[1:])).sum()) for r in (ours, theirs)]
        assert lasted[0] == pytest.approx(lasted[1], rel=1e-4)
    assert compared >= 30
