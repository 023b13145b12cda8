"""The gripper that a robot gets: its own fingers where they can grasp, else one of ours."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.choose_gripper import choose_gripper, closes, named_fingers
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tests.commands.robot_folder.hands import HAND, SLIDES, fingers, hand_of, sliding


@pytest.mark.parametrize("name", SLIDES)
def test_fingers_are_counted_from_where_their_pads_meet(described, name: str) -> None:
    gripper = hand_of(described(sliding(*SLIDES[name])))
    assert gripper.opening == pytest.approx(0.08)
    assert gripper.T_hand_tool.position == pytest.approx((0.0, 0.0, 0.1 - 0.0094))
    closing = gripper.T_hand_tool.rotation[:, 1]
    for opening in (0.0, 0.05):
        pads = [
            (joint.origin.apply(hulls[0].vertices) @ closing)
            + opening / 2 * float(joint.origin.rotation @ np.array(joint.axis) @ closing)
            for joint, hulls in zip(gripper.fingers, gripper.finger_hulls, strict=True)
        ]
        gap = max(pads[0].min() - pads[1].max(), pads[1].min() - pads[0].max())
        assert gap == pytest.approx(opening, abs=1e-6)


@pytest.mark.parametrize(
    ("says", "speed"), [("", 0.05), ('velocity="0"', 0.05), ('velocity="0.03"', 0.03), ('velocity="4"', 0.1)]
)  # fmt: skip
def test_fingers_move_as_fast_as_they_can_and_slowly_where_nobody_says(
    described, says: str, speed: float
) -> None:
    slow = sliding(*SLIDES["both along y"]).replace('velocity="0.1"', says)
    assert [joint.velocity for joint in hand_of(described(slow)).fingers] == [speed, speed]


@pytest.mark.parametrize(
    ("axes", "ranges", "at", "says"),
    [
        ((1, 1), ("0 0.04", "0 0.04"), (0.005, -0.005), "in each other at the end .* cannot close"),
        ((1, -1), ("0 0.04", "0 0.04"), (0.05, -0.05), "90 mm apart .* cannot close"),
        ((1, -1), ("0 0.04", "0 0.04"), (-0.01, 0.01), "30.0 mm in each other .* cannot close"),
        ((1, -1), ("0 0.001", "0 0.001"), (0.005, -0.005), "cannot open: they move 2.0 mm"),
        ((1, -1), ("0 0", "0 0.04"), (0.005, -0.005), "has no limits"),
    ],
)  # fmt: skip
def test_fingers_that_cannot_grasp_are_refused(described, axes, ranges, at, says: str) -> None:
    with pytest.raises(InputError, match=says):
        hand_of(described(sliding(axes, ranges, at)))


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


def wanted(**more: object) -> Wanted:
    return Wanted(Path("arm.urdf"), "tool", Path("out"), **more)  # type: ignore[arg-type]


def test_without_fingers_of_its_own_it_gets_ours_or_a_cup(described) -> None:
    description = described("")
    arm = find_arm(description, "foot", "tool", {})
    assert named_fingers(description, wanted()) is None
    usual = choose_gripper(description, wanted(), arm, None, False)
    assert (usual.opening, usual.force) == (0.085, 50.0)
    said = choose_gripper(description, wanted(opening=0.05, force=20.0), arm, None, False)
    assert (said.opening, said.force) == (0.05, 20.0)
    cup = choose_gripper(description, wanted(suction=0.02), arm, None, False)
    assert cup.fingers == ()


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"suction": 0.02, "opening": 0.05}, "--opening is of fingers"),
        ({"suction": 0.02, "fingers": ("a", "b")}, "--gripper is of fingers"),
        ({"fingers": ("left_finger_joint", "wrist3")}, "joint 'wrist3' turns"),
        ({"fingers": ("left_finger_jiont", "wrist3")}, "Did you mean 'left_finger_joint'"),
        ({"fingers": ("left_finger_joint", "far_joint")}, "the fingers hang on two links"),
    ],
)
def test_what_are_no_two_fingers_is_refused(described, more: dict, said: str) -> None:
    far = '<link name="far"/><joint name="far_joint" type="prismatic"><parent link="foot"/>' + (
        '<child link="far"/><axis xyz="0 1 0"/><limit lower="0" upper="1"/></joint>'
    )
    description = described(HAND + fingers("prismatic") + far)
    with pytest.raises(InputError, match=said):
        named_fingers(description, wanted(**more))
    assert not closes(description, wanted(**more))


def test_a_finger_without_limits_has_those_of_the_one_that_it_follows(described) -> None:
    mimic = '<mimic joint="left_finger_joint" multiplier="-0.5" offset="0.01"/>'
    text = fingers("prismatic", mimic=mimic)
    left, _, right = text.partition('<link name="right_finger">')
    right = right.replace('<limit lower="0" upper="0.04" velocity="0.1"/>', "")
    description = described(f'{HAND}{left}<link name="right_finger">{right}')
    own = named_fingers(description, wanted(fingers=("left_finger_joint", "right_finger_joint")))
    assert own is not None and (own[0].lower, own[0].upper) == (0.0, 0.04)
    assert (own[1].lower, own[1].upper) == pytest.approx((-0.01, 0.01))  # 0.01 - 0.5 * [0, 0.04]


def test_fingers_that_could_not_close_are_no_gripper(described) -> None:
    both = ("left_finger_joint", "right_finger_joint")
    assert closes(described(sliding(*SLIDES["both along y"])), wanted(fingers=both))
    crossed = sliding((1, -1), ("0 0.04", "0 0.04"), (-0.01, 0.01))
    assert not closes(described(crossed), wanted(fingers=both))
