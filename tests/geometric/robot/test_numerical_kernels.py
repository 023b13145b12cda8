"""The solver of numerical inverse kinematics as plain Python: rotation vectors, descent, turns and limits."""

from __future__ import annotations

import math

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]
import pytest

from tamp.geometric.robot import arm_kernels, numerical_kernels
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.numerical_kernels import LEAST_DIFFERENCE, damped_least_squares
from tests.geometric.plain_kernels import plain
from tests.geometric.robot.test_numerical import SLID, TURNED, random_chain, tool

K = plain(arm_kernels, numerical_kernels)


def matrix(rotation: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = rotation
    return T


@pytest.mark.parametrize("angle", [0.0, 1e-10, 1e-5, 0.3, 2.0, 3.1, math.pi - 1e-6])
def test_the_rotation_vector_is_pinocchios_logarithm(angle: float) -> None:
    """From the tool to the target, in the base's axes."""
    rng = np.random.default_rng(0)
    for _ in range(10):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        start = pinocchio.exp3(rng.normal(size=3))
        target = pinocchio.exp3(angle * axis) @ start
        error = np.full(6, 7.0)
        K._rotation_vector(matrix(start)[:3], matrix(target), error)
        assert error[3:] == pytest.approx(angle * axis, abs=1e-6)
        assert error[:3].tolist() == [7.0] * 3


def test_a_half_turn_has_some_axis() -> None:
    error = np.zeros(6)
    K._rotation_vector(np.eye(4)[:3], matrix(np.diag([1.0, -1.0, -1.0])), error)
    assert np.linalg.norm(error[3:]) == pytest.approx(math.pi)


def descend(chain: Chain, target: np.ndarray, start: np.ndarray, free: bool = False):
    q, n = start.astype(float), len(start)
    met = K._descend(
        chain.origins, chain.slides, chain.T_flange_tool, chain.lower, chain.upper, target, free, q,
        np.empty((n, 3, 4)), np.empty((3, 4)), np.empty((6, n)), np.empty(6), np.empty((n, n)), np.empty(n),
    )  # fmt: skip
    return met, q


@pytest.mark.parametrize("kinds", [[TURNED] * 6, [SLID] + [TURNED] * 6, [TURNED] * 7])
def test_a_start_nearby_comes_to_the_pose(kinds: list[float]) -> None:
    rng = np.random.default_rng(1)
    for seed in range(4):
        chain = random_chain(kinds, seed)
        goal = rng.uniform(chain.lower, chain.upper) * 0.9
        met, q = descend(chain, tool(chain, goal), goal + rng.uniform(-0.05, 0.05, len(kinds)))
        assert met
        assert tool(chain, q) == pytest.approx(tool(chain, goal), abs=1e-6)


def test_limits_hold_on_the_way_unless_it_is_free() -> None:
    """The goal is 0.2 beyond a limit: held back, the start is given up; free, it gets there."""
    chain = random_chain([TURNED] * 6, 2)
    goal = np.array([chain.upper[0] + 0.2, 0.5, -0.4, 0.3, 0.8, -0.2])
    start = goal - 0.25
    held, q = descend(chain, tool(chain, goal), start)
    assert not held
    assert np.all(q <= chain.upper) and np.all(q >= chain.lower)
    met, q = descend(chain, tool(chain, goal), start, free=True)
    assert met and q == pytest.approx(goal, abs=1e-4)


def test_what_slides_is_held_even_where_turns_are_free() -> None:
    chain = random_chain([SLID] + [TURNED] * 6, 3)
    goal = np.zeros(7)
    goal[0] = chain.upper[0] + 2.0  # no pose of the arm within reach of that
    met, q = descend(chain, tool(chain, goal), np.zeros(7), free=True)
    assert not met and chain.lower[0] <= q[0] <= chain.upper[0]


def test_what_is_out_of_reach_is_given_up() -> None:
    chain = random_chain([TURNED] * 6, 4)
    target = tool(chain, np.zeros(6))
    target[:3, 3] += [9.0, 0.0, 0.0]
    assert not descend(chain, target, np.zeros(6))[0]


WAYS = [damped_least_squares, K.damped_least_squares]


def solved(way, chain: Chain, target: np.ndarray, seeds: list, looked: int = 99, most: int = 9):
    found, count = way(
        chain.origins, chain.slides, chain.T_flange_tool, chain.lower, chain.upper, chain.home,
        target, np.array(seeds, dtype=float), looked, most,
    )  # fmt: skip
    return found[:count]


@pytest.mark.parametrize("way", WAYS, ids=["compiled", "plain"])
def test_each_solution_counts_once_and_the_count_ends_it(way) -> None:
    chain = random_chain([TURNED] * 6, 5)
    goal = np.full(6, 0.4)
    target = tool(chain, goal)
    near = [goal + 0.01, goal - 0.01, goal + 0.02, goal]
    assert solved(way, chain, target, near) == pytest.approx(np.array([goal]), abs=1e-5)
    others = [*near, *np.random.default_rng(0).uniform(-2.5, 2.5, (15, 6))]
    found = solved(way, chain, target, others)
    assert len(found) > 1
    for a in range(len(found)):
        assert tool(chain, found[a]) == pytest.approx(target, abs=1e-6)
        assert all(np.abs(found[a] - found[b]).max() > LEAST_DIFFERENCE for b in range(a))
    assert len(solved(way, chain, target, others, most=1)) == 1
    assert len(solved(way, chain, target, others, looked=4)) == 1  # the first four gave one


@pytest.mark.parametrize("way", WAYS, ids=["compiled", "plain"])
def test_turns_come_home_where_the_limits_allow_several(way) -> None:
    """A wrist from -8 to 8 rad: what was found at 6.7 is told as 0.4, near home; with home at 6 it stays."""
    chain = random_chain([TURNED] * 6, 6)
    goal = np.full(6, 0.4)
    start = goal.copy()
    start[5] += 2 * math.pi
    for home, expected in ((0.0, 0.4), (6.0, 0.4 + 2 * math.pi)):
        lower, upper = np.append(chain.lower[:5], -8.0), np.append(chain.upper[:5], 8.0)
        wide = Chain(
            chain.origins,
            chain.slides,
            chain.T_flange_tool,
            lower,
            upper,
            np.array([0.0] * 5 + [home]),
        )
        (found,) = solved(way, wide, tool(chain, goal), [start])
        assert found[5] == pytest.approx(expected, abs=1e-5)
