"""Several arms on one body: each is a robot to which the others stand still."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose


@dataclass(frozen=True)
class Posture:
    """Posture of an arm that holds still.

    Attributes:
        joints: Positions, radians or metres.
        opening: Of its fingers, metres.
        held: What is in its hand, with its parts and its pose in the tool's frame; or None.
    """

    joints: tuple[float, ...]
    opening: float
    held: tuple[Link, Pose] | None = None


@dataclass(frozen=True)
class Mobile:
    """Base of several arms, with the limits of its motions.

    Attributes:
        name: The robot's.
        base: Its link, in the frame on the floor.
        velocity, acceleration: Limits of base x, base y and base yaw, per second (squared).
        drive: How it moves, one of `robot.DRIVES`.
        turning_radius: Of a car, metres.
        folder: The robot's.
    """

    name: str
    base: Link
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    drive: str
    folder: Path
    turning_radius: float | None = None


def at_home(arm: Robot) -> Posture:
    """Return the posture of an arm between actions: at home, the hand open and empty."""
    return Posture(arm.home, arm.opening)


def beside(arms: Iterable[Robot], name: str, postures: Mapping[str, Posture]) -> Robot:
    """Return one of a body's arms as a robot to which the others stand still.

    Args:
        arms: All of them, each with its own links and the base.
        name: Of the one that moves.
        postures: Of the others by name; at home without one.
    """
    arms = tuple(arms)
    moving = next(arm for arm in arms if arm.arm == name)
    still_links: dict[str, Pose] = {}
    held: list[Link] = []

    for arm in arms:
        if arm is moving:
            continue
        posture = postures.get(arm.arm) or at_home(arm)
        still_links |= _link_poses(arm, posture)
        if posture.held is not None:
            body, T_tool_body = posture.held
            held.append(body)
            still_links[body.name] = still_links[arm.hand] @ arm.T_hand_tool @ T_tool_body

    return replace(moving, links=(*moving.links, *held), still_links=still_links)


def _link_poses(arm: Robot, posture: Posture) -> dict[str, Pose]:
    """Compute where an arm's links are in the base's frame, from the foot on."""
    poses, T = {arm.foot: arm.T_base_arm}, arm.T_base_arm
    for joint, q in zip(arm.joints, posture.joints, strict=True):
        slides = joint.kind == "prismatic"
        T = T @ joint.origin @ (Pose((0.0, 0.0, q)) if slides else Pose.from_xyz_yaw(0, 0, 0, q))
        poses[joint.child] = T

    poses[arm.hand] = T @ arm.T_flange_hand
    for finger in arm.fingers:
        x, y, z = (part * posture.opening / 2 for part in finger.axis)
        poses[finger.child] = poses[arm.hand] @ finger.origin @ Pose((x, y, z))
    return poses


def as_arm(body: Mobile, own: Robot, name: str, mount: Pose) -> Robot:
    """Return the arm of a robot as one of another robot's body.

    Of what its links may touch of the base only the foot and the first link are taken over: the
    body's base is another one.

    Args:
        body: What it stands on.
        own: The robot, of one arm.
        name: Of the arm, with which the names of its links and joints begin.
        mount: Its foot in the base's frame.
    """
    prefix = f"{name}_"
    links = (body.base, *(replace(one, name=prefix + one.name) for one in own.links[1:]))

    def renamed(joint: Joint) -> Joint:
        return replace(
            joint, name=prefix + joint.name, parent=prefix + joint.parent,
            child=prefix + joint.child,
        )  # fmt: skip

    among = {(prefix + a, prefix + b) for a, b in own.allowed if own.base not in (a, b)}
    lowest = (prefix + own.foot, prefix + own.joints[0].child)
    return replace(
        own,
        name=body.name,
        links=links,
        base=body.base.name,
        foot=prefix + own.foot,
        hand=prefix + own.hand,
        T_base_arm=mount,
        joints=tuple(map(renamed, own.joints)),
        fingers=tuple(map(renamed, own.fingers)),
        velocity=(*body.velocity, *own.velocity[3:]),
        acceleration=(*body.acceleration, *own.acceleration[3:]),
        allowed=frozenset(among | {_pair(body.base.name, one) for one in lowest}),
        folder=body.folder,
        drive=body.drive,
        turning_radius=body.turning_radius,
        arm=name,
        prefix=prefix,
        described=((prefix, own.folder),),
        tabled=(own.folder, own.T_base_arm),
    )


def _pair(first: str, second: str) -> tuple[str, str]:
    return min(first, second), max(first, second)


def joined(arms: Iterable[Robot], touching: frozenset[tuple[str, str]] = frozenset()) -> Robot:
    """Return the robot of several arms: the first one, the others beside it and at home.

    Args:
        arms: Each with its own links and the base.
        touching: Pairs of links of several arms, each sorted, that are never checked.
    """
    alone = tuple(arms)
    base = alone[0].links[:1]
    links = (*base, *(link for arm in alone for link in arm.links[1:]))
    allowed = touching.union(*(arm.allowed for arm in alone))
    described = tuple(place for arm in alone for place in arm.described)
    whole = [replace(arm, links=links, allowed=allowed, described=described) for arm in alone]
    still = [beside(whole, arm.arm, {}) for arm in whole]
    return replace(still[0], beside=tuple(still[1:]))
