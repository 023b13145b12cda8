"""Compiled kinematics as plain Python: FK, the Jacobian by differences, the solver, path following."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.robot import arm_kernels
from tamp.geometric.robot.chain import Chain
from tests.geometric.plain_kernels import plain
from tests.geometric.robot.test_numerical import SLID, TURNED, random_chain, tool

K = plain(arm_kernels)
KINDS = [[TURNED] * 6, [SLID] + [TURNED] * 6, [TURNED, SLID, TURNED]]


def frames(chain: Chain, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    joints, found = np.empty((len(q), 3, 4)), np.empty((3, 4))
    K.frames(chain.origins, chain.slides, chain.T_flange_tool, q, joints, found)
    return joints, found


@pytest.mark.parametrize("kinds", KINDS, ids=lambda kinds: str(len(kinds)))
def test_frames_are_the_product_of_the_joints(kinds: list[float]) -> None:
    for seed in range(3):
        chain = random_chain(kinds, seed)
        q = np.random.default_rng(seed).uniform(chain.lower, chain.upper)
        joints, found = frames(chain, q)
        assert found == pytest.approx(tool(chain, q)[:3])
        last = np.linalg.inv(chain.T_flange_tool)
        assert joints[-1] == pytest.approx((tool(chain, q) @ last)[:3])


@pytest.mark.parametrize("kinds", KINDS, ids=lambda kinds: str(len(kinds)))
def test_the_jacobian_is_what_differences_say(kinds: list[float]) -> None:
    chain, step = random_chain(kinds, 1), 1e-6
    q = np.random.default_rng(1).uniform(chain.lower, chain.upper)
    joints, now = frames(chain, q)
    J = np.empty((6, len(q)))
    K.jacobian(chain.slides, joints, now, J)
    for i in range(len(q)):
        moved = tool(chain, q + step * np.eye(len(q))[i])
        linear = (moved[:3, 3] - now[:, 3]) / step
        spin = (moved[:3, :3] - now[:, :3]) @ now[:, :3].T / step
        angular = [spin[2, 1], spin[0, 2], spin[1, 0]]
        assert J[:, i] == pytest.approx([*linear, *angular], abs=1e-5)


def test_the_error_is_the_twist_to_first_order_and_tells_its_largest_entry() -> None:
    chain = random_chain([TURNED] * 6, 2)
    now = tool(chain, np.zeros(6))
    axis, angle = np.array([1.0, 2.0, -2.0]) / 3, 1e-4
    cross = np.cross(np.eye(3), axis)
    target = now.copy()
    target[:3, :3] = (np.eye(3) + angle * cross) @ now[:3, :3]
    target[:3, 3] += [0.0, -0.3, 0.1]
    error = np.empty(6)
    assert K._error(now, target, error) == pytest.approx(0.3)
    assert error == pytest.approx([0.0, -0.3, 0.1, *(angle * axis)], abs=1e-7)


def test_the_solver_solves_and_reads_the_lower_half_alone() -> None:
    rng = np.random.default_rng(3)
    half = rng.normal(size=(6, 6))
    A, b = half @ half.T + 0.1 * np.eye(6), rng.normal(size=6)
    x, lower = b.copy(), np.tril(A)
    K.solve(lower + np.triu(np.full((6, 6), np.nan), 1), x, 1e-12)
    assert A @ x == pytest.approx(b)


def straight(chain: Chain, count: int, by: float) -> tuple[np.ndarray, np.ndarray]:
    """A start in the middle of the limits, and targets along the base's x."""
    start = np.full(len(chain.home), 0.2)
    targets = np.tile(tool(chain, start), (count, 1, 1))
    targets[:, 0, 3] += by * np.arange(1, count + 1)
    return start, targets


def follow(chain: Chain, targets: np.ndarray, start: np.ndarray, jump: float) -> tuple:
    return K.follow(*chain.arrays, targets, start, jump)


def test_targets_are_followed_within_the_limits() -> None:
    chain = random_chain([TURNED] * 7, 4)
    start, targets = straight(chain, 8, 0.004)
    path, reached = follow(chain, targets, start, 0.5)
    assert reached == 8
    for q, target in zip(path, targets, strict=True):
        assert tool(chain, q) == pytest.approx(target, abs=1e-6)
    assert ((chain.lower <= path) & (path <= chain.upper)).all()
    assert np.abs(np.diff(path, axis=0)).max() <= 0.5


def test_following_ends_where_a_joint_would_jump_or_nothing_reaches() -> None:
    chain = random_chain([TURNED] * 7, 4)
    start, targets = straight(chain, 8, 0.004)
    assert follow(chain, targets, start, 1e-4)[1] == 0
    targets[5, 0, 3] += 50.0
    assert follow(chain, targets, start, 100.0)[1] == 5


def test_a_joint_at_its_limit_is_frozen_and_the_others_go_on() -> None:
    """One joint cannot move at all; six others are enough."""
    chain = random_chain([TURNED] * 7, 5)
    start, targets = straight(chain, 5, 0.003)
    lower, upper = chain.lower.copy(), chain.upper.copy()
    lower[3], upper[3] = 0.2 - 1e-9, 0.2 + 1e-9
    tight = Chain(chain.origins, chain.slides, chain.T_flange_tool, lower, upper, chain.home)
    path, reached = follow(tight, targets, start, 1.0)
    assert reached == 5
    assert path[:, 3] == pytest.approx(np.full(5, 0.2))
    assert np.ptp(path[:, 2]) > 1e-4
