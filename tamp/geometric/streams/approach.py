"""Tests of the tool's straight way to a grasp: whether the hand fits there, before anything is said
of arm or base.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.swept_boxes import SweptBoxes
from tamp.geometric.collision.touching import TOUCHING_GAP_M
from tamp.geometric.context import Context
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.values import Grasp
from tamp.stream import Call, Rejection

if TYPE_CHECKING:
    from jaxtyping import Float

LIFT_DISTANCE_M = 0.02
"""How far a held body is lifted straight up before it is drawn back, metres."""

RETREAT_DISTANCE_M = 0.10
"""How far the tool draws back along its own axis, metres."""

FLAT_BODY_HEIGHT_M = 0.02
"""Height of a body, metres, below which the fingers may not get deep enough beside it, nor under
it."""

APPROACH_SHARES = (0.0, 0.5, 1.0)
"""Where on the way the hand is looked at."""

DEPARTURE_LOOKS = 9
"""Where on each stretch of the way out a body is looked at that leaves what it touches."""


def test_approach(
    context: Context, body: str, pose: Pose, grasp: Grasp, call: Call
) -> bool | Rejection:
    """Test whether the fixed bodies leave the hand its way to a grasp, wherever the base stands:
    false only when not.
    """
    fixed = [(name, context.scene.bodies[name].pose) for name in context.scene.fixed]
    hit = approach_hits(context, pose, grasp, fixed)
    if hit is None:
        return True
    loaded = (
        f"loaded with {hit}, which is fixed: " if context.scene.bodies[hit].support == body else ""
    )
    return Rejection.hits(hit, who=f"{loaded or _flat(context, body, pose, hit)}hand")


def test_approach_clear(
    context: Context, body: str, pose: Pose, grasp: Grasp, other: str, other_pose: Pose, call: Call
) -> bool | Rejection:
    """Test whether another body leaves the hand its way to a grasp: false only when the hand hits
    it.
    """
    if body == other or not _swept(context, pose, grasp).meet(
        *context.box(other, other_pose), TOUCHING_GAP_M
    ):
        return True
    if approach_hits(context, pose, grasp, [(other, other_pose)]) is None:
        return True
    return Rejection.hits(other, blockers=(other,))


def _swept(context: Context, pose: Pose, grasp: Grasp) -> SweptBoxes:
    """Box the hand and the body in it on their way to a grasp and back, in the broad phase."""
    boxes = context.swept_by_hand.get((pose, grasp))
    if boxes is None:
        way = _way(context, pose, grasp)
        tools = np.array([*way.out, *_drawn_back(way.T_world_tool)])
        openings = context.robot.opening, grasp.opening
        boxes = context.hand.swept(tools, openings, context.attachment(grasp))
        context.swept_by_hand[pose, grasp] = boxes
    return boxes


def _flat(context: Context, body: str, pose: Pose, hit: str) -> str:
    """Name first a body so flat that fingers meet what it lies on before they hold it."""
    low, high = context.box(body, pose)
    tall = float(high[2] - low[2])
    if tall >= FLAT_BODY_HEIGHT_M:
        return ""
    below = context.box(hit, context.scene.bodies[hit].pose)
    carries = (
        (below[0][:2] < high[:2]).all() and (below[1][:2] > low[:2]).all() and below[0][2] < low[2]
    )
    return f"too flat to be grasped ({1000 * tall:.0f} mm tall): " if carries else ""


def approach_hits(
    context: Context, pose: Pose, grasp: Grasp, others: Iterable[tuple[str, Pose]]
) -> str | None:
    """Return the first of other bodies that the hand hits on its way to the grasp, or on its way
    back with the body.
    """
    around = list(others)
    way = _way(context, pose, grasp)
    T_world_tool, up, back, out = way.T_world_tool, way.up, way.back, way.out
    hand, touching = context.hand, context.touching
    hit = open_hand_hits(context, T_world_tool, around)
    if hit is not None:
        return hit

    leaving = {name for name, other in around if touching.together(grasp.body, pose, name, other)}
    if leaving:  # the hand must not touch them, the body in it only while it leaves them
        steps = [
            _moved(T_world_tool, share * up) for share in np.linspace(0.0, 1.0, DEPARTURE_LOOKS)
        ]
        steps += [
            _moved(T_world_tool, up + share * back)
            for share in np.linspace(0.0, 1.0, DEPARTURE_LOOKS)[1:]
        ]
        bodies = [step @ grasp.T_tool_body.matrix for step in steps]
        for name in leaving:
            if not touching.separates(grasp.body, bodies, name):
                return name
        hit = hand.hits(out, grasp.opening, None, [one for one in around if one[0] in leaving])
        around = [one for one in around if one[0] not in leaving]

    return hit or hand.hits(out, grasp.opening, context.attachment(grasp), around)


@dataclass(frozen=True, eq=False)
class _Way:
    """The tool's way from a grasp.

    Attributes:
        T_world_tool: The grasp, (4, 4).
        up, back: How it is lifted off, and drawn back along its axis, (3,) each, metres.
        out: Where the hand with the body in it is looked at, (4, 4) each.
    """

    T_world_tool: Array
    up: Array
    back: Array
    out: list[Array]


def _way(context: Context, pose: Pose, grasp: Grasp) -> _Way:
    T_world_tool = pose.matrix @ grasp.T_tool_body.inverse().matrix
    back = -RETREAT_DISTANCE_M * T_world_tool[:3, 2]
    up = context.touching.way_out(grasp.body, pose, LIFT_DISTANCE_M)
    out = [T_world_tool, *(_moved(T_world_tool, up + share * back) for share in APPROACH_SHARES)]
    return _Way(T_world_tool, up, back, out)


def open_hand_hits(
    context: Context, T_world_tool: Float[Array, "4 4"], others: Iterable[tuple[str, Pose]]
) -> str | None:
    """Return the first of other bodies that the open hand hits on its way to a tool pose (4, 4)."""
    return context.hand.hits(_drawn_back(T_world_tool), context.robot.opening, None, others)


def _drawn_back(T_world_tool: Array) -> list[Array]:
    back = -RETREAT_DISTANCE_M * T_world_tool[:3, 2]
    return [_moved(T_world_tool, share * back) for share in APPROACH_SHARES]


def _moved(matrix: Array, offset: Array) -> Array:
    moved = matrix.copy()
    moved[:3, 3] += offset
    return moved
