"""A relational model in the planner: it says the face that it means, and the planner lays the body on that one."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.registry import shipped_grounding
from grounding.relational.planner_adapter import PlacingSampler
from grounding.runtime import laid
from tamp.geometric.scene.pose import Pose
from tamp.geometric.stability.placement import Placement, certified_pose, placed_pose
from tamp.geometric.stability.stable_poses import stable_faces_of
from tamp.planner.problem import load_problem

SCENE = load_problem("four_objects").scene


@pytest.mark.parametrize("name", ["transfer", "flow"])
def test_what_a_model_proposes_are_placements_that_rest(name: str) -> None:
    sampler = shipped_grounding("on", name)
    assert isinstance(sampler, PlacingSampler)
    surface = SCENE.surfaces["cupboard_top"]
    proposed = sampler.propose(SCENE, ("mug", "cupboard_top"), 16, np.random.default_rng(0))
    placements = [one for one in proposed if isinstance(one, Placement)]
    assert len(proposed) == 16 and len(placements) >= 14
    faces, T_world_region = stable_faces_of(SCENE.bodies["mug"]), SCENE.world_pose(surface)
    rested = [certified_pose(faces, one, surface, T_world_region) for one in placements]
    assert sum(isinstance(pose, Pose) for pose in rested) >= 12


def test_a_pose_far_from_the_region_stays_a_pose() -> None:
    faces, arguments = stable_faces_of(SCENE.bodies["mug"]), ("mug", "cupboard_top")
    said = Placement("cupboard_top", 1, 0.05, 0.02, 0.3)
    pose = placed_pose(faces, said, SCENE.world_pose(SCENE.region("cupboard_top")))
    rotation = faces.ways[1].rotation
    near = laid(SCENE, arguments, rotation, pose.matrix)
    assert isinstance(near, Placement) and near.face == 1 and near.x == pytest.approx(0.05)
    lifted = pose.matrix.copy()
    lifted[2, 3] += 0.1
    assert isinstance(laid(SCENE, arguments, rotation, lifted), Pose)
    assert isinstance(
        laid(SCENE, arguments, np.eye(3)[::-1], pose.matrix), Pose
    )  # no face of the body
