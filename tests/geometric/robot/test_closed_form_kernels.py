"""The check of closed-form solutions: full turns into the limits, and FK against the pose."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.robot import arm_kernels, closed_form_kernels
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.closed_form_kernels import keep_valid
from tests.geometric.plain_kernels import plain
from tests.geometric.robot.test_numerical import SLID, TURNED, random_chain, tool

TURN = 2 * math.pi
WAYS = [keep_valid, plain(arm_kernels, closed_form_kernels).keep_valid]


def kept(way, chain: Chain, T: np.ndarray, *candidates: np.ndarray, tolerance: float = 1e-6):
    return way(*chain.arrays, T, np.array(candidates), tolerance)


@pytest.mark.parametrize("way", WAYS, ids=["compiled", "plain"])
def test_full_turns_bring_angles_into_the_limits(way) -> None:
    chain = random_chain([TURNED] * 6, 0)  # limits -2.5 to 2.5
    q = np.array([0.3, -2.4, 2.4, 0.0, 1.0, -1.0])
    T = tool(chain, q)
    turns = np.array([1, 1, -1, 2, -3, 0]) * TURN
    found = kept(way, chain, T, q, q + turns, q - turns)
    assert found == pytest.approx(np.array([q, q, q]))


@pytest.mark.parametrize("way", WAYS, ids=["compiled", "plain"])
@pytest.mark.parametrize("beyond", [2.6, -2.6, 3.1])
def test_an_angle_that_no_turn_brings_into_the_limits_is_left_out(way, beyond: float) -> None:
    """Between 2.5 and 2 pi - 2.5 there is nothing allowed; the others are kept in their order."""
    chain = random_chain([TURNED] * 6, 1)
    bad, good = np.zeros(6), np.zeros(6)
    bad[3] = beyond
    assert kept(way, chain, tool(chain, bad), bad).shape == (0, 6)
    found = kept(way, chain, tool(chain, good), bad, good, bad, good + TURN)
    assert found == pytest.approx(np.zeros((2, 6)))


@pytest.mark.parametrize("way", WAYS, ids=["compiled", "plain"])
def test_what_slides_is_not_turned(way) -> None:
    chain = random_chain([SLID] + [TURNED] * 6, 2)  # it slides from -0.3 to 0.3
    for value, fits in ((0.29, True), (-0.29, True), (0.31, False), (-0.31, False), (TURN, False)):
        q = np.zeros(7)
        q[0] = value
        assert len(kept(way, chain, tool(chain, q), q)) == fits


@pytest.mark.parametrize("way", WAYS, ids=["compiled", "plain"])
def test_a_solution_counts_only_where_it_meets_the_pose(way) -> None:
    chain = random_chain([TURNED] * 6, 3)
    q = np.full(6, 0.2)
    T = tool(chain, q)
    assert len(kept(way, chain, T, q, q + 0.01)) == 1
    for entry in ((0, 3), (2, 3), (1, 0)):
        for off, fits in ((0.9e-3, 1), (1.1e-3, 0)):
            wrong = T.copy()
            wrong[entry] += off
            assert len(kept(way, chain, wrong, q, tolerance=1e-3)) == fits
