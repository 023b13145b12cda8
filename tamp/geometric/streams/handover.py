"""Handovers: a body goes from the hand of one arm into that of another, in the air."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import arm_of
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.approach import RETREAT_DISTANCE_M
from tamp.geometric.streams.by_arms import carried
from tamp.geometric.streams.inverse_kinematics import reach_from
from tamp.geometric.streams.loads import body_poses
from tamp.geometric.streams.motions import arm_ways
from tamp.geometric.streams.reach import arm_length
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Path, Reach, Stance
from tamp.stream import Call, Rejection, RejectionKind

if TYPE_CHECKING:
    from jaxtyping import Float

NEAREST_SHARE, FARTHEST_SHARE = 0.25, 0.8
"""Shares of the arms' length from their shoulders between which bodies are handed over."""

POSES_PER_TRY = 100
"""Poses of the body that are looked at in one try."""

MAX_FAILED_TRIES = 8
"""Tries without a success after which two grasps are given up."""

ARM_SOLUTIONS = 4
"""Configurations of each arm that are looked at for one pose."""

LOOK_SHARES = (1.0, 0.75, 0.5, 0.25, 0.0)
"""Where on their way to the body the hands are looked at, shares of the way that remains."""

FINGER_STEP_M = 0.005
"""Metres that a finger moves between two looks: less than its width."""


def sample_handover(
    context: Context, giver: str, body: str, grasp: Grasp, taker: str, other: Grasp,
    base: BaseConf, call: Call,
) -> Iterator[tuple[Pose, Reach, Reach] | Rejection]:  # fmt: skip
    """Yield poses of a body in the air at which both arms hold it, with the last stretch of each.

    The giver's hand and the taker's do not meet there, nor on the taker's way to the body and the
    giver's from it; fixed bodies are clear of both. Ends at once where two grasps exclude each
    other.
    """
    if giver == taker:
        yield Rejection("an arm hands nothing over to itself", kind=RejectionKind.OTHER)
        return
    met = _hands_meet(context, giver, grasp, taker, other)
    if met is not None:
        yield Rejection(met, kind=RejectionKind.COLLISION)
        return

    failures = 0.0
    while failures < MAX_FAILED_TRIES:
        reason = Rejection("no pose within reach of both arms", kind=RejectionKind.UNREACHABLE)
        for pose in _poses(context, giver, taker, base, call.rng, POSES_PER_TRY):
            found = _exchange(context, giver, body, grasp, taker, other, base, pose, call.rng)
            if isinstance(found, Rejection):
                reason = found
            elif found is not None:
                failures = -math.inf
                yield (pose, *found)
        failures += 1
        if failures > 0:
            given_up = failures >= MAX_FAILED_TRIES
            yield Rejection(reason.reason, given_up=given_up, kind=reason.kind)


def _hands_meet(
    context: Context, giver: str, grasp: Grasp, taker: str, other: Grasp
) -> str | None:  # fmt: skip
    """Say when hands meet at a body that both hold, as the one comes and the other goes."""
    one, two = context.of_arm(giver), context.of_arm(taker)
    T_body_giver, T_body_taker = (held.T_tool_body.inverse().matrix for held in (grasp, other))
    for opening in _between(grasp.opening, one.robot.opening):
        if one.hand.meets(opening, T_body_giver, two.hand, other.opening, T_body_taker):
            return "the giver's fingers hit the taker's as they open"
    for opening in _between(other.opening, two.robot.opening):
        if two.hand.meets(opening, T_body_taker, one.hand, grasp.opening, T_body_giver):
            return "the taker's fingers hit the giver's as they close"
    for share in LOOK_SHARES:
        coming, going = _back(T_body_taker, share), _back(T_body_giver, share)
        if one.hand.meets(grasp.opening, T_body_giver, two.hand, two.robot.opening, coming):
            return "the taker's hand hits the giver's"
        if one.hand.meets(one.robot.opening, going, two.hand, other.opening, T_body_taker):
            return "the giver's hand hits the taker's"
    return None


def _between(closed: float, opened: float) -> list[float]:
    """List openings from one to another, metres, so close that no finger passes another unseen."""
    count = max(1, math.ceil((opened - closed) / 2 / FINGER_STEP_M))
    return [closed + (opened - closed) * k / count for k in range(count + 1)]


def _back(T_body_tool: Array, share: float) -> Array:
    moved = T_body_tool.copy()
    moved[:3, 3] -= share * RETREAT_DISTANCE_M * T_body_tool[:3, 2]
    return moved


def _poses(
    context: Context, giver: str, taker: str, base: BaseConf, rng: np.random.Generator, count: int
) -> Iterator[Pose]:
    """Yield random poses T_world_body, of those drawn the ones near enough to both shoulders."""
    arms = [arm_of(context.robot, name) for name in (giver, taker)]
    T_world_base = Pose.from_xyz_yaw(base.x, base.y, 0.0, base.yaw)
    shoulders = [T_world_base.apply(_shoulder(arm)[None])[0] for arm in arms]
    lengths = [arm_length(arm) for arm in arms]
    middle = (shoulders[0] + shoulders[1]) / 2
    wide = FARTHEST_SHARE * min(lengths)

    for _ in range(count):
        at = middle + rng.uniform(-wide, wide, 3)
        turn = rng.normal(size=4)
        x, y, z, w = (turn / np.linalg.norm(turn)).tolist()
        shares = [
            float(np.linalg.norm(at - shoulder)) / length
            for shoulder, length in zip(shoulders, lengths, strict=True)
        ]
        if min(shares) >= NEAREST_SHARE and max(shares) <= FARTHEST_SHARE:
            yield Pose((float(at[0]), float(at[1]), float(at[2])), (x, y, z, w))


def _shoulder(arm: Robot) -> Float[Array, " 3"]:
    return np.array((arm.T_base_arm @ arm.joints[0].origin).position)


def _exchange(
    context: Context, giver: str, body: str, grasp: Grasp, taker: str, other: Grasp,
    base: BaseConf, pose: Pose, rng: np.random.Generator,
) -> tuple[Reach, Reach] | Rejection | None:  # fmt: skip
    """Return the last stretches of both arms to a body at a pose; None where an arm does not get
    there, which is the rule.
    """
    one, two = context.of_arm(giver), context.of_arm(taker)
    T_base_body = (
        np.linalg.inv(Pose.from_xyz_yaw(base.x, base.y, 0.0, base.yaw).matrix) @ pose.matrix
    )
    T_first, T_second = (T_base_body @ held.T_tool_body.inverse().matrix for held in (grasp, other))
    if len(one.ik.solve(T_first, 1)) == 0 or len(two.ik.solve(T_second, 1)) == 0:
        return None

    reason, stand = None, np.array(base.array)
    firsts, seconds = one.ik.solve(T_first), two.ik.solve(T_second)
    for q in rng.permutation(firsts)[:ARM_SOLUTIONS]:
        gives = reach_from(one, pose, grasp, stand, T_first, q)
        if not isinstance(gives, Reach):
            reason = gives or reason
            continue
        holding = context.of_arm(taker, {giver: Stance(tuple(q.tolist()), grasp)})
        for q2 in rng.permutation(seconds)[:ARM_SOLUTIONS]:
            takes = reach_from(two, pose, other, stand, T_second, q2)
            if not isinstance(takes, Reach):
                reason = takes or reason
                continue
            held = context.of_arm(giver, {taker: Stance(tuple(q2.tolist()), other)})
            hit = _along(holding, base, takes, other) or _along(held, base, gives, grasp)
            if hit is None:
                return gives, takes
            reason = Rejection.hits(hit[1], who=hit[0])
    return reason


def _along(
    context: Context, base: BaseConf, reach: Reach, grasp: Grasp
) -> tuple[str, str] | None:  # fmt: skip
    """Return what the open hand meets of the other arm and the body on its way to the grasp, or the
    closed one there.
    """
    confs = np.array([context.conf(base.array, q) for q in reach.approach])
    arrangement = context.collisions.arrangement
    opened = arrangement({}, None, fixed=False)
    closed = arrangement({}, None, opening=grasp.opening, fixed=False)
    return opened.path_hits(confs) or closed.hits(confs[-1])


def plan_handover(
    context: Context, giver: str, body: str, grasp: Grasp, taker: str, other: Grasp,
    base: BaseConf, pose: Pose, gives: Reach, takes: Reach, call: Call,
) -> Iterator[Motion | Rejection]:  # fmt: skip
    """Plan a handover: the giver brings the body, the taker comes and grasps it, the giver lets go
    and returns, the taker returns with the body. Others hold still at home.
    """
    rest, others = carried(call, giver, taker), body_poses(call)
    held = {**rest, giver: Stance(tuple(gives.approach[-1].tolist()), grasp)}
    taken = {**rest, taker: Stance(tuple(takes.approach[-1].tolist()), other)}
    ways: list[Array] = []

    for arm, stances, load, stretch in (
        (giver, rest, grasp, gives.lift[::-1]),
        (taker, held, None, takes.approach),
        (giver, taken, None, gives.approach),
        (taker, rest, other, takes.lift[::-1]),
    ):
        here = context.of_arm(arm, stances)
        refused = _blocked(here, others, load, base, stretch)
        if refused is not None:
            yield refused
            return
        for found in arm_ways(here, others, load, base, stretch[0], call):
            if not isinstance(found, Rejection):
                ways.append(np.concatenate([found, stretch]))
                break
            yield found
        else:
            return

    yield _motion(context, body, (giver, grasp), (taker, other), ways)


def _blocked(
    context: Context, others: Mapping[str, Pose], load: Grasp | None, base: BaseConf, stretch: Array
) -> Rejection | None:
    """Say which movable body, or body in a third hand, the last stretch meets."""
    attachment = None if load is None else context.attachment(load)
    confs = np.array([context.conf(base.array, q) for q in stretch])
    hit = context.collisions.arrangement(others, attachment, fixed=False).path_hits(confs)
    if hit is None:
        return None
    blockers = tuple(name for name in hit if name in others)
    return Rejection.hits(hit[1], who=hit[0], blockers=blockers)


def _motion(
    context: Context, body: str, first: tuple[str, Grasp], second: tuple[str, Grasp],
    ways: list[Array],
) -> Motion:  # fmt: skip
    """Put a handover together: of the giver and the taker the arm and the grasp, and the ways from
    home to the body: the giver's with it, the taker's, the giver's without, the taker's with it.
    """
    (giver, grasp), (taker, other) = first, second
    wide = {name: arm_of(context.robot, name).opening for name in (giver, taker)}
    brings, comes, returns, carries = ways
    return Motion(
        (
            Path("arm", brings, grasp.opening, body, giver),
            Path("arm", comes, wide[taker], None, taker),
            Grip((wide[taker], other.opening), attach=other, arm=taker),
            Grip((grasp.opening, wide[giver]), detach=body, arm=giver),
            Path("arm", returns[::-1], wide[giver], None, giver),
            Path("arm", carries[::-1], other.opening, body, taker),
        )
    )
