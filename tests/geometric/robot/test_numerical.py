"""Numerical inverse kinematics against forward kinematics, for arms of any number and kind of joints."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot import arm_kernels
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.numerical import Numerical

TURNED, SLID = 0.0, 1.0


def random_chain(kinds: list[float], seed: int) -> Chain:
    rng = np.random.default_rng(seed)
    origins = np.tile(np.eye(4), (len(kinds), 1, 1))
    for origin in origins:
        origin[:3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        origin[:3, :3] *= np.sign(np.linalg.det(origin[:3, :3]))
        origin[:3, 3] = rng.uniform(-0.3, 0.3, 3)
    slides = np.array(kinds)
    reach = np.where(slides > 0, 0.3, 2.5)
    tool = np.eye(4)
    tool[:3, 3] = 0.0, 0.0, 0.2
    return Chain(origins, slides, tool, -reach, reach, np.zeros(len(kinds)))


def tool(chain: Chain, q: np.ndarray) -> np.ndarray:
    """FK written out once more."""
    T = np.eye(4)
    for origin, slides, value in zip(chain.origins, chain.slides, q, strict=True):
        move = np.eye(4)
        if slides:
            move[2, 3] = value
        else:
            move[:2, :2] = [[np.cos(value), -np.sin(value)], [np.sin(value), np.cos(value)]]
        T = T @ origin @ move
    return T @ chain.T_flange_tool


@pytest.mark.parametrize(
    "kinds",
    [
        [TURNED] * 6,
        [TURNED] * 7,
        [TURNED] * 8,
        [SLID] + [TURNED] * 6,
        [SLID] + [TURNED] * 7,
        [TURNED, TURNED, SLID, TURNED, TURNED, TURNED],
    ],
)
def test_every_reachable_pose_is_solved_and_met(kinds: list[float]) -> None:
    solved = 0
    for seed in range(3):
        chain = random_chain(kinds, seed)
        solver, rng = Numerical(chain), np.random.default_rng(seed)
        for _ in range(100):
            target = tool(chain, rng.uniform(chain.lower, chain.upper))
            found = solver.solve(target, enough=1)
            assert found.shape[1] == len(kinds)
            for q in found:
                assert np.all((chain.lower <= q) & (q <= chain.upper))
                assert np.abs(tool(chain, q) - target).max() < 1e-6
            solved += len(found)
    assert solved >= 299  # of 300


def test_all_solutions_differ_and_come_the_same_each_time() -> None:
    chain = Chain.of(ROBOTS["panda_mobile"]())
    target = tool(chain, np.array([0.3, -0.4, 0.2, -1.8, 0.1, 1.6, 0.5]))
    found = Numerical(chain).solve(target)
    assert len(found) > 4
    for i, q in enumerate(found):
        assert all(np.abs(q - other).max() > 0.05 for other in found[:i])
        assert np.abs(tool(chain, q) - target).max() < 1e-6
    assert np.array_equal(found, Numerical(chain).solve(target))
    other = Numerical(chain).solve(target, rng=np.random.default_rng(1))
    assert len(other) and not np.array_equal(found, other)


def test_a_pose_out_of_reach_has_no_solution() -> None:
    chain = random_chain([TURNED] * 6, 0)
    target = np.eye(4)
    target[0, 3] = 50.0
    assert Numerical(chain).solve(target).shape == (0, 6)
    target[0, 3] = Numerical(chain)._length * 0.98  # within the bound, yet out of reach
    assert Numerical(chain).solve(target).shape == (0, 6)


def test_what_turns_more_than_once_comes_near_home() -> None:
    chain = random_chain([TURNED] * 6, 4)
    wide = np.full(6, 2 * np.pi)
    chain = Chain(chain.origins, chain.slides, chain.T_flange_tool, -wide, wide, np.full(6, 0.5))
    found = Numerical(chain).solve(tool(chain, np.array([4.0, -3.0, 2.0, 5.0, -5.0, 1.0])))
    assert len(found) and np.abs(found - 0.5).max() <= np.pi + 1e-9


@pytest.mark.parametrize("kinds", [[TURNED] * 6, [SLID] + [TURNED] * 7])
def test_lines_are_followed_by_any_arm(kinds: list[float]) -> None:
    followed = 0
    for seed in range(20):
        chain = random_chain(kinds, seed)
        q = np.random.default_rng(seed).uniform(0.3 * chain.lower, 0.3 * chain.upper)
        targets = np.tile(tool(chain, q), (5, 1, 1))
        targets[:, 0, 3] += np.linspace(0.002, 0.01, 5)
        path, reached = arm_kernels.follow(*chain.arrays, targets, q, 0.3)
        for k in range(reached):
            assert np.abs(tool(chain, path[k]) - targets[k]).max() < 1e-6
        followed += reached == len(targets)
    assert followed >= 15  # the others pass a singularity
