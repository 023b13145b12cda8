"""The robot's data agree with its description and with themselves."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.urdf import read_collision_vertices
from tamp.geometric.scene.scene import Box, Hull


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


def hull_depth(hull: Hull, points: np.ndarray) -> np.ndarray:
    """How far outside the hull's planes each point is (negative inside), shape (n,)."""
    corners = hull.vertices[hull.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return np.max(points @ normals.T - np.einsum("ij,ij->i", normals, corners[:, 0]), axis=1)


def test_hulls_contain_every_vertex_of_the_urdfs_meshes(robot: Robot) -> None:
    vertices = read_collision_vertices(robot.urdf)
    checked = 0
    for link in robot.links[1:]:
        (part,) = link.parts
        assert isinstance(part.shape, Hull)
        assert np.max(hull_depth(part.shape, vertices[link.name])) < 1e-9
        assert (
            np.max(hull_depth(part.shape, part.shape.vertices.mean(axis=0, keepdims=True))) < -1e-3
        )  # outward
        checked += 1
    assert checked == 11


def test_hulls_are_closed(robot: Robot) -> None:
    for link in robot.links[1:]:
        hull = link.parts[0].shape
        assert isinstance(hull, Hull)
        edges = [
            (a, b)
            for face in hull.faces.tolist()
            for a, b in zip(face, [*face[1:], face[0]], strict=True)
        ]
        assert len(edges) == len(set(edges)) and {(b, a) for a, b in edges} == set(edges)


def test_the_base_is_above_the_floor_and_of_the_asked_size(robot: Robot) -> None:
    (part,) = robot.links[0].parts
    assert isinstance(part.shape, Box)
    bottom, top = (part.pose.position[2] + sign * part.shape.size[2] / 2 for sign in (-1, 1))
    assert 0.0 < bottom < 0.05 and top == pytest.approx(robot.T_base_arm.position[2])
    assert part.shape.size[:2] == (0.8, 0.7)


def test_limits(robot: Robot) -> None:
    margin = np.radians(0.5)
    maker = [(-2.8973, 2.8973), (-1.7628, 1.7628), (-2.8973, 2.8973), (-3.0718, -0.0698), (-2.8973, 2.8973),
             (-0.0175, 3.7525), (-2.8973, 2.8973)]  # fmt: skip
    assert np.allclose(
        np.column_stack([robot.lower, robot.upper]), np.array(maker) + np.array([margin, -margin])
    )
    assert robot.velocity[3:] == (2.175,) * 4 + (2.61,) * 3
    assert all(
        j.lower < lo and up < j.upper
        for j, lo, up in zip(robot.joints, robot.lower, robot.upper, strict=True)
    )
    assert all(lo < q < up for lo, q, up in zip(robot.lower, robot.home, robot.upper, strict=True))
    assert (
        len(robot.velocity) == len(robot.acceleration) == 10
        and min(robot.velocity + robot.acceleration) > 0
    )


def test_allowed_pairs_are_sorted_names_of_links(robot: Robot) -> None:
    names = {link.name for link in robot.links}
    assert all(a < b and {a, b} <= names for a, b in robot.allowed)
    assert ("panda_link5", "panda_link7") not in robot.allowed


def test_allowed_pairs_never_or_always_collide_and_home_is_free(robot: Robot) -> None:
    fcl = pytest.importorskip("fcl")
    kinematics = Kinematics(robot)
    objects = {}
    for link in robot.links:
        (part,) = link.parts
        if isinstance(part.shape, Box):
            geometry = fcl.Box(*part.shape.size)
        else:
            assert isinstance(part.shape, Hull)
            faces = np.hstack([np.full((len(part.shape.faces), 1), 3), part.shape.faces]).ravel()
            geometry = fcl.Convex(np.array(part.shape.vertices), len(part.shape.faces), faces)
        objects[link.name] = (fcl.CollisionObject(geometry), part.pose.matrix)
    pairs = sorted(tuple(sorted(pair)) for pair in itertools.combinations(objects, 2))

    def colliding(q: np.ndarray, opening: float) -> set[tuple[str, str]]:
        poses = kinematics.link_poses(np.concatenate([np.zeros(3), q]), opening)
        for name, (item, T_link_part) in objects.items():
            T = poses[name] @ T_link_part
            item.setTransform(fcl.Transform(T[:3, :3], T[:3, 3]))
        return {p for p in pairs if fcl.collide(objects[p[0]][0], objects[p[1]][0])}

    rng = np.random.default_rng(0)
    states = [
        colliding(rng.uniform(robot.lower, robot.upper), rng.uniform(0.0, robot.opening))
        for _ in range(1500)
    ]
    counts = {pair: sum(pair in state for state in states) for pair in pairs}
    fingers = ("panda_leftfinger", "panda_rightfinger")
    assert all(counts[pair] in (0, len(states)) for pair in robot.allowed - {fingers})
    assert all(counts[pair] < len(states) for pair in pairs if pair not in robot.allowed)
    for opening in (0.001, robot.opening):
        assert colliding(np.array(robot.home), opening) <= robot.allowed


def test_home_is_compact_and_points_down(robot: Robot) -> None:
    kinematics = Kinematics(robot)
    conf = np.concatenate([np.zeros(3), robot.home])
    tool = kinematics.tool(conf)
    assert tool[2, 2] == pytest.approx(-1.0, abs=1e-6)
    assert (
        tool[2, 3] - 0.25 > 0.7
    )  # a held object of 25 cm passes over the base and an ordinary table
    poses = kinematics.link_poses(conf, robot.opening)
    for link in robot.links[1:]:
        hull = link.parts[0].shape
        assert isinstance(hull, Hull)
        points = hull.vertices @ poses[link.name][:3, :3].T + poses[link.name][:3, 3]
        assert (
            np.max(np.linalg.norm(points[:, :2], axis=1)) < 0.53
        )  # inside the circle that the base itself sweeps


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_every_robot_is_complete(name: str) -> None:
    robot = ROBOTS[name]()
    assert robot.name == name and robot.urdf.is_file()
    assert robot.links[0].name == robot.base
    last = robot.arms[-1]
    grasping = [finger.child for finger in last.fingers] or [last.hand]
    assert [link.name for link in robot.links[-len(grasping) :]] == grasping
