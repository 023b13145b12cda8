"""Arm and gripper as an SRDF has them: which of its groups is the arm, which joints are fingers."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.srdf import read_srdf
from tamp.commands.robot_folder.srdf_arm import arm_groups
from tamp.errors import InputError
from tests.commands.robot_folder.hands import HAND, fingers
from tests.commands.robot_folder.srdf_files import (
    ARM,
    GRIPPER,
    HEAD,
    JOINTS,
    MIMIC,
    read,
    settled,
)
from tests.commands.robot_folder.urdf import arm_text


def test_a_group_that_is_a_chain_says_which_is_the_arm(tmp_path: Path) -> None:
    wanted = settled(tmp_path, ARM, arm_text(extra=HEAD))
    assert (wanted.base, wanted.tip) == ("foot", "tool")
    assert any("arm.srdf:2's group 'arm': --arm foot tool" in one for one in wanted.remarks)


@pytest.mark.parametrize(
    "group",
    [
        "".join(f'<joint name="{name}"/>' for name in reversed(JOINTS)),
        "".join(f'<link name="{name}_link"/>' for name in JOINTS),
        '<group name="low"/><group name="high"/>',
    ],
    ids=["joints", "links", "groups"],
)
def test_a_group_of_joints_links_or_groups_is_a_chain_as_well(tmp_path: Path, group: str) -> None:
    low = "".join(f'<joint name="{name}"/>' for name in JOINTS[:1])
    high = "".join(f'<joint name="{name}"/>' for name in JOINTS[1:])
    parts = f'<group name="low">{low}</group><group name="high">{high}<group name="high"/></group>'
    srdf = read(tmp_path, f'{parts}<group name="all">{group}</group>', arm_text(extra=HEAD))
    found = {
        arm.group.name: arm for arm in arm_groups(srdf, read_description(tmp_path / "arm.urdf"))
    }
    assert found["all"].joints == JOINTS
    assert (found["all"].base, found["all"].tip) == ("foot", "wrist3_link")


def test_a_finger_at_the_end_of_a_chain_is_no_joint_of_the_arm(tmp_path: Path) -> None:
    urdf = arm_text(extra=HEAD + HAND + fingers("revolute"))
    group = ARM.replace('"tool"', '"left_finger"')
    wanted = settled(tmp_path, group, urdf)
    assert (wanted.base, wanted.tip) == ("foot", "tool")
    (arm,) = arm_groups(
        read_srdf(tmp_path / "arm.srdf", read_description(tmp_path / "arm.urdf")),
        read_description(tmp_path / "arm.urdf"),
    )
    assert arm.joints == JOINTS


def test_of_nested_groups_the_longest_is_the_arm(tmp_path: Path) -> None:
    short = '<group name="arm"><chain base_link="pan_link" tip_link="tool"/></group>'
    long = ARM.replace('"arm"', '"arm_and_torso"')
    assert settled(tmp_path, short, arm_text(extra=HEAD)).base == "pan_link"
    assert settled(tmp_path, short + long, arm_text(extra=HEAD)).base == "foot"


def test_an_arm_with_a_hand_or_an_arms_name_comes_before_a_head(tmp_path: Path) -> None:
    head = '<group name="head"><joint name="nod"/><joint name="look"/></group>'
    urdf = arm_text(extra=HEAD)
    assert settled(tmp_path, head + ARM, urdf).tip == "tool"
    with pytest.raises(InputError, match=r"2 groups that may be the arm.*foot eyes \(head\)"):
        settled(tmp_path, ARM.replace('"arm"', '"chain"') + head, urdf)
    urdf = arm_text(extra=HEAD + HAND + fingers("prismatic"))
    assert settled(tmp_path, ARM.replace('"arm"', '"a"') + head + GRIPPER, urdf).tip == "tool"


def test_a_group_that_is_a_head_is_no_arm_and_hides_none(tmp_path: Path) -> None:
    head = '<group name="head"><joint name="nod"/><joint name="look"/></group>'
    with pytest.raises(
        InputError, match=r"1 group that may.*--arm foot eyes \(head\), --arm foot tool"
    ):
        settled(tmp_path, head, arm_text(extra=HEAD))
    longest = ARM.replace('"arm"', '"chain"')
    assert settled(tmp_path, longest, arm_text(extra=HEAD)).tip == "tool"


def test_the_end_effector_says_which_is_the_gripper(tmp_path: Path) -> None:
    urdf = arm_text(extra=HAND + fingers("prismatic", mimic=MIMIC))
    arm = ("foot", "tool")
    wanted = settled(tmp_path, GRIPPER, urdf, arm=arm)
    assert wanted.fingers == ("left_finger_joint", "right_finger_joint")
    assert any("end effector 'gripper'" in one for one in wanted.remarks)
    assert settled(tmp_path, "", urdf, arm=arm).fingers is None
    assert settled(tmp_path, GRIPPER, urdf, arm=arm, axis="z").fingers is None
    assert settled(tmp_path, GRIPPER, urdf, arm=arm, suction=0.02).fingers is None
