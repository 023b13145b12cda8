"""The arm in a URDF: the chain of joints from one link to another, and what each of them moves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tamp.commands.robot_folder.description import MOVING, Description
from tamp.commands.robot_folder.joint_motion import clean, stands, z_onto
from tamp.errors import InputError
from tamp.geometric.loading.urdf_link import Element
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array, Pose

FEWEST, LARGEST = 2, 10
"""Joints of an arm."""

GRIPPER = ("finger", "knuckle", "jaw", "thumb", "gripper")
"""Words in the names of links of grippers."""


@dataclass(frozen=True)
class LinkGroup:
    """A group of links that moves as one: elements of the URDF at their poses in its frame.

    Attributes:
        name: Of the link that the joint moves.
        elements: Their poses are those in the group's frame.
        mass: Kilograms.
        links: Names of the links of the URDF.
    """

    name: str
    elements: tuple[Element, ...]
    mass: float
    links: tuple[str, ...]


@dataclass(frozen=True)
class Arm:
    """An arm whose joints turn about their own z, or slide along it.

    Attributes:
        joints: From the base on; the first's origin is in the foot's frame.
        groups: The foot, then what each joint moves.
        T_last_tip: The tip in the last joint's frame.
        T_root_foot: The foot in the frame of the URDF's root.
        velocity, effort: Of each joint.
        dropped: Links of a gripper beside the tip, or the tip as its body, that another one takes
            the place of.
    """

    joints: tuple[Joint, ...]
    groups: tuple[LinkGroup, ...]
    T_last_tip: Pose
    T_root_foot: Pose
    velocity: tuple[float, ...]
    effort: tuple[float, ...]
    dropped: tuple[str, ...] = ()


def find_arm(
    description: Description,
    base: str,
    tip: str,
    fixed: Mapping[str, float],
    ours: bool = True,
    bare: bool = False,
) -> Arm:
    """Find the arm between two links.

    Args:
        description: The robot.
        base: The link that the arm begins with; all that does not hang on the arm belongs to it.
        tip: The link that it ends with.
        fixed: Where joints stand that are no part of the arm, by name.
        ours: Whether another gripper takes the place of the URDF's own: links of one beside the tip
            are left out, as what hangs on the tip is in any case.
        bare: Whether the tip's own shapes are left out, too: they are the hand's.

    Raises:
        InputError: Unknown links, one that is not below the other, limits that are missing or
            swapped.
    """
    joints = _chain(description, base, tip)
    _check_names(description, fixed)
    turns = [z_onto(joint.axis) for joint in joints]

    # Where the frames of what no joint of the arm moves in between are.
    place: dict[str, tuple[int, Array]] = {base: (0, np.eye(4))}
    numbers = {joint.name: number for number, joint in enumerate(joints, start=1)}
    found: list[Joint] = []
    below = _descendants(description, tip) - (set[str]() if bare else {tip})
    beside = _beside(description, joints[-1].child, tip) - below if ours else set[str]()
    for joint in outwards(description, base):
        number, T = place[joint.parent]
        T = T @ joint.origin.matrix
        if joint.name in numbers:
            number = numbers[joint.name]
            T = T @ turns[number - 1]
            found.append(_turned(joint, Pose.from_matrix(clean(T))))
            place[joint.child] = number, turns[number - 1].T.copy()
        else:
            place[joint.child] = number, T @ stands(description, joint, fixed)
    root = _upwards(description, base, fixed, place)

    names = [base, *(joint.child for joint in joints)]
    left_out = below | beside
    groups = [
        _group(description, name, number, place, left_out) for number, name in enumerate(names)
    ]
    return Arm(
        joints=tuple(found),
        groups=tuple(groups),
        T_last_tip=Pose.from_matrix(clean(place[tip][1])),
        T_root_foot=Pose.from_matrix(clean(np.linalg.inv(place[root][1]))),
        velocity=tuple(joint.velocity or 1.0 for joint in joints),
        effort=tuple(description.efforts[joint.name] or 100.0 for joint in joints),
        dropped=tuple(
            sorted(
                name
                for name in {*beside, *([tip] if ours and bare else [])}
                if description.links[name]
            )
        ),
    )


def _beside(description: Description, last: str, tip: str) -> set[str]:
    """List the links of a gripper that hangs beside the tip: what moves there, and what is called
    so.
    """
    way = {tip}
    link = tip
    while link != last and (joint := description.joint_to(link)) is not None:
        link = joint.parent
        way.add(link)

    found: set[str] = set()
    for joint in outwards(description, last):
        named = any(word in joint.child.lower() for word in GRIPPER)
        if joint.child not in way and (joint.parent in found or joint.kind in MOVING or named):
            found.add(joint.child)
    return found


def _chain(description: Description, base: str, tip: str) -> list[Joint]:
    """List the moving joints from base to tip, whose limits are checked."""
    file, links = description.file, tuple(description.links)
    for role, name in (("base", base), ("tip", tip)):
        if name not in description.links:
            raise InputError(f"the arm's {role}: unknown link '{name}'", file=file, found=name,
                             choices=links)  # fmt: skip

    way: list[Joint] = []
    link = tip
    while link != base:
        joint = description.joint_to(link)
        if joint is None:
            what = f"'{tip}' does not hang on '{base}': the way from it ends at '{link}'"
            raise InputError(
                what, file=file, remedy="Name a base above the tip, such as the robot's root"
            )
        way.append(joint)
        link = joint.parent

    way.reverse()
    moving = [joint for joint in way if joint.kind != "fixed"]
    for joint in moving:
        _check_joint(description, joint)
    if not FEWEST <= len(moving) <= LARGEST:
        raise InputError(
            f"between '{base}' and '{tip}' are {len(moving)} moving joints: an arm has "
            f"{FEWEST} to {LARGEST}",
            file=file,
        )
    return moving


def _check_joint(description: Description, joint: Joint) -> None:
    file = description.file
    if joint.kind not in MOVING:
        raise InputError(f"joint '{joint.name}': {joint.kind} joints are no part of an arm",
                         file=file)  # fmt: skip
    if joint.name in description.mimics:
        raise InputError(
            f"joint '{joint.name}' follows '{description.mimics[joint.name][0]}': joints of an arm "
            "move by themselves",
            file=file,
        )
    if joint.kind == "continuous":
        return

    if math.isnan(joint.lower):
        remedy = 'Give it <limit lower="..." upper="..."/>'
        if joint.kind == "revolute":
            remedy += ', or type="continuous"'
        raise InputError(f"joint '{joint.name}' has no limits", file=file, remedy=remedy)
    least = 2 * (LIMIT_MARGIN_RAD if joint.kind == "revolute" else LIMIT_MARGIN_RAD / 10)
    if not joint.upper - joint.lower > least:
        what = "are swapped" if joint.upper < joint.lower else "leave it no room"
        raise InputError(
            f"joint '{joint.name}': its limits {joint.lower:g} and {joint.upper:g} {what}",
            file=file,
        )


def _check_names(description: Description, fixed: Mapping[str, float]) -> None:
    for name in fixed:
        if name not in description.joints:
            raise InputError(f"unknown joint '{name}'", file=description.file, found=name,
                             choices=tuple(description.joints))  # fmt: skip


def outwards(description: Description, base: str) -> Sequence[Joint]:
    """List all joints below a link, parents first."""
    order: list[Joint] = []
    links = [base]
    while links:
        link = links.pop()
        for joint in description.joints.values():
            if joint.parent == link:
                order.append(joint)
                links.append(joint.child)
    return order


def _descendants(description: Description, link: str) -> set[str]:
    return {link, *(joint.child for joint in outwards(description, link))}


def _upwards(
    description: Description,
    base: str,
    fixed: Mapping[str, float],
    place: dict[str, tuple[int, Array]],
) -> str:
    """Place what the base hangs on, and what else hangs on that; return the root."""
    link = base
    while (joint := description.joint_to(link)) is not None:
        T = place[link][1] @ np.linalg.inv(joint.origin.matrix @ stands(description, joint, fixed))
        place[joint.parent] = 0, T
        for other in outwards(description, joint.parent):
            if other.child not in place:
                T_parent = place[other.parent][1]
                T_child = T_parent @ other.origin.matrix @ stands(description, other, fixed)
                place[other.child] = 0, T_child
        link = joint.parent
    return link


def _group(
    description: Description,
    name: str,
    number: int,
    place: Mapping[str, tuple[int, Array]],
    without: set[str],
) -> LinkGroup:
    found: list[Element] = []
    links = [link for link, (frame, _) in place.items() if frame == number and link not in without]
    for link in links:
        pose = Pose.from_matrix(clean(place[link][1]))
        found += [
            Element(pose @ one.pose, one.shape, one.mesh, one.scale)
            for one in description.links[link]
        ]
    mass = sum(description.masses[link] for link in links)
    return LinkGroup(name, tuple(found), mass, tuple(links))


def _turned(joint: Joint, origin: Pose) -> Joint:
    return Joint(
        joint.name, joint.kind, joint.parent, joint.child, origin, (0.0, 0.0, 1.0), joint.lower,
        joint.upper, joint.velocity,
    )  # fmt: skip
