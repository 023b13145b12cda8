"""The gripper in a URDF: what of it hangs on the tip, and whether the tip itself is its body."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.choose_gripper import choose_gripper, named_fingers
from tamp.commands.robot_folder.hand import find_hand, tip_is_hand, tip_is_replaced
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tests.commands.robot_folder.hands import BOX, HAND, fingers


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


@pytest.mark.parametrize(
    ("name", "kind", "replaced"),
    [("gripper_link", "revolute", True), ("palm", "revolute", True),
     ("gripper_link", "fixed", False), ("flange", "revolute", False)],
)  # fmt: skip
def test_the_body_of_a_gripper_gives_way_to_ours_with_its_jaw(
    described, name: str, kind: str, replaced: bool
) -> None:
    wrist = (
        HAND.replace('"hand"', f'"{name}"').replace('type="fixed"', 'type="revolute"')
        .replace("</joint>", '<limit lower="-1" upper="1"/></joint>')
    )  # fmt: skip
    description = described(wrist + fingers(kind, name))
    assert tip_is_replaced(description, name) is replaced
    arm = find_arm(description, "foot", name, {}, ours=True, bare=replaced)
    assert arm.dropped == ((name,) if replaced else ())
    assert (name in arm.groups[-1].links) is not replaced


def test_fingers_that_hang_elsewhere_are_refused(described) -> None:
    description = described(HAND + fingers("prismatic"))
    pair = tuple(description.joints[f"{side}_finger_joint"] for side in ("left", "right"))
    with pytest.raises(
        InputError, match="'left_finger_joint' does not hang on the arm's tip 'left_finger'"
    ):
        find_hand(description, "left_finger", pair, {})


def test_what_hangs_on_a_finger_moves_with_it_and_the_rest_is_the_hand(described) -> None:
    pad = f'<link name="pad">{BOX.format(z=0.01, size="0.01 0.01 0.01")}</link>' + (
        '<joint name="glue" type="fixed"><parent link="left_finger"/><child link="pad"/></joint>'
    )
    description = described(HAND + fingers("prismatic") + pad)
    pair = tuple(description.joints[f"{side}_finger_joint"] for side in ("left", "right"))
    hand, joints, (left, right) = find_hand(description, "tool", pair, {})
    assert (hand.name, hand.links) == ("tool_hand", ("hand",))
    assert (left.links, right.links) == (("left_finger", "pad"), ("right_finger",))
    assert [joint.parent for joint in joints] == ["tool_hand"] * 2
    assert joints[0].origin.position == pytest.approx((0.0, 0.0, 0.06))
    bare, *_ = find_hand(description, "hand", pair, {}, bare=True)
    assert bare.links == ("hand",)
    assert find_hand(description, "hand", pair, {})[0].links == ()
