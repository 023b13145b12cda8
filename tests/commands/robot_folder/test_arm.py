"""The arm in a URDF: its chain of joints, what each of them moves, and what is left out of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.description import read_description
from tamp.errors import InputError
from tests.commands.robot_folder.hands import BOX, HAND, fingers
from tests.commands.robot_folder.urdf import INERTIAL, SIX, write_arm


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


def test_joints_turn_about_their_own_z_with_their_limits_and_speeds(described) -> None:
    arm = find_arm(described(""), "foot", "tool", {})
    assert [joint.name for joint in arm.joints] == [name for name, *_ in SIX]
    assert {joint.axis for joint in arm.joints} == {(0.0, 0.0, 1.0)}
    assert (arm.joints[2].lower, arm.joints[2].upper) == (-2.9, 2.9)
    assert arm.velocity == (2.0,) * 5 + (1.0,) and arm.effort == (2000.0,) * 5 + (100.0,)
    # At zero the tool is where the origins add up: all axes are those of the foot.
    T = np.linalg.multi_dot([*(joint.origin.matrix for joint in arm.joints), arm.T_last_tip.matrix])
    assert T[:3, 3] == pytest.approx((0.0, 0.16, 0.1 + 0.06 + 0.4 + 0.35 + 0.1))
    assert [group.name for group in arm.groups] == ["foot", *(f"{one[0]}_link" for one in SIX)]


def test_what_hangs_on_a_link_of_the_arm_moves_with_it(described) -> None:
    lamp = f'<link name="lamp">{INERTIAL}{BOX.format(z=0.5, size="0.1 0.1 0.1")}</link>' + (
        '<joint name="nod" type="revolute"><parent link="elbow_link"/><child link="lamp"/>'
        '<axis xyz="0 0 1"/><limit lower="-1" upper="2"/></joint>'
    )
    description = described(lamp)
    arm = find_arm(description, "foot", "tool", {"nod": 0.5})
    (elbow,) = [group for group in arm.groups if group.name == "elbow_link"]
    assert elbow.links == ("elbow_link", "lamp") and elbow.mass == 3.0 and arm.dropped == ()
    (shown,) = elbow.elements[1:]
    # The elbow's own z lies along its axis, the y of the URDF: the lamp's z is across it.
    assert np.linalg.norm(shown.pose.position) == pytest.approx(0.5)
    with pytest.raises(InputError, match=r"unknown joint 'nood'.*Did you mean 'nod'"):
        find_arm(description, "foot", "tool", {"nood": 0.5})


def test_the_foot_stands_in_the_root_as_the_joints_above_it_do(described) -> None:
    cart = '<link name="cart"/><joint name="rail" type="prismatic"><parent link="cart"/>' + (
        '<child link="foot"/><origin xyz="0 0 0.3"/><axis xyz="1 0 0"/>'
        '<limit lower="-1" upper="1"/></joint>'
    )
    arm = find_arm(described(cart), "foot", "tool", {"rail": 0.25})
    assert arm.T_root_foot.position == pytest.approx((0.25, 0.0, 0.3))
    assert arm.groups[0].links == ("foot", "cart")


@pytest.mark.parametrize(
    ("base", "tip", "said"),
    [
        ("foot", "tol", "the arm's tip: unknown link 'tol'.*Did you mean 'tool'"),
        ("fot", "tool", "the arm's base: unknown link 'fot'.*Did you mean 'foot'"),
        ("tool", "foot", "'foot' does not hang on 'tool'"),
        ("wrist2_link", "tool", "are 1 moving joints: an arm has 2 to 10"),
    ],
)
def test_no_arm_between_two_links_is_refused(described, base: str, tip: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        find_arm(described(""), base, tip, {})


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ("3 -3", "'elbow': its limits 3 and -3 are swapped"),
        ("1 1.00001", "'elbow': its limits 1 and 1.00001 leave it no room"),
        ("", "'elbow' has no limits"),
    ],
)
def test_a_joint_that_cannot_move_is_refused(tmp_path: Path, limits: str, said: str) -> None:
    joints = tuple((*one[:4], limits) if one[0] == "elbow" else one for one in SIX)
    description = read_description(write_arm(tmp_path, joints))
    with pytest.raises(InputError, match=said):
        find_arm(description, "foot", "tool", {})


def test_a_joint_that_follows_another_is_none_of_an_arm(tmp_path: Path) -> None:
    file = write_arm(tmp_path)
    text = file.read_text().replace(
        '<joint name="elbow" type="revolute">',
        '<joint name="elbow" type="revolute"><mimic joint="lift"/>',
    )
    file.write_text(text)
    with pytest.raises(InputError, match="'elbow' follows 'lift': joints of an arm move by"):
        find_arm(read_description(file), "foot", "tool", {})
