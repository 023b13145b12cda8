"""Base placement and inverse kinematics: a base pose and the arm's last stretch to a grasp."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.approach import LIFT_DISTANCE_M, RETREAT_DISTANCE_M
from tamp.geometric.streams.departure import lift_hits
from tamp.geometric.streams.reachable_height import too_high
from tamp.geometric.values import BaseConf, Grasp, Reach
from tamp.stream import Call, Rejection, RejectionKind

if TYPE_CHECKING:
    from jaxtyping import Float

TOOL_STEP_M = 0.01
"""Spacing of the tool poses along the last stretch, metres,"""

FINE_TOOL_STEP_M = 0.0025
"""and near singularities, where the joints move fast."""

MAX_JOINT_TURN_RAD = 0.1
"""The most that a joint may turn from one to the next, radians: in between, the tool strays by less
than 1.5 mm."""

BASE_POSES_PER_TRY = 16
"""Base poses looked at in one try: most stand in some furniture, which is found out quickly."""

BASE_RETREAT_M = 0.5
"""A base pose is worth trying when the robot can slide this far away from it, metres,"""

KEEP_ENCLOSED_PROBABILITY = 0.05
"""or, so that no place is ruled out for good, with this probability."""

MAX_FAILED_TRIES = 12
"""Tries without a success after which a grasp there is given up. Poses and grasps are drawn without
end, so that no solution is lost for good, and another of those is the better bet than the
thousandth place for the base."""

MAX_ARM_SOLUTIONS = 24
"""Arm solutions looked at from one base pose,"""

MAX_APPROACHES = 3
"""and those of them from which the approach is tried."""


def inverse_kinematics(
    context: Context, body: str, pose: Pose, grasp: Grasp, call: Call
) -> Iterator[tuple[BaseConf, Reach] | Rejection]:
    """Yield base poses and approaches that are free of the fixed bodies, with the hand empty and
    with the body in it.

    The approach is a straight line along the tool's axis; with the body in hand it is lifted
    straight up first, so that it does not scrape along its support. Ends after MAX_FAILED_TRIES
    without any success.
    """
    T_world_tool = pose.matrix @ grasp.T_tool_body.inverse().matrix
    failures = 0.0
    while failures < MAX_FAILED_TRIES:
        reason: Rejection | None = None
        for base in context.stands(T_world_tool, call.rng, BASE_POSES_PER_TRY):
            refused = _base_conf_collides(context, body, grasp, base, call)
            if refused is not None:
                reason = reason or refused
                continue

            found = _reaching(context, pose, grasp, base, T_world_tool, call)
            if not isinstance(found, Rejection):
                failures = -math.inf
                yield found
                reason = None
                break
            reason = found

        if reason is not None:
            if reason.kind is RejectionKind.UNREACHABLE:
                high = too_high(context, T_world_tool[:3, 3])
                reason = reason if high is None else replace(reason, reason=high)
            failures += 1
            yield reason if failures < MAX_FAILED_TRIES else replace(reason, given_up=True)


def inverse_kinematics_here(
    context: Context, body: str, pose: Pose, grasp: Grasp, base: BaseConf, call: Call
) -> Iterator[Reach | Rejection]:
    """Yield approaches as `inverse_kinematics` does, from a base pose that is given."""
    T_world_tool = pose.matrix @ grasp.T_tool_body.inverse().matrix
    stand = np.array(base.array)
    failures = 0.0
    while failures < MAX_FAILED_TRIES:
        refused = _base_conf_collides(context, body, grasp, stand, call)
        found = refused or _reaching(context, pose, grasp, stand, T_world_tool, call)
        if not isinstance(found, Rejection):
            failures = -math.inf
            yield found[1]
            continue
        failures += 1
        yield found if failures < MAX_FAILED_TRIES else replace(found, given_up=True)


def _base_conf_collides(
    context: Context, body: str, grasp: Grasp, base: Array, call: Call
) -> Rejection | None:
    """Say why the robot cannot stand there with the arm at home, with the body or without; cheap,
    and often the answer.
    """
    room = context.scene.room
    if not (room.x[0] <= base[0] <= room.x[1] and room.y[0] <= base[1] <= room.y[1]):
        return Rejection("base outside of the room", kind=RejectionKind.NO_STANCE)
    home = context.conf(base, context.home)
    for held, who in ((None, "base"), (grasp, f"{body} carried here")):
        among = context.fixed_only(held)
        if not among.free(home):
            return _collision(among.hits(home, NAMING_PADDING_M), who)
    fixed = context.robot.drive == "fixed"
    if (
        not fixed
        and not _can_retreat(context, grasp, base, home)
        and call.rng.random() >= KEEP_ENCLOSED_PROBABILITY
    ):
        return Rejection("base stands in a nook", kind=RejectionKind.NO_STANCE)
    return None


def _can_retreat(context: Context, grasp: Grasp, base: Array, home: Array) -> bool:
    """Check whether the robot can slide out of this place, backwards or to a side, with the body in
    hand.
    """
    loaded = context.fixed_only(grasp)
    for angle in (math.pi, 0.75 * math.pi, -0.75 * math.pi, 0.5 * math.pi, -0.5 * math.pi):
        heading = base[2] + angle
        away = home.copy()
        away[:2] += BASE_RETREAT_M * np.array([math.cos(heading), math.sin(heading)])
        if loaded.edge_free(home, away):
            return True
    return False


def _reaching(
    context: Context, pose: Pose, grasp: Grasp, base: Array, T_world_tool: Array, call: Call
) -> tuple[BaseConf, Reach] | Rejection:
    empty = context.fixed_only(None)
    T_base_tool = (
        np.linalg.inv(Pose.from_xyz_yaw(base[0], base[1], 0.0, base[2]).matrix) @ T_world_tool
    )
    solutions = context.ik.solve(T_base_tool)
    if len(solutions) == 0:
        return Rejection("out of reach", kind=RejectionKind.UNREACHABLE)

    # Nearest to home first: the arm's detours are shorter; a few random ones keep every branch
    # possible.
    order = np.argsort(
        np.abs(solutions - context.home).max(axis=1) + call.rng.uniform(0.0, 0.5, len(solutions))
    )
    reason = Rejection("no straight approach", kind=RejectionKind.UNREACHABLE)
    confs = [context.conf(base, q) for q in solutions[order[:MAX_ARM_SOLUTIONS]]]
    # One that keeps its distance is the better bet; close to a wall only the exact test can tell.
    clear = [conf for conf in confs if empty.free(conf)] or confs
    for conf in clear[:MAX_APPROACHES]:
        found = reach_from(context, pose, grasp, base, T_base_tool, conf[3:])
        if isinstance(found, Reach):
            return BaseConf(float(base[0]), float(base[1]), float(base[2])), found
        reason = found or reason

    return reason


def reach_from(
    context: Context, pose: Pose, grasp: Grasp, base: Float[Array, " 3"],
    T_base_tool: Float[Array, "4 4"], q: Float[Array, " joints"],
) -> Reach | Rejection | None:  # fmt: skip
    """Return the last stretch to a grasp at one of the arm's solutions, free of the fixed bodies,
    with the hand empty and with the body in it; None where there is no straight one.

    Args:
        context: The problem's tools.
        pose: T_world_body.
        grasp: How the hand holds it there.
        base: x, y, yaw.
        T_base_tool: Of the tool at the grasp.
        q: The arm's configuration there.
    """
    empty, loaded = context.fixed_only(None), context.fixed_only(grasp)
    hit = empty.hits(context.conf(base, q))
    if hit is not None:
        return _collision(hit)

    up = Pose.from_xyz_yaw(0.0, 0.0, 0.0, -base[2]).rotation @ context.touching.way_out(
        grasp.body, pose, LIFT_DISTANCE_M
    )
    reach = _approach(context, T_base_tool, q, up)
    if reach is None:
        return None

    approach, lift = (
        np.array([context.conf(base, q) for q in path]) for path in (reach.approach, reach.lift)
    )
    hit = (
        empty.path_hits(approach)
        or lift_hits(context, pose, grasp, lift)
        or empty.path_hits(np.array([approach[0], lift[-1]]))
    )
    if hit is not None:
        return _collision(hit)

    if not (loaded.free(lift[-1]) and empty.free(lift[-1])):
        return Rejection("no room before the approach", kind=RejectionKind.COLLISION)
    return reach


def _approach(context: Context, T_base_tool: Array, q: Array, lift: Array) -> Reach | None:
    """Compute the straight lines away from the grasp: back along the tool's axis; and by `lift`
    (3,), then back.
    """
    back = T_base_tool[:3, 2]
    away = follow_line(context, T_base_tool, -RETREAT_DISTANCE_M * back, q)
    if away is None:
        return None
    up = follow_line(context, T_base_tool, lift, q)
    if up is None:
        return None
    lifted = T_base_tool.copy()
    lifted[:3, 3] += lift
    out = follow_line(context, lifted, -RETREAT_DISTANCE_M * back, up[-1])
    if out is None:
        return None
    return Reach(away[::-1].copy(), np.concatenate([up, out[1:]]))


def follow_line(
    context: Context,
    T_base_tool: Float[Array, "4 4"],
    offset: Float[Array, " 3"],
    q: Float[Array, " joints"],
) -> Float[Array, "k joints"] | None:
    """Compute arm configurations (k, 7) that move the tool straight by `offset` (3,) metres in the
    base frame, from q.
    """
    length = float(np.linalg.norm(offset))
    for step in (TOOL_STEP_M, FINE_TOOL_STEP_M):
        count = max(1, math.ceil(length / step))
        targets = np.repeat(T_base_tool[None], count, axis=0)
        targets[:, :3, 3] += np.linspace(1 / count, 1.0, count)[:, None] * offset
        path = context.ik.follow(list(targets), q, MAX_JOINT_TURN_RAD)
        if path is not None:
            return np.concatenate([q[None], path])
    return None


NAMING_PADDING_M = 0.002
"""The padding of `free`, metres, with which its verdict is named."""


def _collision(pair: tuple[str, str] | None, who: str = "") -> Rejection:
    """Say what the exact test found to be hit; it may find nothing where a bound decided."""
    if pair is None:
        return replace(Rejection.hits("something", who=who), bodies=())
    return Rejection.hits(pair[1], who=who)
