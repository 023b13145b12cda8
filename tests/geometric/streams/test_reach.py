"""The cheap test of reach is never wrong when it says no: all that the arm gets to is reachable."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams.reach import test_reachable
from tests.geometric.streams.scenes import call, problem_with

test_reachable.__test__ = False  # type: ignore[attr-defined]  # a stream, not a test of ours


def test_reachable_keeps_all_that_the_arm_touches(tmp_path: Path, rng: np.random.Generator) -> None:
    context = problem_with("can", tmp_path).context
    lower, upper = np.array(context.robot.lower), np.array(context.robot.upper)
    room = context.scene.room
    for _ in range(300):
        base = [rng.uniform(*room.x), rng.uniform(*room.y), rng.uniform(-3, 3)]
        tool = context.kinematics.tool(context.conf(np.array(base), rng.uniform(lower, upper)))
        pose = Pose.from_matrix(tool)  # a can in the hand, its middle between the fingers
        assert test_reachable(context, "can", pose, call()) is True


def test_what_is_out_of_the_room_is_out_of_reach(tmp_path: Path) -> None:
    context = problem_with("can", tmp_path).context
    for position in ((5.0, 0.0, 0.8), (0.0, 0.0, 2.5), (-3.0, -4.0, 0.5)):
        assert test_reachable(context, "can", Pose(position), call()) is not True
