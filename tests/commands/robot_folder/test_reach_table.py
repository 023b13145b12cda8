"""The table of reach: by forward kinematics, in cells of height, direction, distance and heading."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.commands.robot_folder import reach_table
from tamp.commands.robot_folder.reach_table import (
    DISTANCE_STEP,
    HEADINGS,
    HEIGHT_STEP,
    directions,
    rotation_with_up,
    table,
    tools,
)
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot

FIXED = ROBOTS["panda_fixed"]()


@pytest.mark.parametrize("name", ["panda_mobile", "pr2"])  # the second one's lift slides
def test_tools_are_where_the_robots_kinematics_have_them(
    name: str, rng: np.random.Generator
) -> None:
    robot = ROBOTS[name]()
    q = rng.uniform(robot.lower, robot.upper, (20, len(robot.lower)))
    R, p = tools(Chain.of(robot), q)
    kinematics = Kinematics(robot)
    for row, rotation, position in zip(q, R, p, strict=True):
        T = kinematics.arm_tool(row)
        assert rotation == pytest.approx(T[:3, :3], abs=1e-9)
        assert position == pytest.approx(T[:3, 3], abs=1e-9)


@pytest.mark.parametrize("frequency", [1, 3, 4])
def test_directions_are_spread_with_the_axes_among_them(frequency: int) -> None:
    ups = directions(frequency)
    assert len(ups) == 4 * frequency**2 + 2  # lattice points on an octahedron
    assert np.linalg.norm(ups, axis=1) == pytest.approx(1.0)
    for axis in (*np.eye(3), *-np.eye(3)):
        assert np.abs(ups - axis).max(axis=1).min() == 0.0


def test_a_tool_with_a_given_up_is_a_rotation() -> None:
    for up in directions():
        R = rotation_with_up(up)
        assert pytest.approx(np.eye(3)) == R @ R.T and np.linalg.det(R) == pytest.approx(1.0)
        assert R[2] == pytest.approx(up)  # the world's z, as the tool sees it


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reach_table, "SAMPLES", 20_000)
    monkeypatch.setattr(reach_table, "CHUNK", 20_000)
    monkeypatch.setattr(reach_table, "RESOLVED", 1)


def never(_: float) -> None: ...


def test_every_pose_that_is_counted_is_within_reach(few: None) -> None:
    made = table(FIXED, never)
    counts, heights, distances = made["counts"], made["heights"], made["distances"]
    assert counts.shape == (len(heights), 66, len(distances), HEADINGS)
    assert counts.dtype == np.uint8 and counts.any()
    assert np.diff(heights) == pytest.approx(HEIGHT_STEP)
    assert np.diff(distances) == pytest.approx(DISTANCE_STEP)
    # Of the Panda with its hand 0.855 m are given from the shoulder, 0.333 m above the foot, to the
    # wrist, and 0.088 m and 0.21 m from there to the tool.
    level, _, row, _ = np.nonzero(counts)
    above = heights[level] - FIXED.T_base_arm.position[2] - 0.333
    assert np.hypot(distances[row], above).max() < 0.855 + 0.088 + 0.21 + 0.1


def test_cells_of_few_samples_do_not_count(few: None, monkeypatch: pytest.MonkeyPatch) -> None:
    every = table(FIXED, never)["counts"]
    monkeypatch.setattr(reach_table, "RESOLVED", 20_001)
    assert every.any() and not table(FIXED, never)["counts"].any()


def leaning(robot: Robot) -> Robot:
    """The same, its first axis along x instead of upwards."""
    first = robot.joints[0]
    half = float(np.sqrt(0.5))
    tilted = replace(first, origin=replace(first.origin, quaternion=(0.0, half, 0.0, half)))
    return replace(robot, joints=(tilted, *robot.joints[1:]))


def test_where_the_first_joint_does_not_turn_upright_the_work_lies_ahead(
    few: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def counted(robot: Robot) -> int:
        return int(table(robot, never)["counts"].astype(int).sum())

    assert counted(leaning(FIXED)) > 0
    monkeypatch.setattr(reach_table, "FRONT", 0.0)
    assert counted(FIXED) > 0 and counted(leaning(FIXED)) == 0
