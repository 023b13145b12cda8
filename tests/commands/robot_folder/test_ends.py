"""Which arms a URDF offers, and what becomes of the gripper that hangs there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot import Make, _wanted  # pyright: ignore[reportPrivateUsage]
from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.choose_gripper import choose_gripper, named_fingers
from tamp.commands.robot_folder.description import Description, read_description
from tamp.commands.robot_folder.ends import End, choose_end, ends
from tamp.commands.robot_folder.hand import tip_is_hand, tip_is_replaced
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


def test_an_arm_begins_behind_a_joint_that_moves_all_of_it(described) -> None:
    root = '<link name="world"/><joint name="floor" type="planar"><parent link="world"/><child link="foot"/></joint>'
    assert choose_end(described(root)) == End("foot", "tool", 6)


def sliding(axes: tuple[int, int], ranges: tuple[str, str], at: tuple[float, float]) -> str:
    """Return fingers, 1 cm thick, by their axes' signs along y, ranges, and origins along y."""
    text = ""
    for side, sign, limits, y in zip(("left", "right"), axes, ranges, at, strict=True):
        low, high = limits.split()
        text += (
            f'<link name="{side}_finger">{BOX.format(z=0.02, size="0.02 0.01 0.04")}</link>'
            f'<joint name="{side}_finger_joint" type="prismatic"><parent link="hand"/>'
            f'<child link="{side}_finger"/><origin xyz="0 {y} 0.06"/><axis xyz="0 {sign} 0"/>'
            f'<limit lower="{low}" upper="{high}" velocity="0.1"/></joint>'
        )
    return HAND + text


SLIDES = {
    "both along y": ((1, 1), ("0 0.04", "-0.04 0"), (0.005, -0.005)),
    "counted from open": ((1, -1), ("-0.04 0", "-0.04 0"), (0.045, -0.045)),
    "closing is positive": ((-1, 1), ("0 0.04", "0 0.04"), (0.045, -0.045)),
    "4 mm apart when closed": ((1, -1), ("0 0.038", "0 0.038"), (0.007, -0.007)),
    "right one first": ((-1, 1), ("0 0.04", "0 0.04"), (-0.005, 0.005)),
}


def hand_of(description: Description):
    wanted = Wanted(
        Path("arm.urdf"), "tool", Path("out"), fingers=("left_finger_joint", "right_finger_joint")
    )
    own = named_fingers(description, wanted)
    return choose_gripper(
        description, wanted, find_arm(description, "foot", "tool", {}), own, False
    )


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


def test_fingers_that_nobody_named_and_that_cannot_close_give_way_to_ours(described) -> None:
    crossed = described(sliding((1, -1), ("0 0.04", "0 0.04"), (-0.01, 0.01)))
    options = Make(urdf="arm.urdf", out=Path("out"))
    assert _wanted(options, crossed.file).fingers is None
    sound = described(sliding(*SLIDES["both along y"]))
    assert _wanted(options, sound.file).fingers == ("left_finger_joint", "right_finger_joint")


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
