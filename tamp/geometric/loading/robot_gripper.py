"""The gripper in a robot.yaml: two fingers that slide, or a suction cup."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.robot.robot import Suction
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose

KINDS = ("parallel", "suction")

VACUUM_N_M2 = 101_325.0
"""Newtons a square metre: no cup pulls with more than the air presses."""

LARGEST_TILT_RAD = math.radians(45.0)
"""Radians by which a face may lean against any cup."""

_SHARED = ("kind", "hand", "mount", "tool", "force")
_ENTRIES = {
    "parallel": (*_SHARED, "opening", "speed", "fingers"),
    "suction": (*_SHARED, "radius", "tilt"),
}


@dataclass(frozen=True)
class ReadGripper:
    """A gripper as a robot.yaml describes it; the names are those of `Robot`.

    Attributes:
        node: Where the hand is named.
    """

    node: YamlNode
    hand: str
    T_flange_hand: Pose
    T_hand_tool: Pose
    opening: float
    force: float
    fingers: tuple[Joint, ...]
    suction: Suction | None


def read_gripper(node: YamlNode) -> ReadGripper:
    """Read the entry `gripper`.

    Raises:
        InputError: It says what cannot be, with the line.
    """
    some = node.mapping()
    kind = some["kind"].text(KINDS, "kind of gripper") if "kind" in some else "parallel"
    entries = node.mapping(_ENTRIES[kind], required=_ENTRIES[kind])

    hand, force = entries["hand"], entries["force"].number(positive=True)
    fingers: tuple[Joint, ...] = ()
    opening, suction = 0.0, None
    if kind == "parallel":
        opening, fingers = entries["opening"].number(positive=True), _fingers(entries)
    else:
        suction = _cup(entries["radius"], entries["tilt"], entries["force"])
    return ReadGripper(
        hand, hand.text(), read_pose(entries["mount"]), read_pose(entries["tool"]), opening, force,
        fingers, suction,
    )  # fmt: skip


def _cup(radius: YamlNode, tilt: YamlNode, force: YamlNode) -> Suction:
    cup = Suction(radius.number(positive=True), tilt.number())
    if not 0.0 <= cup.tilt <= LARGEST_TILT_RAD:
        raise tilt.error(f"a face may lean by 0 to {LARGEST_TILT_RAD:.3g} rad, not by {cup.tilt:g}")
    most = VACUUM_N_M2 * math.pi * cup.radius**2
    if force.number() > most:
        raise force.error(
            f"a cup of radius {cup.radius:g} m pulls with {most:.3g} N at most, not with "
            f"{force.number():g}",
            remedy="The air presses with no more: give a larger radius or a smaller force",
        )
    return cup


def _fingers(gripper: dict[str, YamlNode]) -> tuple[Joint, ...]:
    entries = gripper["fingers"].mapping()
    if len(entries) != 2:
        raise gripper["fingers"].error(f"a parallel gripper has two fingers, not {len(entries)}")
    speed, opening = gripper["speed"].number(positive=True), gripper["opening"].number()
    found: list[Joint] = []
    for name, node in entries.items():
        entry = node.mapping(("link", "origin", "axis"), required=("link", "origin", "axis"))
        x, y, z = entry["axis"].numbers(3)
        hand, link, origin = (
            gripper["hand"].text(),
            entry["link"].text(),
            read_pose(entry["origin"]),
        )
        found.append(
            Joint(name, "prismatic", hand, link, origin, (x, y, z), 0.0, opening / 2, speed)
        )
    return tuple(found)


def read_pose(node: YamlNode) -> Pose:
    """Read a position and a quaternion."""
    entries = node.mapping(("xyz", "quaternion"), required=("xyz", "quaternion"))
    x, y, z = entries["xyz"].numbers(3)
    a, b, c, d = entries["quaternion"].numbers(4)
    if abs(math.hypot(a, b, c, d) - 1.0) > 1e-6:
        raise entries["quaternion"].error("its norm is not 1")
    return Pose((x, y, z), (a, b, c, d))
