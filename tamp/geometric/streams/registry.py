"""The registry of streams: which function serves which."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from tamp.geometric.streams.approach import test_approach, test_approach_clear
from tamp.geometric.streams.by_arms import (
    by_arm,
    plan_base_motion_by,
    plan_pick_by,
    plan_place_by,
)
from tamp.geometric.streams.collisions import test_pose_clear, test_reach_clear
from tamp.geometric.streams.handover import plan_handover, sample_handover
from tamp.geometric.streams.inverse_kinematics import inverse_kinematics, inverse_kinematics_here
from tamp.geometric.streams.motions import plan_base_motion, plan_pick, plan_place
from tamp.geometric.streams.movable_supports import (
    sample_inside_movable,
    sample_on_movable,
    shift,
)
from tamp.geometric.streams.reach import test_reachable
from tamp.geometric.streams.sampling import sample_grasp, sample_inside, sample_on
from tamp.stream import StreamKind


@dataclass(frozen=True)
class ShippedStream:
    """A function f(context, *inputs, call), and the kind of stream that it serves."""

    function: Callable[..., Any]
    kind: StreamKind


STREAMS: Mapping[str, ShippedStream] = {
    "sample-grasp": ShippedStream(sample_grasp, StreamKind.GRASPS),
    "sample-on": ShippedStream(sample_on, StreamKind.PLACEMENTS),
    "sample-inside": ShippedStream(sample_inside, StreamKind.PLACEMENTS),
    "sample-on-movable": ShippedStream(sample_on_movable, StreamKind.PLACEMENTS),
    "sample-inside-movable": ShippedStream(sample_inside_movable, StreamKind.PLACEMENTS),
    "shift-on": ShippedStream(shift, StreamKind.OTHER),
    "shift-inside": ShippedStream(shift, StreamKind.OTHER),
    "inverse-kinematics": ShippedStream(inverse_kinematics, StreamKind.IK),
    "inverse-kinematics-here": ShippedStream(inverse_kinematics_here, StreamKind.IK),
    "test-reachable": ShippedStream(test_reachable, StreamKind.TESTS),
    "test-pose-clear": ShippedStream(test_pose_clear, StreamKind.TESTS),
    "test-approach": ShippedStream(test_approach, StreamKind.TESTS),
    "test-approach-clear": ShippedStream(test_approach_clear, StreamKind.TESTS),
    "test-reach-clear": ShippedStream(test_reach_clear, StreamKind.TESTS),
    "plan-base-motion": ShippedStream(plan_base_motion, StreamKind.MOTION),
    "plan-pick": ShippedStream(plan_pick, StreamKind.MOTION),
    "plan-place": ShippedStream(plan_place, StreamKind.MOTION),
    "sample-grasp-by": ShippedStream(by_arm(sample_grasp), StreamKind.GRASPS),
    "inverse-kinematics-by": ShippedStream(by_arm(inverse_kinematics_here), StreamKind.IK),
    "base-placement-by": ShippedStream(by_arm(inverse_kinematics), StreamKind.IK),
    "plan-base-motion-by": ShippedStream(plan_base_motion_by, StreamKind.MOTION),
    "test-reachable-by": ShippedStream(by_arm(test_reachable), StreamKind.TESTS),
    "test-approach-by": ShippedStream(by_arm(test_approach), StreamKind.TESTS),
    "test-approach-clear-by": ShippedStream(by_arm(test_approach_clear), StreamKind.TESTS),
    "test-reach-clear-by": ShippedStream(by_arm(test_reach_clear), StreamKind.TESTS),
    "plan-pick-by": ShippedStream(plan_pick_by, StreamKind.MOTION),
    "plan-place-by": ShippedStream(plan_place_by, StreamKind.MOTION),
    "sample-handover": ShippedStream(sample_handover, StreamKind.IK),
    "plan-handover": ShippedStream(plan_handover, StreamKind.MOTION),
}
"""By the stream's name."""
