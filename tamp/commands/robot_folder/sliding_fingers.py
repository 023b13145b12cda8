"""A URDF's own gripper of two sliding fingers, however its joints count."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tamp.commands.robot_folder.gripper import TIP, USUAL_SPEED, Gripper
from tamp.errors import InputError
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Hull

INSIDE = 0.01
"""Metres that two closed fingers' hulls may be in each other: they are rounder than fingers are."""

APART = 0.02
"""Metres that two closed fingers may be apart, at most."""

CENTRED = 0.003
"""Metres that fingers may be beside their joints and count as in the middle of them."""

OURS = "Leave --gripper out, with --arm: one of ours takes its place"

FASTEST = 0.1
"""Metres a second of a finger, whatever its description says."""

LEAST = 0.005
"""Metres that a gripper opens at least."""

Hulls = tuple[Hull, ...]


def own_fingers(
    joints: tuple[Joint, Joint],
    hand: Hulls,
    finger_hulls: tuple[Hulls, Hulls],
    T_tip_hand: Pose,
    opening: float | None,
    force: float,
) -> Gripper:
    """Make a gripper of two prismatic joints of the URDF, whose frames are given in the hand's.

    Each joint is counted anew: 0 where its pad meets the other one's, positive outwards. The
    closing direction is that of the joints, the tool's z points from the hand to the fingers, and
    its origin is between the pads, TIP before the tips.

    Raises:
        InputError: The fingers do not move towards each other, have no shape, cannot close or open.
    """
    names = " and ".join(joint.name for joint in joints)
    if not all(finger_hulls):
        raise InputError(f"the fingers {names} have no collision shapes")
    outward = _outwards(joints, finger_hulls, names)
    closing = outward[0].origin.rotation @ np.array(outward[0].axis)
    corners = [_corners(joint, hulls) for joint, hulls in zip(outward, finger_hulls, strict=True)]
    inner, other = float((corners[0] @ closing).min()), float((corners[1] @ closing).max())
    gap = inner - other
    if gap < -INSIDE:
        raise InputError(
            f"the fingers {names} are {-1000 * gap:.1f} mm in each other at the end of their way: "
            "the gripper cannot close",
            remedy=OURS,
        )
    if gap > APART:
        raise InputError(
            f"the fingers {names} are {1000 * gap:.0f} mm apart at the end of their way: the "
            "gripper cannot close",
            remedy=OURS,
        )

    met = tuple(
        replace(_moved(joint, -gap / 2), velocity=min(joint.velocity or USUAL_SPEED, FASTEST))
        for joint in outward
    )
    widest = 2 * (min(joint.upper for joint in outward) + gap / 2)
    if widest < LEAST:
        raise InputError(f"the fingers {names} cannot open: they move {1000 * widest:.1f} mm")
    if opening is not None and opening > widest + 1e-6:
        raise InputError(f"--opening {opening:g}: the fingers {names} open {widest:.3g} m")

    origins = np.mean([joint.origin.position for joint in met], axis=0)
    T = _tool((inner + other) / 2, closing, np.concatenate(corners), origins, hand)
    return Gripper(
        hand, (met[0], met[1]), finger_hulls, T_tip_hand, T,
        widest if opening is None else opening, force,
    )  # fmt: skip


def _outwards(
    joints: tuple[Joint, Joint], hulls: tuple[Hulls, Hulls], names: str
) -> tuple[Joint, Joint]:
    """Turn the axes of both joints outwards, 0 at the inner end of their ways."""
    axes = [joint.origin.rotation @ np.array(joint.axis) for joint in joints]
    # where the fingers are in the middle of their ways, they are on their own sides
    middles = [
        _corners(_moved(joint, (joint.lower + joint.upper) / 2), some).mean(axis=0)
        for joint, some in zip(joints, hulls, strict=True)
    ]
    apart = middles[0] - middles[1]
    found: list[Joint] = []
    for joint, axis, side in zip(joints, axes, (apart, -apart), strict=True):
        if not joint.upper > joint.lower:
            raise InputError(
                f"the finger {joint.name} does not move: its limits are {joint.lower:g} and "
                f"{joint.upper:g}"
            )
        if axis @ side < 0.0:
            x, y, z = joint.axis
            joint = replace(joint, axis=(-x, -y, -z), lower=-joint.upper, upper=-joint.lower)
        shifted = _moved(joint, joint.lower)
        found.append(replace(shifted, lower=0.0, upper=joint.upper - joint.lower))

    first, second = (joint.origin.rotation @ np.array(joint.axis) for joint in found)
    if first @ second > -0.99 or abs(apart @ first) < 1e-4:
        raise InputError(
            f"the fingers {names} do not move towards each other: the gripper cannot close",
            remedy="Name two prismatic joints, or leave --gripper out for one of ours",
        )
    return found[0], found[1]


def _moved(joint: Joint, value: float) -> Joint:
    """Return a joint whose origin is where it is at a value."""
    x, y, z = (value * entry for entry in joint.axis)
    return replace(joint, origin=joint.origin @ Pose((x, y, z)))


def _corners(joint: Joint, hulls: Hulls) -> Array:
    return np.concatenate([joint.origin.apply(hull.vertices) for hull in hulls])


def _tool(meeting: float, closing: Array, fingers: Array, origins: Array, hand: Hulls) -> Pose:
    """Place the tool: y the closing direction, z out of the hand along one of its axes, the origin
    where the pads meet.
    """
    palm = np.concatenate([hull.vertices for hull in hand]).mean(axis=0) if hand else np.zeros(3)
    out = fingers.mean(axis=0) - palm
    out -= (out @ closing) * closing
    along = int(np.argmax(np.abs(out)))
    out = np.eye(3)[along] * np.sign(out[along])
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2] = np.cross(closing, out), closing, out
    across = T[:3, 0]
    width = fingers @ across
    middle, drawn = float(width.min() + width.max()) / 2, float(origins @ across)
    T[:3, 3] = (
        across * (drawn if abs(middle - drawn) < CENTRED else middle)
        + closing * meeting
        + out * (float((fingers @ out).max()) - TIP)
    )
    return Pose.from_matrix(_orthogonal(T))


def _orthogonal(T: Array) -> Array:
    u, _, v = np.linalg.svd(T[:3, :3])
    fixed = T.copy()
    fixed[:3, :3] = u @ v
    return fixed
