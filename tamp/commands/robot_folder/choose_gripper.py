"""The gripper that a robot is made with: ours, or the URDF's own."""

from __future__ import annotations

from dataclasses import replace

from tamp.commands.robot_folder.arm import Arm, find_arm
from tamp.commands.robot_folder.convex import joined, solids
from tamp.commands.robot_folder.description import Description
from tamp.commands.robot_folder.gripper import (
    Gripper,
    along,
    outward_axis,
    suction_cup,
    two_fingers,
)
from tamp.commands.robot_folder.hand import find_hand, tip_is_hand
from tamp.commands.robot_folder.sliding_fingers import own_fingers
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose

FINGER_FORCE = 50.0
"""Newtons with which a finger presses where nobody says more."""


def named_fingers(description: Description, wanted: Wanted) -> tuple[Joint, Joint] | None:
    """Find the joints of the URDF's own fingers; None where ours are wanted.

    Raises:
        InputError: One is unknown, or turns; they hang on two links.
    """
    if wanted.suction is not None:
        for option, given in (("--gripper", wanted.fingers), ("--opening", wanted.opening)):
            if given is not None:
                raise InputError(
                    f"{option} is of fingers, and --suction makes a gripper without any",
                    remedy=f"Leave {option} or --suction out",
                )
    if wanted.fingers is None:
        return None

    found: list[Joint] = []
    for name in wanted.fingers:
        if name not in description.joints:
            raise InputError(f"the gripper: unknown joint '{name}'", file=description.file,
                             found=name, choices=tuple(description.joints))  # fmt: skip
        if description.joints[name].kind != "prismatic":
            raise InputError(
                f"the gripper: joint '{name}' turns, only fingers that slide are known",
                file=description.file,
                remedy="Leave --gripper out: one of ours is bolted to the tip",
            )
        found.append(_limited(description, description.joints[name]))
    if found[0].name == found[1].name:
        raise InputError(f"the gripper: '{found[0].name}' is named twice", file=description.file)
    if found[0].parent != found[1].parent:
        raise InputError("the fingers hang on two links", file=description.file)
    return found[0], found[1]


def closes(description: Description, wanted: Wanted) -> bool:
    """Check whether the URDF's own fingers make a gripper."""
    try:
        fingers = named_fingers(description, wanted)
        if fingers is not None:
            bare = tip_is_hand(description, wanted.tip, fingers)
            base = wanted.base or description.root
            arm = find_arm(description, base, wanted.tip, wanted.fixed, False, bare)
            choose_gripper(description, wanted, arm, fingers, bare)
    except InputError:
        return False
    return True


def _limited(description: Description, joint: Joint) -> Joint:
    """Return a finger's joint with limits: its own, or those of the joint that it follows.

    Raises:
        InputError: It has none.
    """
    if joint.upper > joint.lower:
        return joint
    name, factor, offset = description.mimics.get(joint.name, ("", 1.0, 0.0))
    master = description.joints.get(name)
    if master is None or not master.upper > master.lower:
        raise InputError(
            f"the gripper: joint '{joint.name}' has no limits", file=description.file,
            remedy='Give it <limit lower="..." upper="..."/>',
        )  # fmt: skip
    ends = sorted(factor * value + offset for value in (master.lower, master.upper))
    return replace(joint, lower=ends[0], upper=ends[1])


def choose_gripper(
    description: Description,
    wanted: Wanted,
    arm: Arm,
    fingers: tuple[Joint, Joint] | None,
    bare: bool,
) -> Gripper:
    """Make ours, or take the URDF's own: what hangs on the tip, but for the fingers, is the hand,
    in the tip's frame.
    """
    force = FINGER_FORCE if wanted.force is None else wanted.force
    if wanted.suction is not None:
        T = along(wanted.axis or outward_axis(arm))
        return suction_cup(wanted.suction, wanted.force, T)
    if fingers is None:
        opening = 0.085 if wanted.opening is None else wanted.opening
        return two_fingers(opening, force, along(wanted.axis or outward_axis(arm)))
    hand, joints, moved = find_hand(description, wanted.tip, fingers, wanted.fixed, bare)
    hulls = [
        joined([h for one in solids(group.elements, group.name) for h in one.hulls], group.name)
        for group in (hand, *moved)
    ]
    return own_fingers(joints, hulls[0], (hulls[1], hulls[2]), Pose(), wanted.opening, force)
