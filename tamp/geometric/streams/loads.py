"""Loads: what stands on a body that is carried goes with it, which must stay level on the way."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.context import Context
from tamp.geometric.motion.arm import plan_arm
from tamp.geometric.motion.result import Failure
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.collisions import REACH_CLEARANCE_M, test_reach_clear
from tamp.geometric.streams.departure import lift_hits
from tamp.geometric.values import BaseConf, Grasp, Grip, Load, Motion, Path, Reach
from tamp.stream import Call, Rejection, RejectionKind

if TYPE_CHECKING:
    from jaxtyping import Float

LOADED_TILT_RAD = math.radians(10.0)
"""Radians by which a body may lean while others stand on it: a third of what their friction would
bear."""

LEVEL_TILT_RAD = math.radians(1.0)
"""Radians by which it may lean while the base drives, and when it is lifted."""

LOOK_STEP_RAD = 0.04
"""Radians of a joint between two looks at the tilt, at most."""

MAX_LEVEL_EFFORT = 2
"""The greatest effort of a level motion; another grasp or base is the better bet soon."""


def load_of(call: Call, body: str | None) -> Load:
    """Return what rides on a body, by the fluents (riding ?o ?p ?below ?pb)."""
    return tuple(
        (values[0], values[3].inverse() @ values[1])
        for name, *values in call.fluents
        if name == "riding" and values[2] == body
    )


def body_poses(call: Call) -> dict[str, Pose]:
    """Return where bodies stand by the fluents, those as well that ride on a body that stands."""
    poses = {values[0]: values[1] for name, *values in call.fluents if name == "at-pose"}
    carriers = {values[2] for name, *values in call.fluents if name == "riding"}
    for below in sorted(carriers & poses.keys()):
        poses |= {rider: poses[below] @ T for rider, T in load_of(call, below)}
    return poses


@dataclass(frozen=True)
class LevelChecker:
    """A checker of motions in which the body in the hand also stays level.

    Attributes:
        context: Of the problem.
        arrangement: The robot with body and load among the others.
        grasp: How the hand holds the body, which is upright when it is level.
        up: Up in the body's frame while it stands, shape (3,).
    """

    context: Context
    arrangement: Arrangement
    grasp: Grasp
    up: Array

    def free(self, conf: Float[Array, " conf"]) -> bool:
        """Check whether nothing touches at `conf`, and the body is level."""
        return self.tilt(conf) <= LOADED_TILT_RAD and self.arrangement.free(conf)

    def edge_free(self, start: Float[Array, " conf"], end: Float[Array, " conf"]) -> bool:
        """Check whether nothing touches on the straight line, and the body stays level."""
        count = max(1, math.ceil(float(np.abs(end - start)[3:].max()) / LOOK_STEP_RAD))
        shares = np.linspace(0.0, 1.0, count + 1)
        if any(self.tilt(start + share * (end - start)) > LOADED_TILT_RAD for share in shares):
            return False
        return self.arrangement.edge_free(start, end)

    def tilt(self, conf: Float[Array, " conf"]) -> float:
        """Measure how far the body leans, radians."""
        turned = self.context.kinematics.tool(conf)[2, :3] @ self.grasp.T_tool_body.rotation
        return math.acos(min(1.0, float(turned @ self.up)))


def plan_loaded_pick(
    context: Context, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach, load: Load, call: Call
) -> Iterator[Motion | Rejection]:
    """Plan a pick of a body with what stands on it: level, from home to it and back."""
    body, whole = grasp.body, context.loaded(grasp.body, load)
    carried_along = {body, *(name for name, _ in load)}
    others = {name: other for name, other in body_poses(call).items() if name not in carried_along}
    refused = _refused(context, whole, pose, grasp, base, reach, load, others, call)
    if refused is not None:
        yield refused
        return

    stand, out = np.array(base.array), reach.lift[-1]
    carried = whole.collisions.arrangement(others, whole.attachment(grasp))
    level = LevelChecker(context, carried, grasp, pose.rotation[2])
    among = whole.collisions.arrangement({**others, body: pose})
    for effort in range(MAX_LEVEL_EFFORT + 1):
        planned = plan_arm(
            level, stand, context.home, out, context.robot, call.rng, call.deadline, effort=effort
        )
        if planned.path is None:
            failed = planned.failure or Failure.EXHAUSTED
            what = f"no level way with {' and '.join(name for name, _ in load)}: {failed.value}"
            yield Rejection(what, kind=RejectionKind.NO_MOTION)
            if failed in (Failure.START, Failure.GOAL, Failure.LIMITS):
                return
            continue

        empty = planned.path
        confs = [context.conf(stand, arm) for arm in empty]
        if not all(among.edge_free(a, b) for a, b in pairwise(confs)):
            free = plan_arm(
                among, stand, context.home, out, context.robot, call.rng, call.deadline,
                planner=context.planner,
            )  # fmt: skip
            if free.path is None:
                yield Rejection("no motion found", kind=RejectionKind.NO_MOTION)
                continue
            empty = free.path
        opened, back = context.robot.opening, planned.path[::-1][1:]
        yield Motion(
            (
                Path("arm", np.concatenate([empty, reach.approach]), opened),
                Grip((opened, grasp.opening), attach=grasp, load=load),
                Path("arm", np.concatenate([reach.lift, back]), grasp.opening, body),
            )
        )


def _refused(
    context: Context, whole: Context, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach,
    load: Load, others: Mapping[str, Pose], call: Call,
) -> Rejection | None:  # fmt: skip
    """Say why a body cannot be lifted there with its load: tilted at home, or something is hit on
    the last stretch.
    """
    up = grasp.T_tool_body.rotation @ pose.rotation[2]
    tilt = math.acos(min(1.0, float(up @ context.carrying_up)))
    if tilt > LEVEL_TILT_RAD:
        what = f"{grasp.body} would lean by {math.degrees(tilt):.0f} degrees at home"
        return Rejection(what, given_up=True, kind=RejectionKind.UNSTABLE)

    approach = np.array([context.conf(base.array, arm) for arm in reach.approach])
    lift = np.array([context.conf(base.array, arm) for arm in reach.lift])
    riders = {name: pose @ T_body_rider for name, T_body_rider in load}
    empty = context.collisions.arrangement(riders, None, fixed=False)
    hit = empty.path_hits(approach, padding=REACH_CLEARANCE_M) or lift_hits(
        whole, pose, grasp, lift
    )
    if hit is not None:
        return Rejection.hits(hit[1])
    for other, other_pose in others.items():
        clear = test_reach_clear(
            whole, grasp.body, pose, grasp, base, reach, other, other_pose, call
        )
        if isinstance(clear, Rejection):
            return clear
    return None
