"""Joints carry what hangs on them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.commands.robot_folder.weight import GRAVITY, SPARE, carrying
from tamp.geometric.loading.robots import ROBOTS


def test_a_joint_that_cannot_carry_the_arm_gets_help() -> None:
    robot = ROBOTS["ur5"]()
    weak = replace(robot, effort=(1.0,) * 6)
    hand = {robot.hand: 2.0}
    efforts, remarks = carrying(weak, hand)
    # the shoulder's axis is level, and the hand at most as far from it as the arm is long
    assert 2.0 * GRAVITY * 0.8 < efforts[1] / SPARE < 2.0 * GRAVITY * 1.1
    # the first joint turns about the upright: no weight turns it
    assert efforts[0] == 1.0
    assert any("shoulder_lift_joint exerts 1 N m and has to carry" in line for line in remarks)


def test_strong_joints_are_left_as_they_are() -> None:
    robot = ROBOTS["ur5"]()
    efforts, remarks = carrying(robot, {link.name: 1.0 for link in robot.links})
    assert efforts == robot.effort and remarks == []


def test_a_lift_carries_all_of_the_arm() -> None:
    robot = ROBOTS["ur5"]()
    pan = replace(robot.joints[0], kind="prismatic")
    lift = replace(robot, joints=(pan, *robot.joints[1:]), effort=(1.0, *robot.effort[1:]))
    efforts, remarks = carrying(lift, {robot.joints[1].child: 10.0})
    assert efforts[0] == pytest.approx(SPARE * 10.0 * GRAVITY, abs=1.0) and len(remarks) == 1
