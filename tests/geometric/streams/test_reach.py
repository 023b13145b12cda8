"""The cheap tests before IK are never wrong when they say no, and what IK yields does what it claims."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams.approach import LIFT_DISTANCE_M, RETREAT_DISTANCE_M, test_approach
from tamp.geometric.streams.inverse_kinematics import inverse_kinematics
from tamp.geometric.streams.reach import test_reachable
from tamp.geometric.streams.sampling import sample_grasp, sample_inside
from tests.geometric.streams.scenes import call, problem_with, values

test_approach.__test__ = False  # type: ignore[attr-defined]  # a stream, not a test of ours
test_reachable.__test__ = False  # type: ignore[attr-defined]


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


@pytest.mark.parametrize("name", ["can", "box"])
def test_inverse_kinematics_yields_straight_certified_reaches(name: str, tmp_path: Path) -> None:
    problem = problem_with(name, tmp_path)
    context = problem.context
    start = context.scene.bodies[name].pose
    poses = [start, *values(sample_inside(context, name, "cupboard_2", call()), 3)]
    checked = 0
    for pose in poses:
        for grasp in values(sample_grasp(context, name, call(1)), 12):
            if test_approach(context, name, pose, grasp, call()) is not True:
                continue
            found = values(inverse_kinematics(context, name, pose, grasp, call(2)), 1, most=6)
            for base, reach in found:
                checked += 1
                conf = [
                    np.array([context.conf(base.array, q) for q in path])
                    for path in (reach.approach, reach.lift)
                ]
                wanted = pose.matrix @ grasp.T_tool_body.inverse().matrix
                for at in (conf[0][-1], conf[1][0]):
                    assert np.abs(context.kinematics.tool(at) - wanted).max() < 1e-5
                back = -wanted[:3, 2]
                up = np.array([0.0, 0.0, LIFT_DISTANCE_M])
                begin = wanted[:3, 3] + RETREAT_DISTANCE_M * back
                assert straight(context, conf[0], begin, wanted[:3, 3]) < 0.002
                rows = next(
                    i
                    for i, c in enumerate(conf[1])
                    if abs(c[3:] - conf[1][0][3:]).max() > 0 and on(context, c, wanted[:3, 3] + up)
                )
                assert (
                    straight(context, conf[1][: rows + 1], wanted[:3, 3], wanted[:3, 3] + up)
                    < 0.002
                )
                assert straight(context, conf[1][rows:], wanted[:3, 3] + up, begin + up) < 0.002
                assert context.fixed_only(None).path_hits(conf[0]) is None
                assert context.fixed_only(grasp).path_hits(conf[1]) is None
    assert checked >= 4


def on(context, conf, point) -> bool:
    return bool(np.linalg.norm(context.kinematics.tool(conf)[:3, 3] - point) < 1e-4)


def straight(context, path, start, end) -> float:
    """How far the tool strays from a line, metres; it is followed between the rows, too."""
    steps = [a + t * (b - a) for a, b in pairwise(path) for t in np.linspace(0, 1, 8)]
    points = np.array([context.kinematics.tool(conf)[:3, 3] for conf in steps])
    direction = (end - start) / np.linalg.norm(end - start)
    offsets = points - start
    return float(np.linalg.norm(offsets - (offsets @ direction)[:, None] * direction, axis=1).max())
