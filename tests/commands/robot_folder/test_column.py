"""Short arms are put where they reach tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.commands.robot_folder.base import on_our_box
from tamp.commands.robot_folder.column import on_column
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose


def shrunk(factor: float) -> Robot:
    """Make the UR5 with all links shorter, as it would stand without a column."""
    robot = ROBOTS["ur5"]()

    def short(pose: Pose) -> Pose:
        x, y, z = (factor * value for value in pose.position)
        return Pose((x, y, z), pose.quaternion)

    joints = tuple(replace(joint, origin=short(joint.origin)) for joint in robot.joints)
    return replace(robot, joints=joints)


def test_a_long_arm_stays_where_it_is() -> None:
    robot = shrunk(1.0)
    assert on_our_box(robot) and on_column(robot) is robot


def test_a_short_arm_is_raised_on_a_column_that_reaches_down_to_the_base() -> None:
    robot = shrunk(0.45)
    raised = on_column(robot)
    up = raised.T_base_arm.position[2] - robot.T_base_arm.position[2]
    assert 0.15 < up < 0.7
    assert len(raised.link(raised.foot).parts) == len(robot.link(robot.foot).parts) + 1
    low, high = bounds(raised.link(raised.foot).parts[-1:], raised.T_base_arm)
    top = robot.link(robot.base).parts[0]
    floor, roof = bounds((top,), Pose())
    assert low[2] == pytest.approx(roof[2], abs=1e-6)
    assert high[2] == pytest.approx(raised.T_base_arm.position[2], abs=1e-6)
    assert np.all(low[:2] > floor[:2]) and np.all(high[:2] < roof[:2])


def test_an_arm_that_is_bolted_down_has_no_box_of_ours() -> None:
    assert not on_our_box(ROBOTS["panda_fixed"]())
