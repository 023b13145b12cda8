"""Which arms a URDF offers, and what becomes of the gripper that hangs there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.choose_gripper import choose_gripper, named_fingers
from tamp.commands.robot_folder.description import Description, read_description
from tamp.commands.robot_folder.ends import End, choose_end, ends
from tamp.commands.robot_folder.hand import tip_is_hand
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tests.commands.robot_folder.urdf import arm_text

BOX = '<collision><origin xyz="0 0 {z}"/><geometry><box size="{size}"/></geometry></collision>'
HAND = f'<link name="hand">{BOX.format(z=0.03, size="0.05 0.1 0.06")}</link>' + (
    '<joint name="hand_mount" type="fixed"><parent link="tool"/><child link="hand"/></joint>'
)


def fingers(kind: str, parent: str = "hand", mimic: str = "") -> str:
    """Return two fingers that part along y, 6 cm before the link that they hang on."""
    text = ""
    for side, sign in (("left", 1), ("right", -1)):
        shape = BOX.format(z=0.02, size="0.02 0.01 0.04").replace(
            "0 0 0.02", f"0 {sign * 0.005} 0.02"
        )
        follows = mimic if side == "right" else ""
        text += (
            f'<link name="{side}_finger">{shape}</link><joint name="{side}_finger_joint" type="{kind}">'
            f'<parent link="{parent}"/><child link="{side}_finger"/><origin xyz="0 0 0.06"/>'
            f'<axis xyz="0 {sign} 0"/><limit lower="0" upper="0.04" velocity="0.1"/>{follows}</joint>'
        )
    return text


@pytest.fixture
def described(tmp_path: Path):
    def read(extra: str, attributes: str = "") -> Description:
        file = tmp_path / "arm.urdf"
        text = arm_text(extra=extra).replace(
            '<robot name="boxes">', f'<robot name="boxes"{attributes}>'
        )
        file.write_text(text, encoding="utf-8")
        return read_description(file)

    return read


def test_a_bare_arm_ends_at_its_flange(described) -> None:
    assert ends(described("")) == (End("tool", 6),)


def test_sliding_fingers_are_taken_as_the_gripper(described) -> None:
    mimic = '<mimic joint="left_finger_joint"/>'
    found = choose_end(described(HAND + fingers("prismatic", mimic=mimic)))
    assert found == End("tool", 6, ("left_finger_joint", "right_finger_joint"))


def test_a_gripper_whose_fingers_turn_is_replaced(described) -> None:
    assert choose_end(described(HAND + fingers("revolute"))) == End("tool", 6, None, turning=True)


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
    assert ends(described(wrist + fingers("revolute"))) == (End("hand", 7, None, turning=True),)


@pytest.mark.parametrize("tip", ["tool", "hand"])
def test_own_fingers_make_the_same_hand_from_either_tip(described, tip: str) -> None:
    description = described(HAND + fingers("prismatic"))
    names = ("left_finger_joint", "right_finger_joint")
    wanted = Wanted(Path("arm.urdf"), tip, Path("out"), fingers=names)
    own = named_fingers(description, wanted)
    assert own is not None
    bare = tip_is_hand(description, tip, own)
    assert bare is (tip == "hand")
    arm = find_arm(description, "foot", tip, {}, ours=False, bare=bare)
    gripper = choose_gripper(description, wanted, arm, own, bare)
    assert len(gripper.hand) == 1 and gripper.opening == pytest.approx(0.08)
    assert "hand" not in arm.groups[-1].links
    # the tool is between the pads, a tip's depth before their ends, and points out of the hand
    assert gripper.T_hand_tool.position == pytest.approx((0.0, 0.0, 0.1 - 0.0094))
    assert gripper.T_hand_tool.rotation[:, 2] == pytest.approx(np.array([0.0, 0.0, 1.0]))


def test_a_gripper_beside_the_tip_gives_way_to_ours(described) -> None:
    beside = HAND.replace('parent link="tool"', 'parent link="wrist3_link"')
    description = described(
        beside.replace('"hand"', '"gripper_palm"') + fingers("revolute", "gripper_palm")
    )
    arm = find_arm(description, "foot", "tool", {})
    assert arm.dropped == ("gripper_palm", "left_finger", "right_finger")
    assert not set(arm.dropped) & set(arm.groups[-1].links)
    kept = find_arm(description, "foot", "tool", {}, ours=False)
    assert kept.dropped == () and set(arm.dropped) < set(kept.groups[-1].links)


def test_one_finger_named_twice_is_refused(described) -> None:
    with pytest.raises(InputError, match="named twice"):
        named_fingers(
            described(HAND + fingers("prismatic")),
            Wanted(
                Path("arm.urdf"),
                "tool",
                Path("out"),
                fingers=("left_finger_joint", "left_finger_joint"),
            ),
        )


def test_elements_of_a_simulator_need_no_declaration(described) -> None:
    text = '<link name="pad"><drake:visible value="1"/></link>' + (
        '<joint name="pad" type="fixed" drake:kind="x"><parent link="tool"/><child link="pad"/></joint>'
    )
    assert "pad" in described(text).links


def test_macros_of_xacro_are_said(described) -> None:
    with pytest.raises(InputError, match=r"macros of xacro.*Expand it first"):
        described('<xacro:macro name="arm"/>', ' xmlns:xacro="http://www.ros.org/wiki/xacro"')
