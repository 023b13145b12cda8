"""The registry of streams: which function serves which."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tamp.geometric.streams.approach import test_approach, test_approach_clear
from tamp.geometric.streams.collisions import test_pose_clear, test_reach_clear
from tamp.geometric.streams.inverse_kinematics import inverse_kinematics, inverse_kinematics_here
from tamp.geometric.streams.motions import plan_base_motion, plan_pick, plan_place
from tamp.geometric.streams.movable_supports import (
    sample_inside_movable,
    sample_on_movable,
    shift,
)
from tamp.geometric.streams.reach import test_reachable
from tamp.geometric.streams.sampling import sample_grasp, sample_inside, sample_on

STREAMS: Mapping[str, Callable[..., Any]] = {
    "sample-grasp": sample_grasp,
    "sample-on": sample_on,
    "sample-inside": sample_inside,
    "sample-on-movable": sample_on_movable,
    "sample-inside-movable": sample_inside_movable,
    "shift-on": shift,
    "shift-inside": shift,
    "inverse-kinematics": inverse_kinematics,
    "inverse-kinematics-here": inverse_kinematics_here,
    "test-reachable": test_reachable,
    "test-pose-clear": test_pose_clear,
    "test-approach": test_approach,
    "test-approach-clear": test_approach_clear,
    "test-reach-clear": test_reach_clear,
    "plan-base-motion": plan_base_motion,
    "plan-pick": plan_pick,
    "plan-place": plan_place,
}
"""Stream name to f(context, *inputs, call)."""
