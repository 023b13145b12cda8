"""Tests of movable bodies against each other and against the arm's last stretch; the fixed ones
were tested before.
"""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M
from tamp.geometric.collision.swept_boxes import SweptBoxes, swept_by_robot
from tamp.geometric.context import Context
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.departure import lift_hits
from tamp.geometric.streams.reach import arm_length
from tamp.geometric.values import BaseConf, Grasp, Reach
from tamp.stream import Call, Rejection

NEIGHBOUR_CLEARANCE_M = 0.003
"""Metres of air that a placed body keeps to other movable ones."""

REACH_CLEARANCE_M = 0.0005
"""Metres of air that the robot and what it holds keep to them while it reaches."""


def near(context: Context, body: str, pose: Pose, other: str, other_pose: Pose) -> bool:
    """Check whether two movable bodies are nearer than NEIGHBOUR_CLEARANCE_M, but for one that
    rests on the other: it is no nearer than CONTACT_GAP, and only because it is above.
    """
    pair = context.collisions.pair
    if not pair(body, pose, other, other_pose, NEIGHBOUR_CLEARANCE_M):
        return False
    if pair(body, pose, other, other_pose, REACH_CLEARANCE_M):
        return True
    up, down = (Pose((0.0, 0.0, z)) @ pose for z in (NEIGHBOUR_CLEARANCE_M, -NEIGHBOUR_CLEARANCE_M))
    return pair(body, up, other, other_pose, NEIGHBOUR_CLEARANCE_M) and pair(
        body, down, other, other_pose, NEIGHBOUR_CLEARANCE_M
    )


def test_pose_clear(
    context: Context, body: str, pose: Pose, other: str, other_pose: Pose, call: Call
) -> bool | Rejection:
    """Test whether two movable bodies at these poses are apart."""
    if body == other or not near(context, body, pose, other, other_pose):
        return True
    return Rejection.hits(other, blockers=(other,))


def test_reach_clear(
    context: Context,
    body: str,
    pose: Pose,
    grasp: Grasp,
    base: BaseConf,
    reach: Reach,
    other: str,
    other_pose: Pose,
    call: Call,
) -> bool | Rejection:
    """Test whether the robot keeps clear of another body while it stands there and reaches, with
    the hand empty or full.
    """
    if body == other:
        return True
    if _out_of_the_way(context, body, base, other, other_pose):
        return True
    if not _swept(context, grasp, base, reach).meet(
        *context.box(other, other_pose), TRANSIT_CLEARANCE_M
    ):
        return True

    home = context.conf(base.array, context.home)
    place = {other: other_pose}
    empty = context.collisions.arrangement(place, None, fixed=False)
    loaded = context.collisions.arrangement(place, context.attachment(grasp), fixed=False)
    approach, lift = _paths(base, reach)
    if not (empty.free(home) and loaded.free(home)):
        return Rejection.hits(other, who="base", blockers=(other,))

    out = lift[-1]
    aside = np.array([approach[0], out])
    if (
        empty.path_hits(approach, padding=REACH_CLEARANCE_M)
        or lift_hits(context, pose, grasp, lift, place, REACH_CLEARANCE_M)
        or empty.path_hits(aside, padding=REACH_CLEARANCE_M)
    ):
        return Rejection.hits(other, blockers=(other,))

    if not (empty.free(out) and loaded.free(out)):
        return Rejection.hits(other, blockers=(other,))
    return True


def _paths(base: BaseConf, reach: Reach) -> tuple[Array, Array]:
    """Return approach and lift as configurations (k, 3 + n), (m, 3 + n)."""
    approach, lift = (
        np.hstack([np.broadcast_to(base.array, (len(path), 3)), path])
        for path in (reach.approach, reach.lift)
    )
    return approach, lift


def _swept(context: Context, grasp: Grasp, base: BaseConf, reach: Reach) -> SweptBoxes:
    """Box the robot while it stands there at home and reaches, in the broad phase: all that
    `test_reach_clear` looks at.
    """
    key = grasp, base, reach
    boxes = context.swept_by_reach.get(key)
    if boxes is None:
        home = context.conf(base.array, context.home)[None]
        approach, lift = _paths(base, reach)
        aside = np.array([approach[0], lift[-1]])
        empty = context.collisions.arrangement({}, None, fixed=False)
        loaded = context.collisions.arrangement({}, context.attachment(grasp), fixed=False)
        boxes = swept_by_robot([empty, loaded], [home, approach, lift, aside])
        context.swept_by_reach[key] = boxes
    return boxes


def _out_of_the_way(
    context: Context, body: str, base: BaseConf, other: str, other_pose: Pose
) -> bool:
    """Check whether the other body is farther from the base than the arm, stretched out with the
    body in hand, can be.
    """
    arm = context.robot.T_base_arm.position
    stretched = math.hypot(arm[0], arm[1]) + arm_length(context.robot) + 2 * context.radius(body)
    distance = math.hypot(other_pose.position[0] - base.x, other_pose.position[1] - base.y)
    return distance > stretched + context.radius(other)
