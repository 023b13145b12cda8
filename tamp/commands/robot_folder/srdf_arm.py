"""Arm and gripper as an SRDF has them: groups that are chains, and hands that hang on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tamp.commands.robot_folder.arm import FEWEST, LARGEST, outwards
from tamp.commands.robot_folder.description import MOVING, Description
from tamp.commands.robot_folder.ends import SHOWN, End, ends, is_finger
from tamp.commands.robot_folder.srdf import PlanningGroup, Srdf, links_above
from tamp.errors import InputError
from tamp.geometric.robot.urdf import Joint

ARMS = ("arm", "manipulator")
"""Words in the names of groups that are arms."""


@dataclass(frozen=True)
class ArmGroup:
    """A group that is one chain of joints that move by themselves.

    Attributes:
        group: It.
        base, tip: The links that it begins and ends with.
        joints: Moving ones, from the base on, by name.
        hand: Name of the end effector that hangs on it; empty without one.
    """

    group: PlanningGroup
    base: str
    tip: str
    joints: tuple[str, ...]
    hand: str = ""


def choose_arm(srdf: Srdf, description: Description) -> tuple[End | None, str]:
    """Choose the arm of a URDF that branches: the only group with a hand or the name of an arm, or
    the only one if no chain of the URDF is longer; of nested ones the longest, with its lift.

    Returns:
        The arm with a sentence about it; nothing where no group is one.

    Raises:
        InputError: Several are, with the choices: legs and heads are chains, too.
    """
    last: dict[str, ArmGroup] = {}  # the longest that ends with a joint
    for arm in arm_groups(srdf, description):
        before = last.get(arm.joints[-1])
        if before is None or len(arm.joints) > len(before.joints):
            last[arm.joints[-1]] = arm
    if not last:
        return None, ""

    found = {_moving(description, end.tip)[-1].name: end for end in ends(description)}
    named = [arm for arm in last.values() if any(word in arm.group.name.lower() for word in ARMS)]
    among = [arm for arm in last.values() if arm.hand] or named
    if not among:
        among = [*last.values()]
        longest = max((end.joints for end in found.values()), default=0)
        sure = len(among) == 1 and len(among[0].joints) >= longest
    else:
        sure = len(among) == 1
    if not sure:
        raise _several(
            srdf, description, among, [found[name] for name in found if name not in last]
        )

    arm = among[0]
    end = found.get(arm.joints[-1], End(arm.base, arm.tip, len(arm.joints)))
    said = (
        f"the arm is {srdf.place(arm.group.line)}'s group '{arm.group.name}': "
        f"--arm {arm.base} {end.tip}"
    )
    return replace(end, base=arm.base, joints=len(arm.joints)), said


def _several(
    srdf: Srdf, description: Description, groups: Sequence[ArmGroup], others: Sequence[End]
) -> InputError:
    """Name the groups that may be the arm, and the chains of which the SRDF says nothing."""
    shown = [f"--arm {arm.base} {arm.tip} ({arm.group.name})" for arm in groups]
    shown += [f"--arm {end.base} {end.tip}" for end in others]
    what = f"{len(groups)} group{'s' if len(groups) > 1 else ''} that may be the arm"
    return InputError(
        f"the URDF branches, and {srdf.file.name} has {what}",
        file=description.file, remedy=f"Say which: {', '.join(shown[:SHOWN])}",
    )  # fmt: skip


def arm_groups(srdf: Srdf, description: Description) -> list[ArmGroup]:
    """List the groups that are chains of as many joints as arms have, in the file's order; fingers
    at their ends are no part of them.
    """
    hands = _hands(srdf, description)
    fingers = {name for _, joints in hands.values() for name in joints}
    fingers |= {
        joint.name for joint in description.joints.values()
        if joint.kind in MOVING and is_finger(description, joint)
    }  # fmt: skip
    found: list[ArmGroup] = []
    for group in srdf.groups.values():
        named = joints_of(srdf, description, group) - fingers
        moving = {
            name for name in named
            if description.joints[name].kind in MOVING and name not in description.mimics
        }  # fmt: skip
        if not FEWEST <= len(moving) <= LARGEST:
            continue

        way = max((_above(description, description.joints[name]) for name in named), key=len)
        inside = [joint for joint in way if joint.name in named]
        between = way[way.index(inside[0]) :]
        if {joint.name for joint in between if joint.kind != "fixed"} != moving:
            continue  # a tree, or a chain with joints of others in between
        joints = tuple(joint.name for joint in between if joint.name in moving)
        wrist = description.joints[joints[-1]].child
        hand = next(
            (name for name, (parent, _) in hands.items()
             if wrist in links_above(description, parent)),
            "",
        )  # fmt: skip
        found.append(ArmGroup(group, inside[0].parent, way[-1].child, joints, hand))
    return found


def choose_fingers(
    srdf: Srdf, description: Description, tip: str
) -> tuple[tuple[str, str] | None, str]:
    """Find the two sliding finger joints of the end effector that hangs on a tip, with a sentence;
    nothing where its fingers turn, or there is none.
    """
    below = {joint.name for joint in outwards(description, tip)}
    for hand in srdf.end_effectors:
        _, joints = _hands(srdf, description).get(hand.name, ("", frozenset[str]()))
        if not joints or not joints <= below:
            continue
        followers = {name for name, (master, *_) in description.mimics.items() if master in joints}
        sliding = sorted(
            name for name in joints | (followers & below)
            if description.joints[name].kind == "prismatic"
        )  # fmt: skip
        if len(sliding) == 2:
            said = (
                f"the gripper is {srdf.place(hand.line)}'s end effector '{hand.name}': "
                f"--gripper {' '.join(sliding)}"
            )
            return (sliding[0], sliding[1]), said
    return None, ""


def joints_of(srdf: Srdf, description: Description, group: PlanningGroup) -> frozenset[str]:
    """Collect the joints of a group: its own, those that move its links, those of its chains, and
    those of its groups.
    """
    found: set[str] = set()
    seen: set[str] = set()
    left = [group]
    while left:
        one = left.pop()
        if one.name in seen:
            continue
        seen.add(one.name)
        left += [srdf.groups[name] for name in one.groups if name in srdf.groups]
        links = list(one.links)
        for base, tip in one.chains:
            way = links_above(description, tip)
            links += way[: way.index(base)]
        moved = (description.joint_to(link) for link in links)
        found |= {joint.name for joint in moved if joint is not None} | {*one.joints}
    return frozenset(found)


def _hands(srdf: Srdf, description: Description) -> dict[str, tuple[str, frozenset[str]]]:
    """Return each end effector's parent link and moving joints, if these hang on it: a group that
    is the arm itself is no hand.
    """
    found: dict[str, tuple[str, frozenset[str]]] = {}
    for hand in srdf.end_effectors:
        below = {joint.name for joint in outwards(description, hand.parent)}
        joints = joints_of(srdf, description, srdf.groups[hand.group])
        if joints <= below:
            moving = {name for name in joints if description.joints[name].kind in MOVING}
            found[hand.name] = hand.parent, frozenset(moving)
    return found


def _above(description: Description, joint: Joint) -> list[Joint]:
    """List the joints from the root to one."""
    links = links_above(description, joint.child)
    moved = (description.joint_to(link) for link in reversed(links))
    return [one for one in moved if one is not None]


def _moving(description: Description, link: str) -> Sequence[Joint]:
    """List the moving joints from the root to a link."""
    moved = (description.joint_to(one) for one in reversed(links_above(description, link)))
    return [joint for joint in moved if joint is not None and joint.kind in MOVING]
