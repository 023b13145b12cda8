"""Grippers of URDFs that hang on the arm of boxes: a hand, and fingers that part along y."""

from __future__ import annotations

from pathlib import Path

from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.choose_gripper import choose_gripper, named_fingers
from tamp.commands.robot_folder.description import Description
from tamp.commands.robot_folder.wanted import Wanted

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
