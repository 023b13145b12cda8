"""Motions of whole actions: drive somewhere, pick, place. What they certify holds in the state that
they were shown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.context import Context
from tamp.geometric.motion.arm import plan_arm
from tamp.geometric.motion.base import TURNING_RADIUS_M, plan_base
from tamp.geometric.motion.result import Failure, MotionResult
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.loads import body_poses, load_of, plan_loaded_pick
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Path, Reach
from tamp.stream import Call, Rejection, RejectionKind

if TYPE_CHECKING:
    from jaxtyping import Float

MAX_EFFORT = 4
"""The greatest effort of a motion plan; each level allows four times as many edges as the one
before."""

DIAGNOSIS_EFFORT = 2
"""The effort from which on a base that finds no way is told why: looking for a narrow gap takes
longer than the tries before."""

STRAIGHT_WAY_CONFS = 33
"""Configurations on the straight way that are looked at to say what is in it."""


@dataclass(frozen=True)
class _Query:
    """One motion problem.

    Attributes:
        plan: How to plan it in an arrangement at an effort.
        confs: Its path as configurations (n, 10).
        ends: Start and goal as configurations (10,).
    """

    plan: Callable[[Arrangement, int], MotionResult]
    confs: Callable[[Array], Array]
    ends: tuple[Array, Array]


def plan_base_motion(context: Context, goal: BaseConf, call: Call) -> Iterator[Motion | Rejection]:
    """Plan a drive of the base, the arm at home, perhaps with a body in hand."""
    start = next(value for name, *values in call.fluents for value in values if name == "at-base")
    held = next((values[1] for name, *values in call.fluents if name == "holding"), None)
    poses = body_poses(call)
    if held is not None:
        context = context.loaded(held.body, load_of(call, held.body))
    opening = context.robot.opening if held is None else held.opening

    def plan(arrangement: Arrangement, effort: int) -> MotionResult:
        ends = np.array(start.array), np.array(goal.array)
        return plan_base(
            arrangement, context.home, *ends, context.scene.room, call.rng, call.deadline,
            effort=effort, steering=context.steering, planner=context.planner,
            turning_radius=context.robot.turning_radius or TURNING_RADIUS_M,
        )  # fmt: skip

    stands = context.conf(start.array, context.home), context.conf(goal.array, context.home)
    query = _Query(
        plan, lambda path: np.column_stack([path, np.tile(context.home, (len(path), 1))]), stands
    )
    for planned in _attempts(context, poses, held, query):
        if isinstance(planned, Rejection):
            yield planned
        else:
            yield Motion((Path("base", planned, opening, None if held is None else held.body),))


def plan_pick(
    context: Context, body: str, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach, call: Call
) -> Iterator[Motion | Rejection]:
    """Plan a pick: from home to the body, close the hand, and back home with it."""
    load = load_of(call, body)
    if load:
        yield from plan_loaded_pick(context, pose, grasp, base, reach, load, call)
        return

    opened = context.robot.opening
    for found in _transits(context, body, pose, grasp, base, reach, call):
        if isinstance(found, Rejection):
            yield found
            continue

        empty, loaded = found
        yield Motion(
            (
                Path("arm", np.concatenate([empty, reach.approach]), opened),
                Grip((opened, grasp.opening), attach=grasp),
                Path("arm", np.concatenate([reach.lift, loaded[::-1][1:]]), grasp.opening, body),
            )
        )


def plan_place(
    context: Context, body: str, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach, call: Call
) -> Iterator[Motion | Rejection]:
    """Plan a placement: a pick of the body from there, backwards."""
    for found in plan_pick(context, body, pose, grasp, base, reach, call):
        yield found if isinstance(found, Rejection) else _backwards(found)


def _backwards(motion: Motion) -> Motion:
    """Reverse a motion in time: paths run back, and a hand that closed on a body lets it go."""
    segments: list[Path | Grip] = []
    for segment in reversed(motion.segments):
        if isinstance(segment, Path):
            segments.append(replace(segment, points=segment.points[::-1]))
        else:
            held = None if segment.attach is None else segment.attach.body
            opening = (segment.opening[1], segment.opening[0])
            segments.append(Grip(opening, detach=held, load=segment.load))

    return Motion(tuple(segments))


def _transits(
    context: Context, body: str, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach, call: Call
) -> Iterator[tuple[Array, Array] | Rejection]:
    """Plan arm paths from home to before the approach: with the hand empty and the body in place,
    and with it in hand.

    One path usually serves both, so the loaded one is planned first; it is the harder.
    """
    others = {name: other for name, other in body_poses(call).items() if name != body}
    stand = np.array(base.array)
    query = _from_home(context, stand, reach.lift[-1], call)
    with_body = {**others, body: pose}
    for loaded in _attempts(context, others, grasp, query):
        if isinstance(loaded, Rejection):
            yield loaded
            continue

        among = context.collisions.arrangement(with_body)
        if _free(among, query.confs(loaded)):
            yield loaded, loaded
            continue
        for empty in _attempts(context, with_body, None, query):
            yield empty if isinstance(empty, Rejection) else (empty, loaded)
            break


def arm_ways(
    context: Context, poses: dict[str, Pose], held: Grasp | None, base: BaseConf,
    out: Float[Array, " joints"], call: Call,
) -> Iterator[Float[Array, "n joints"] | Rejection]:  # fmt: skip
    """Yield the arm's ways (n, joints) from home to a configuration (joints,), or why there is
    none, among bodies at poses.
    """
    yield from _attempts(context, poses, held, _from_home(context, np.array(base.array), out, call))


def _from_home(context: Context, stand: Array, out: Array, call: Call) -> _Query:
    """Ask for a way of the arm from home to a configuration (joints,)."""

    def plan(arrangement: Arrangement, effort: int) -> MotionResult:
        return plan_arm(
            arrangement,
            stand,
            context.home,
            out,
            context.robot,
            call.rng,
            call.deadline,
            effort=effort,
            planner=context.planner,
        )

    reached = context.conf(stand, context.home), context.conf(stand, out)
    return _Query(
        plan, lambda path: np.column_stack([np.tile(stand, (len(path), 1)), path]), reached
    )


def _attempts(
    context: Context, poses: dict[str, Pose], held: Grasp | None, query: _Query
) -> Iterator[Array | Rejection]:
    """Yield paths, or why there is none, with growing effort; end when a failure is final."""
    attachment = None if held is None else context.attachment(held)
    arrangement = context.collisions.arrangement(poses, attachment)
    for effort in range(MAX_EFFORT + 1):
        planned = query.plan(arrangement, effort)
        while planned.path is not None:
            yield planned.path
            planned = query.plan(arrangement, effort)
        yield _diagnosed(context, poses, held, query, effort)
        if planned.failure in (Failure.START, Failure.GOAL, Failure.LIMITS):
            return


def _diagnosed(
    context: Context, poses: dict[str, Pose], held: Grasp | None, query: _Query, effort: int
) -> Rejection:
    """Name the movable bodies in the way, which a path among the fixed bodies alone runs into."""
    relaxed = query.plan(context.fixed_only(held), effort)
    if relaxed.path is None:
        failure = relaxed.failure or Failure.EXHAUSTED
        ahead = _straight_ahead(context, held, query)
        where = f" (straight ahead: {' and '.join(ahead)})" if ahead else ""
        ends = [end[:2] for end in query.ends]
        asked = (
            failure is Failure.EXHAUSTED
            and effort >= DIAGNOSIS_EFFORT
            and (ends[0] != ends[1]).any()
        )
        gap = context.passage.narrow(ends[1]) if asked else None
        failed = failure.value if gap is None else gap.text
        what = f"no motion even without the movable bodies: {failed}{where}"
        bodies = dict.fromkeys((*ahead, *(() if gap is None else gap.bodies)))
        return Rejection(what, kind=RejectionKind.NO_MOTION, bodies=tuple(bodies))

    attachment = None if held is None else context.attachment(held)
    confs = query.confs(relaxed.path)
    blockers = tuple(
        name
        for name, pose in poses.items()
        if not _free(context.collisions.arrangement({name: pose}, attachment, fixed=False), confs)
    )
    if not blockers:
        return Rejection("no motion found", kind=RejectionKind.NO_MOTION)

    what = f"way blocked by {' and '.join(blockers)}"
    return Rejection(what, blockers, kind=RejectionKind.BLOCKED)


def _straight_ahead(context: Context, held: Grasp | None, query: _Query) -> list[str]:
    """List the fixed bodies that the straight way runs into."""
    start, goal = query.ends
    arrangement = context.fixed_only(held)
    hits = [
        arrangement.hits(start + share * (goal - start))
        for share in np.linspace(0.0, 1.0, STRAIGHT_WAY_CONFS)
    ]
    return list(dict.fromkeys(hit[1] for hit in hits if hit is not None))


def _free(arrangement: Arrangement, confs: Array) -> bool:
    return all(arrangement.edge_free(a, b) for a, b in pairwise(confs))
