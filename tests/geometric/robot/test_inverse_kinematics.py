"""IK against FK, on reachable, unreachable and singular poses; paths through poses."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def kinematics(robot: Robot) -> Kinematics:
    return Kinematics(robot)


@pytest.fixture(scope="module")
def ik(robot: Robot) -> ArmIK:
    return ArmIK(robot)


def confs(robot: Robot, count: int) -> np.ndarray:
    return np.random.default_rng(2).uniform(robot.lower, robot.upper, (count, 7))


def line(kinematics: Kinematics, q: np.ndarray, length: float, count: int) -> list[np.ndarray]:
    """Tool poses along the tool's own z axis, backwards from FK(q)."""
    poses = []
    for distance in np.linspace(length / count, length, count):
        T = kinematics.arm_tool(q)
        T[:3, 3] -= distance * T[:3, 2]
        poses.append(T)
    return poses


def test_reachable_poses_are_solved_within_limits_and_fk_agrees(
    robot: Robot, kinematics: Kinematics, ik: ArmIK
) -> None:
    solved = 0
    for q in confs(robot, 400):
        target = kinematics.arm_tool(q)
        solutions = ik.solve(target)
        solved += len(solutions) > 0
        for solution in solutions:
            assert np.all((solution >= robot.lower) & (solution <= robot.upper))
            assert np.abs(kinematics.arm_tool(solution) - target).max() < 1e-6
    assert solved >= 396


def test_the_order_is_deterministic_and_stopping_early_takes_a_prefix(
    robot: Robot, kinematics: Kinematics, ik: ArmIK
) -> None:
    target = kinematics.arm_tool(np.array(robot.home))
    everything = ik.solve(target)
    assert np.array_equal(everything, ArmIK(robot).solve(target))
    few = ik.solve(target, enough=3)
    assert 3 <= len(few) < len(everything)
    assert np.array_equal(few, everything[: len(few)])


def test_a_generator_shifts_the_sweep(robot: Robot, kinematics: Kinematics, ik: ArmIK) -> None:
    target = kinematics.arm_tool(np.array(robot.home))
    first, second = (ik.solve(target, enough=4, rng=np.random.default_rng(seed)) for seed in (0, 1))
    assert not np.array_equal(first, second)
    assert np.array_equal(first, ik.solve(target, enough=4, rng=np.random.default_rng(0)))
    for solution in np.concatenate([first, second]):
        assert np.abs(kinematics.arm_tool(solution) - target).max() < 1e-6


def test_a_pose_out_of_reach_has_no_solution(ik: ArmIK) -> None:
    target = np.eye(4)
    target[:3, 3] = (3.0, 0.0, 1.0)
    assert ik.solve(target).shape == (0, 7)


def test_the_pose_asked_for_is_left_alone(robot: Robot, kinematics: Kinematics, ik: ArmIK) -> None:
    target = kinematics.arm_tool(np.array(robot.home))
    kept = target.copy()
    ik.solve(target)
    assert np.array_equal(target, kept)


def test_singular_poses_are_solved(robot: Robot, kinematics: Kinematics, ik: ArmIK) -> None:
    """The elbow stretched, the shoulder straight up, the wrist's axes in line."""
    for q in (
        [0, 0.5, 0, -0.02, 0, 1.5, 0.7],
        [0.3, 0.0, 0.2, -1.5, 0, 1.5, 0],
        [0, 0.3, 0, -2, 0, 0.01, 0],
    ):
        assert len(ik.solve(kinematics.arm_tool(np.array(q))))


def test_following_a_line_is_continuous_and_exact(
    robot: Robot, kinematics: Kinematics, ik: ArmIK
) -> None:
    followed = 0
    for q in confs(robot, 200):
        poses = line(kinematics, q, 0.1, 10)
        path = ik.follow(poses, q)
        if path is None:
            continue
        followed += 1
        assert path.shape == (10, 7)
        assert np.all((path >= robot.lower) & (path <= robot.upper))
        assert np.abs(np.diff(np.vstack([q, path]), axis=0)).max() <= 0.3
        for reached, pose in zip(path, poses, strict=True):
            assert np.abs(kinematics.arm_tool(reached) - pose).max() < 1e-5
    assert followed > 100


def test_following_stays_put_at_the_start_and_fails_out_of_reach(
    robot: Robot, kinematics: Kinematics, ik: ArmIK
) -> None:
    home = np.array(robot.home)
    path = ik.follow([kinematics.arm_tool(home)], home)
    assert path is not None and np.allclose(path[0], home, atol=1e-9)
    assert ik.follow(line(kinematics, home, 2.0, 100), home) is None
