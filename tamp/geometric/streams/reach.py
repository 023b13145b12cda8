"""Reachability tests: what is out of the arm's reach for certain."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.reachable_height import too_high
from tamp.geometric.streams.too_flat import too_flat
from tamp.stream import Call, Rejection, RejectionKind

if TYPE_CHECKING:
    from jaxtyping import Float

FINGERTIP_MARGIN_M = 0.02
"""How far the fingers reach beyond the tool's origin, metres."""


def test_reachable(context: Context, body: str, pose: Pose, call: Call) -> bool | Rejection:
    """Test whether any base pose in the room could bring any point of the arm to the body, and a
    hand around it.

    False only when the contrary is proven.
    """
    flat = too_flat(context, body, pose)
    if flat is not None:
        return flat
    return within_reach(context, *bounds(context.scene.bodies[body].parts, pose))


def within_reach(
    context: Context, low: Float[Array, " 3"], high: Float[Array, " 3"]
) -> bool | Rejection:
    """Check whether the arm could touch a box with corners `low` and `high` (3,) from some place in
    the room.

    Necessary conditions: the shoulder stays at one height and over the room's rectangle grown by
    its offset, and the base on the part of the floor to which its way is wide enough.
    """
    robot, room = context.robot, context.scene.room
    shoulder, span = _shoulder(robot), arm_length(robot)
    vertical = max(low[2] - shoulder[2], shoulder[2] - high[2], 0.0)
    if vertical > span:
        side = "high" if low[2] > shoulder[2] else "low"
        lowest = np.array((*(low + high)[:2] / 2, low[2]))
        measured = too_high(context, lowest) if side == "high" else None
        most = f"too {side}: at {low[2]:.2f} m, {robot.name} reaches {shoulder[2] + span:.2f} m"
        return _out_of_reach(f"{measured}, not to {low[2]:.2f} m" if measured else most)

    offset = math.hypot(shoulder[0], shoulder[1])
    horizontal = math.hypot(
        max(low[0] - room.x[1] - offset, room.x[0] - offset - high[0], 0.0),
        max(low[1] - room.y[1] - offset, room.y[0] - offset - high[1], 0.0),
    )
    if math.hypot(horizontal, vertical) > span:
        return _out_of_reach(f"{horizontal:.2f} m outside of the room")

    if robot.drive == "fixed":
        return _from_where_it_is(context, low, high, span)
    gap = context.passage.closed(low[:2], high[:2], offset + math.sqrt(span**2 - vertical**2))
    return True if gap is None else _out_of_reach(gap.text, gap.bodies)


def _out_of_reach(how: str, bodies: tuple[str, ...] = ()) -> Rejection:
    return Rejection(f"out of reach ({how})", kind=RejectionKind.UNREACHABLE, bodies=bodies)


def _from_where_it_is(context: Context, low: Array, high: Array, span: float) -> bool | Rejection:
    """Check whether the arm of a robot that does not drive could touch a box from where it is."""
    x, y, yaw = context.scene.robot.base
    shoulder = Pose.from_xyz_yaw(x, y, 0.0, yaw).apply(_shoulder(context.robot)[None])[0]
    beyond = np.maximum(np.maximum(low - shoulder, shoulder - high), 0.0)
    distance = float(np.linalg.norm(beyond))
    if distance <= span:
        return True
    return _out_of_reach(
        f"{distance:.2f} m from the arm, which reaches {span:.2f} m and does not drive"
    )


def arm_length(robot: Robot) -> float:
    """Bound the length from the first joint to the finger tips of the arm stretched out, metres,
    from above; joints that slide are thought to be far out.
    """
    pieces = [joint.origin for joint in robot.joints[1:]] + [robot.T_flange_hand, robot.T_hand_tool]
    slides = sum(
        max(abs(low), abs(high))
        for low, high, slides in zip(robot.lower, robot.upper, robot.prismatic, strict=True)
        if slides
    )
    return sum(math.hypot(*piece.position) for piece in pieces) + slides + FINGERTIP_MARGIN_M


def _shoulder(robot: Robot) -> Array:
    """Return the position of the first joint in the base's frame, (3,): it stays where it is."""
    return np.array((robot.T_base_arm @ robot.joints[0].origin).position)
