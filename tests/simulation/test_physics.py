"""Pybullet as we use it measures what it should."""

from __future__ import annotations

import itertools
import math
import subprocess
import sys

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import (
    Box,
    Cylinder,
    Hull,
    Part,
    Sphere,
)
from tamp.simulation.engines import open_world
from tamp.simulation.physics import load_bullet
from tests.needs import NEEDS_PYBULLET
from tests.simulation.scenes import body, cube_hull, scene_of

SHAPES = {
    "box": Box((0.1, 0.1, 0.1)),
    "cylinder": Cylinder(0.05, 0.1),
    "sphere": Sphere(0.05),
    "hull": cube_hull(0.1),
}


@pytest.mark.parametrize("first", SHAPES)
@pytest.mark.parametrize("second", SHAPES)
def test_distances_are_exact(first: str, second: str) -> None:
    scene = scene_of(body("a", Part(SHAPES[first])), body("b", Part(SHAPES[second])))
    with open_world(scene) as world:
        for gap, axis in itertools.product((0.01, 0.001, -0.0005, -0.004), (0, 2)):
            away = 0.1 + gap
            world.place("b", Pose((away, 0.0, 0.0) if axis == 0 else (0.0, 0.0, away)).matrix)
            assert world.body_distance("a", "b") == pytest.approx(gap, abs=3e-5)
        world.place("b", Pose((0.0, 0.0, 0.3)).matrix)
        assert world.body_distance("a", "b") == math.inf


def test_pad_of_the_robots_hulls_is_added_back() -> None:
    robot = ROBOTS["panda_mobile"]()
    with open_world(scene_of(body("block", Part(Box((0.03, 0.06, 0.03))))), robot) as world:
        world.set_robot((0, 0, 0), robot.home, 0.062)
        world.place("block", world.link_poses()["panda_hand"] @ robot.T_hand_tool.matrix)
        for finger in ("panda_leftfinger", "panda_rightfinger"):
            distance = world.distance(world.links[finger], world.solids["block"][0])
            assert distance == pytest.approx(0.001, abs=2e-4)


def test_setting_the_robot_moves_its_links() -> None:
    robot = ROBOTS["panda_mobile"]()
    with open_world(scene_of(), robot) as world:
        world.set_robot((1.0, 2.0, math.pi / 2), robot.home, 0.08)
        poses = world.link_poses()
        assert list(poses) == [link.name for link in robot.links]
        expected = Pose.from_xyz_yaw(1.0, 2.0, 0.0, math.pi / 2).matrix @ robot.T_base_arm.matrix
        assert np.allclose(poses["panda_link0"], expected, atol=1e-6)
        left, right = poses["panda_leftfinger"][:3, 3], poses["panda_rightfinger"][:3, 3]
        assert np.linalg.norm(left - right) == pytest.approx(0.08, abs=1e-6)


def test_boxes_around_the_links_hold_the_planners_hulls() -> None:
    robot = ROBOTS["panda_mobile"]()
    with open_world(scene_of(), robot) as world:
        checked = 0
        for link in robot.links:
            solid = world.links[link.name]
            for part in link.parts:
                if isinstance(part.shape, Hull):
                    vertices = part.pose.apply(part.shape.vertices)
                    assert (np.abs(vertices - solid.centre) <= solid.half + 1e-6).all()
                    checked += 1
        assert checked >= 11


def test_rays_name_what_they_hit() -> None:
    with open_world(scene_of(body("a", Part(Box((0.1, 0.1, 0.1))), at=(0, 0, 1)))) as world:
        starts = np.array([[0.0, 0, 2], [1.0, 0, 2], [5.0, 0, 2]])
        ends = np.array([[0.0, 0, 0], [1.0, 0, -2], [5.0, 0, 1]])
        (first, at), (second, below), (third, _) = world.rays(starts, ends)
        assert (first, second, third) == ("a", "floor", None)
        assert at == pytest.approx(0.475, abs=1e-4)
        assert below == pytest.approx(0.5, abs=1e-4)


@NEEDS_PYBULLET
def test_importing_pybullet_prints_nothing() -> None:
    code = "from tamp.simulation.physics import load_bullet; load_bullet(); print('only this')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("only this\n", "")
    assert load_bullet() is load_bullet()
