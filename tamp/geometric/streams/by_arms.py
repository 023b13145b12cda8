"""Streams of a body with several arms: those of one arm, each told first which one it is about.

Between actions all arms are at home; while one moves, the others hold still, with what they hold.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams.motions import plan_base_motion, plan_pick, plan_place
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Path, Reach, Stance
from tamp.stream import Call, Rejection

CARRIED_CLEARANCE_M = 0.002
"""Metres that an arm which reaches keeps to what others carry."""


def by_arm(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a stream's function for one arm as one that is told the arm first; the others are at
    home, and empty.
    """

    def served(context: Context, arm: str, *inputs: Any, call: Call) -> Any:
        return function(context.of_arm(arm), *inputs, call=call)

    return served


def carried(call: Call, *arms: str) -> dict[str, Stance]:
    """Return how the others than some arms stand, by the fluents (holding ?a ?o ?g): at home."""
    return {
        values[0]: Stance(None, values[2])
        for name, *values in call.fluents
        if name == "holding" and values[0] not in arms
    }


def plan_pick_by(
    context: Context, arm: str, body: str, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach,
    call: Call,
) -> Iterator[Motion | Rejection]:  # fmt: skip
    """Plan a pick by one of the arms, the others at home with what they hold."""
    return _planned(plan_pick, context, arm, body, pose, grasp, base, reach, call)


def plan_place_by(
    context: Context, arm: str, body: str, pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach,
    call: Call,
) -> Iterator[Motion | Rejection]:  # fmt: skip
    """Plan a placement by one of the arms, the others at home with what they hold."""
    return _planned(plan_place, context, arm, body, pose, grasp, base, reach, call)


def plan_base_motion_by(
    context: Context, goal: BaseConf, call: Call
) -> Iterator[Motion | Rejection]:  # fmt: skip
    """Plan a drive of the base, all arms at home with what they hold."""
    held = {values[0]: values[2] for name, *values in call.fluents if name == "holding"}
    arms = [arm.arm for arm in context.robot.arms]
    first = next((name for name in arms if name in held), arms[0])
    own = [("holding", held[first].body, held[first])] if first in held else []
    fluents = (*own, *(fluent for fluent in call.fluents if fluent[0] != "holding"))
    here = context.of_arm(first, carried(call, first))
    for found in plan_base_motion(here, goal, replace(call, fluents=fluents)):
        yield found if isinstance(found, Rejection) else of_arm(found, first)


def _planned(
    plan: Callable[..., Iterator[Motion | Rejection]], context: Context, arm: str, body: str,
    pose: Pose, grasp: Grasp, base: BaseConf, reach: Reach, call: Call,
) -> Iterator[Motion | Rejection]:  # fmt: skip
    """Plan one arm's motion, once its last stretch is clear of what the others hold."""
    here = context.of_arm(arm, carried(call, arm))
    refused = _reach_hits(here, grasp, base, reach)
    if refused is not None:
        yield refused
        return
    for found in plan(here, body, pose, grasp, base, reach, call):
        yield found if isinstance(found, Rejection) else of_arm(found, arm)


def _reach_hits(
    context: Context, grasp: Grasp, base: BaseConf, reach: Reach
) -> Rejection | None:  # fmt: skip
    """Say which body in another arm's hand the last stretch meets; with empty hands it was tested
    before.
    """
    empty = context.collisions.arrangement({}, None, fixed=False)
    loaded = context.collisions.arrangement({}, context.attachment(grasp), fixed=False)
    for among, path in ((empty, reach.approach), (loaded, reach.lift)):
        confs = np.array([context.conf(base.array, q) for q in path])
        hit = among.path_hits(confs, padding=CARRIED_CLEARANCE_M)
        if hit is not None:
            return Rejection.hits(hit[1], who=hit[0])
    return None


def of_arm(motion: Motion, arm: str) -> Motion:
    """Say of a motion which arm makes it."""
    segments: list[Path | Grip] = [replace(segment, arm=arm) for segment in motion.segments]
    return Motion(tuple(segments))
