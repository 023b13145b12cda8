"""A whole plan's motions hang together: no jumps, not even of a whole turn, and free in the state they are made for."""

from __future__ import annotations

import numpy as np
import pytest

import tamp
from tamp.geometric.scene.pose import Pose


@pytest.mark.parametrize("seed", [0, 1])
def test_segments_follow_each_other_and_are_free(seed: int) -> None:
    problem = tamp.load_problem("two_objects")
    context, scene = problem.context, problem.scene
    solution = tamp.solve(problem, max_time=30.0, seed=seed)
    assert solution.solved
    conf = context.conf(scene.robot.base, context.home)
    poses = {name: scene.bodies[name].pose for name in scene.movable}
    held = None
    edges = 0
    for action in solution.plan:
        if action.name in ("pick", "place"):
            assert np.allclose(conf[3:], context.home)  # carried at home
        for segment in action.trajectory.segments:
            if segment.part == "gripper":
                if segment.attach is not None:
                    held = segment.attach
                    tool = Pose.from_matrix(context.kinematics.tool(conf))
                    grasped = (tool @ held.T_tool_body).matrix
                    assert np.abs(grasped - poses.pop(held.body).matrix).max() < 1e-4
                elif held is not None:
                    poses[held.body] = (
                        Pose.from_matrix(context.kinematics.tool(conf)) @ held.T_tool_body
                    )
                    held = None
                continue
            joints = slice(0, 3) if segment.part == "base" else slice(3, 10)
            assert np.abs(segment.positions[0] - conf[joints]).max() < 1e-6
            attachment = None if held is None else context.attachment(held)
            among = context.collisions.arrangement(poses, attachment)
            for row in segment.positions[1:]:
                after = conf.copy()
                after[joints] = row
                assert among.path_hits(np.array([conf, after]), 0.005) is None
                conf = after
                edges += 1
    assert edges > 50
    assert np.allclose(conf[3:], context.home)
