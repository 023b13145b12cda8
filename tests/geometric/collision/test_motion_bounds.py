"""How far a part moves in an interval of an edge is never more than the kernel's bound."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numba import njit

from tamp.geometric.collision.collisions import Collisions
from tamp.geometric.collision.edge_check import geometry_of
from tamp.geometric.collision.edge_decision import scratch
from tamp.geometric.collision.kernels import required_clearance
from tamp.geometric.collision.placing import place_frames, place_part
from tamp.geometric.collision.tables import CENTRE, RADIUS
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Array

SCENE = """
name: bounds
robot: {{model: {robot}, base: [0.0, 0.0, 0.0]}}
room: {{x: [-3.0, 3.0], y: [-3.0, 3.0]}}
bodies: {{can: {{cylinder: {{radius: 0.03, height: 0.1}}, at: [-1.5, -1.5, 0.052]}}}}
goal: (and)
"""


@njit
def _looked_at(conf, change, half, packed):
    """Where all parts are, (n, 12), and what each needs within the interval without a padding."""
    geometry = geometry_of(packed)
    joints, parts, part_poses = geometry[0], geometry[3], geometry[4]
    work = scratch(parts, joints, geometry[5], geometry[6], len(conf), True)
    frames, placed, reach = np.empty((len(joints) + 1, 12)), np.empty((len(parts), 12)), work[2]
    place_frames(conf, joints, frames)
    needed = np.empty(len(parts))
    for i in range(len(parts)):
        place_part(i, frames, change, joints, parts, part_poses, placed, reach)
        needed[i] = required_clearance(i, 0, half, 0.0, parts, reach)
    return placed, needed


def _changes(start: Array, end: Array) -> Array:
    step = end - start
    magnitudes = np.abs(step)
    magnitudes[0] = np.hypot(step[0], step[1])
    return np.concatenate([magnitudes, step])


@pytest.mark.parametrize("slides", [False, True])
@pytest.mark.parametrize("model", ["panda_mobile", "ur5"])
def test_no_point_of_a_part_moves_farther_than_is_reckoned_with(
    model: str, slides: bool, tmp_path: Path, rng: np.random.Generator
) -> None:
    file = tmp_path / "bounds.yaml"
    file.write_text(SCENE.format(robot=model), encoding="utf-8")
    robot = ROBOTS[model]()
    if slides:
        joints = list(robot.joints)
        joints[2] = replace(joints[2], kind="prismatic")
        robot = replace(robot, joints=tuple(joints))
    arrangement = Collisions(load_scene(file).scene, robot, Kinematics(robot)).arrangement({})
    parts, size = arrangement.tables.parts, 3 + len(robot.joints)

    tightest = np.inf
    for _ in range(150):
        start = rng.uniform(-1.5, 1.5, size)
        end = start + rng.normal(0.0, 1.0, size) * rng.choice([0.0, 0.3, 1.0], size)
        middle, half = float(rng.uniform(0.2, 0.8)), float(rng.choice([0.2, 0.05, 0.01]))
        change = _changes(start, end)

        def at(share: float, start=start, end=end, change=change, half=half) -> tuple[Array, Array]:
            return _looked_at(start + share * (end - start), change, half, arrangement.packed)

        placed, needed = at(middle)
        for share in middle + half * np.array([-1.0, -0.6, 0.6, 1.0]):
            moved, _ = at(float(share))
            for i in range(len(parts)):
                # Points all over the part's sphere.
                points = rng.normal(size=(20, 3))
                points /= np.linalg.norm(points, axis=1, keepdims=True)
                points = parts[i, CENTRE : CENTRE + 3] + points * parts[i, RADIUS]
                way = [
                    points @ rows[i, :9].reshape(3, 3).T + rows[i, 9:] for rows in (placed, moved)
                ]
                farthest = float(np.linalg.norm(way[1] - way[0], axis=1).max())
                assert farthest <= needed[i] + 1e-9
                if farthest > 1e-6:
                    tightest = min(tightest, needed[i] / farthest)
    assert tightest < 1.1  # it is a bound that means something
