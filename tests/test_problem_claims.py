"""What the shipped problems say of themselves is so."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp import load_problem, solve
from tamp.geometric.samplers.placements import SurfacePlacements
from tamp.geometric.scene.pose import Pose
from tamp.geometric.stability.placement import placed_pose
from tamp.geometric.stability.stable_poses import stable_faces_of


def test_the_last_object_fits_in_a_twentieth_of_the_packed_top(rng: np.random.Generator) -> None:
    problem = load_problem("packed")
    scene, pair = problem.scene, problem.context.collisions.pair
    standing = {
        name: scene.bodies[name].pose
        for name in scene.movable
        if name not in ("soup_can", "sugar_box")
    }

    def free(body: str, others: dict[str, Pose], count: int) -> list[Pose]:
        T_world_region, faces = (
            scene.world_pose(scene.region("cupboard_top")),
            stable_faces_of(scene.bodies[body]),
        )
        proposed = SurfacePlacements().propose(scene, (body, "cupboard_top"), count, rng)
        poses = [placed_pose(faces, placement, T_world_region) for placement in proposed]
        return [
            pose
            for pose in poses
            if not any(pair(body, pose, name, at) for name, at in others.items())
        ]

    cans = free("soup_can", standing, 100)
    assert 5 <= len(cans) <= 30
    shares = [len(free("sugar_box", {**standing, "soup_can": can}, 400)) / 400 for can in cans[:10]]
    assert 0.03 < np.mean(shares) < 0.08


@pytest.mark.parametrize("seed", [0, 1])
def test_tall_objects_lie_in_the_drawers(seed: int) -> None:
    solution = solve(load_problem("drawers"), max_time=60.0, seed=seed)
    assert solution.solved
    leaning = {}
    for action in solution.plan:
        if action.name == "place":
            pose = next(
                value
                for word in action.arguments
                if isinstance(value := solution.values.get(word), Pose)
            )
            leaning[action.objects[0]] = math.degrees(
                math.acos(float(np.clip(pose.rotation[2, 2], -1.0, 1.0)))
            )
    assert set(leaning) == {"pasta_box", "sugar_box", "soup_can", "mug"}
    assert leaning["pasta_box"] == pytest.approx(90.0) and leaning["sugar_box"] == pytest.approx(
        90.0
    )
