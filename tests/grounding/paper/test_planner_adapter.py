"""The paper's networks in the planner: what they propose for a body that is far away."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.body_geometry import geometry_of
from grounding.paper.planner_adapter import SnappingSampler, nearest_face, snapped
from grounding.random_poses import random_turn
from grounding.registry import shipped_grounding
from tamp.geometric.scene.pose import Pose
from tamp.geometric.stability.placement import Placement, certified_pose
from tamp.geometric.stability.stable_poses import stable_faces_of
from tamp.planner.problem import load_problem

SCENE = load_problem("four_objects").scene


@pytest.mark.parametrize("name", ["cracker_box", "mustard", "mug", "bowl"])
def test_a_laid_body_stands_on_a_face_where_it_was(name: str) -> None:
    body, rng = SCENE.bodies[name], np.random.default_rng(0)
    form = geometry_of(body.parts)
    middle = form.corners.mean(axis=0)
    for _ in range(20):
        pose = random_turn(rng)
        pose[:3, 3] = rng.uniform(-1.0, 1.0, 3)
        face = nearest_face(form, pose)
        assert face is not None
        found = snapped(form, face, pose)
        assert found[:3, :3] @ found[:3, :3].T == pytest.approx(np.eye(3), abs=1e-9)
        assert np.linalg.det(found[:3, :3]) == pytest.approx(1.0)
        assert max(face.rotation[2] @ found[2, :3] for face in form.faces) == pytest.approx(1.0)
        nearest = max(form.faces, key=lambda face: float(face.rotation[2] @ pose[2, :3]))
        assert nearest.rotation[2] @ found[2, :3] == pytest.approx(1.0)
        low, lower = ((form.vertices @ one[2, :3] + one[2, 3]).min() for one in (pose, found))
        assert lower == pytest.approx(low)
        assert (found[:3, :3] @ middle + found[:3, 3])[:2] == pytest.approx(
            (pose[:3, :3] @ middle + pose[:3, 3])[:2]
        )
        assert snapped(form, face, found) == pytest.approx(found)


@pytest.mark.parametrize("name", ["mlp-bb", "gnn-bb", "mlp-pc", "gnn-pc"])
def test_a_body_from_across_the_room_finds_many_places(name: str) -> None:
    grounding = shipped_grounding("on", name)
    assert isinstance(grounding, SnappingSampler)
    surface = SCENE.surfaces["cupboard_top"]
    T_world_region = SCENE.world_pose(surface)
    poses = grounding.propose(SCENE, ("mug", "cupboard_top"), 60, np.random.default_rng(0))
    faces = stable_faces_of(SCENE.bodies["mug"])
    rested = [
        certified_pose(faces, one, surface, T_world_region)
        for one in poses
        if isinstance(one, Placement)
    ]
    places = np.array([pose.position[:2] for pose in rested if isinstance(pose, Pose)])
    assert len(poses) == 60
    assert len(places) >= 15
    assert np.ptp(places, axis=0).min() > 0.1
    again = grounding.propose(SCENE, ("mug", "cupboard_top"), 60, np.random.default_rng(0))
    assert again == poses
