"""What the placement streams yield stands there: on the millimetre, within the region, and under gravity."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.scene.scene import CONTACT_GAP
from tamp.geometric.streams.sampling import sample_inside, sample_on
from tamp.planner.problem import load_problem
from tamp.simulation.settle import settle
from tamp.simulation.shapes import body_points
from tests.geometric.streams.scenes import THINGS, call, problem_with, values


@pytest.mark.parametrize("name", sorted(THINGS))
def test_on_a_surface(name: str, tmp_path: Path) -> None:
    problem = problem_with(name, tmp_path)
    scene, context = problem.scene, problem.context
    surface = scene.surfaces["table"]
    poses = values(sample_on(context, name, "table", call()), 20)
    assert len(poses) == 20
    for pose in poses:
        points = (scene.world_pose(surface).inverse() @ pose).apply(
            body_points(scene.bodies[name].parts)
        )
        assert points[:, 2].min() == pytest.approx(CONTACT_GAP, abs=2e-4)
        assert (np.abs(points[:, :2]) <= np.array(surface.size) / 2 + 1e-6).all()
        assert context.collisions.between(name, pose, {}) is None


@pytest.mark.parametrize("name", sorted(THINGS))
def test_inside_a_cavity(name: str, tmp_path: Path) -> None:
    problem = problem_with(name, tmp_path)
    scene = problem.scene
    cavity = scene.cavities["cupboard_2"]
    poses = values(sample_inside(problem.context, name, "cupboard_2", call()), 20)
    assert len(poses) == 20
    low = np.array([-cavity.size[0] / 2, -cavity.size[1] / 2, 0.0])
    high = np.array([cavity.size[0] / 2, cavity.size[1] / 2, cavity.size[2]])
    for pose in poses:
        points = (scene.world_pose(cavity).inverse() @ pose).apply(
            body_points(scene.bodies[name].parts)
        )
        assert (points >= low - 1e-6).all() and (points <= high + 1e-6).all()
        assert points[:, 2].min() == pytest.approx(CONTACT_GAP, abs=2e-4)


@pytest.mark.parametrize("name", sorted(THINGS))
def test_it_stays_under_gravity(name: str, tmp_path: Path) -> None:
    problem = problem_with(name, tmp_path)
    poses = values(sample_on(problem.context, name, "table", call(1)), 6)
    assert len(poses) == 6
    for pose in poses:
        settled = settle(problem.scene, {name: pose}, 1.5)[name]
        assert settled.moved < 0.01 and settled.turned < math.radians(5)


def test_the_uniform_sampler_is_put_to_rest_too(tmp_path: Path) -> None:
    problem_with("box", tmp_path)
    problem = load_problem(tmp_path / "box.yaml", samplers={"on": "uniform"})
    scene = problem.scene
    surface = scene.surfaces["table"]
    poses = values(sample_on(problem.context, "box", "table", call()), 5, most=50_000)
    assert len(poses) == 5
    for pose in poses:
        points = (scene.world_pose(surface).inverse() @ pose).apply(
            body_points(scene.bodies["box"].parts)
        )
        assert points[:, 2].min() == pytest.approx(CONTACT_GAP, abs=2e-4)


def test_what_does_not_fit_ends_with_the_reason(tmp_path: Path) -> None:
    problem = problem_with("tower", tmp_path, "box: [0.06, 0.5, 0.5]")
    tries = list(sample_inside(problem.context, "tower", "cupboard_2", call()))
    assert len(tries) == 1 and "protrudes" in tries[0].reason  # type: ignore[union-attr]
