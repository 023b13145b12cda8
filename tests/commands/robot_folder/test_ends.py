"""Which arms a URDF offers, and what becomes of the gripper that hangs there."""

from __future__ import annotations

import pytest

from tamp.commands.robot_folder.ends import End, choose_end, ends
from tamp.errors import InputError
from tests.commands.robot_folder.hands import HAND, fingers


def test_a_bare_arm_ends_at_its_flange(described) -> None:
    assert ends(described("")) == (End("foot", "tool", 6),)


def test_sliding_fingers_are_taken_as_the_gripper(described) -> None:
    mimic = '<mimic joint="left_finger_joint"/>'
    found = choose_end(described(HAND + fingers("prismatic", mimic=mimic)))
    assert found == End("foot", "tool", 6, ("left_finger_joint", "right_finger_joint"))


def test_a_gripper_whose_fingers_turn_is_replaced(described) -> None:
    assert choose_end(described(HAND + fingers("revolute"))) == End(
        "foot", "tool", 6, None, turning=True
    )


def test_two_arms_are_offered_with_their_grippers(described) -> None:
    second = "".join(
        f'<link name="s{n}"/><joint name="s{n}" type="revolute"><parent link="{p}"/><child link="s{n}"/>'
        '<limit lower="-1" upper="1"/></joint>'
        for n, p in enumerate(["foot", "s0", "s1"])
    )
    with pytest.raises(InputError) as refused:
        choose_end(described(HAND + fingers("prismatic") + second))
    assert "--arm foot tool --gripper left_finger_joint right_finger_joint, --arm foot s2" in str(
        refused.value
    )


def test_wrists_of_a_hand_are_joints_of_the_arm(described) -> None:
    wrist = (
        HAND.replace('type="fixed"', 'type="revolute"')
        .replace("hand_mount", "gripper_yaw_joint")
        .replace("</joint>", '<limit lower="-1" upper="1"/></joint>')
    )
    assert ends(described(wrist + fingers("revolute"))) == (
        End("foot", "hand", 7, None, turning=True),
    )


def test_an_arm_begins_behind_a_joint_that_moves_all_of_it(described) -> None:
    root = '<link name="world"/><joint name="floor" type="planar"><parent link="world"/><child link="foot"/></joint>'
    assert choose_end(described(root)) == End("foot", "tool", 6)
