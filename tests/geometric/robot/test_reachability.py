"""Base poses from the table: mostly right, complete, the same for the same generator."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics, base_matrix
from tamp.geometric.robot.reachability import BROAD_SHARE, Reachability, asset
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def reachability(robot: Robot) -> Reachability:
    return Reachability(robot)


TOP = Pose.from_xyz_rpy((0.7, -1.2, 0.85), (math.pi, 0.0, 1.0)).matrix
SIDE = Pose((0.3, 0.4, 0.9)).matrix @ Pose.from_xyz_rpy((0, 0, 0), (0.0, math.pi / 2, 0.0)).matrix


@pytest.mark.parametrize("T_world_tool", [TOP, SIDE], ids=["top", "side"])
def test_most_base_poses_have_ik(
    robot: Robot, reachability: Reachability, T_world_tool: np.ndarray
) -> None:
    ik = ArmIK(robot)
    bases = reachability.sample(T_world_tool, np.random.default_rng(0), 200)
    T_base_tools = np.array([np.linalg.inv(base_matrix(base)) @ T_world_tool for base in bases])
    hits = [len(ik.solve(T_base_tool, enough=1)) > 0 for T_base_tool in T_base_tools]
    assert len(hits) == 200 and np.mean(hits) >= 0.8


def test_the_base_mostly_faces_the_tool(reachability: Reachability) -> None:
    bases = reachability.sample(TOP, np.random.default_rng(0), 500)
    bearing = np.arctan2(TOP[1, 3] - bases[:, 1], TOP[0, 3] - bases[:, 0]) - bases[:, 2]
    assert np.mean(np.cos(bearing) > 0.5) > 0.6


def test_samples_move_with_the_tool(reachability: Reachability) -> None:
    moved = Pose.from_xyz_yaw(0.3, -0.7, 0.0, 2.0).matrix
    here = reachability.sample(TOP, np.random.default_rng(0), 50)
    there = reachability.sample(moved @ TOP, np.random.default_rng(0), 50)
    for a, b in zip(here, there, strict=True):
        assert np.allclose(moved @ base_matrix(a), base_matrix(b), atol=1e-9)


def test_the_same_generator_gives_the_same_base_poses(
    robot: Robot, reachability: Reachability
) -> None:
    first = reachability.sample(SIDE, np.random.default_rng(3), 20)
    assert first.shape == (20, 3) and np.all(np.abs(first[:, 2]) <= math.pi)
    assert np.array_equal(first, Reachability(robot).sample(SIDE, np.random.default_rng(3), 20))


def test_every_reachable_placement_can_be_drawn(robot: Robot, reachability: Reachability) -> None:
    """The broad share covers the disc around the tool that holds the arm's foot, whatever the arm's configuration."""
    kinematics = Kinematics(robot)
    rng = np.random.default_rng(0)
    foot = np.array(robot.T_base_arm.position)
    arms = rng.uniform(robot.lower, robot.upper, (2000, 7))
    distances = [np.linalg.norm(kinematics.arm_tool(q)[:2, 3] - foot[:2]) for q in arms]
    bases = reachability.sample(TOP, rng, 4000)
    feet = np.array([(base_matrix(base) @ [*foot, 1.0])[:2] for base in bases])
    drawn = np.linalg.norm(feet - TOP[:2, 3], axis=1)
    assert BROAD_SHARE > 0 and np.max(drawn) > max(distances) - 0.01 and np.min(drawn) < 0.1


def test_a_tool_pose_outside_the_table_still_gets_samples(reachability: Reachability) -> None:
    high = TOP.copy()
    high[2, 3] = 5.0
    assert np.all(np.isfinite(reachability.sample(high, np.random.default_rng(0), 10)))


def test_a_robot_without_a_table_is_refused(robot: Robot, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="reachability table is missing"):
        Reachability(dataclasses.replace(robot, folder=tmp_path))


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_every_robot_has_a_small_table(name: str) -> None:
    for arm in ROBOTS[name]().arms:
        assert asset(arm).stat().st_size < 1_000_000
