"""The robot's sphere cover contains the robot."""

from __future__ import annotations

import numpy as np

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.spheres import link_covers
from tamp.geometric.scene.scene import Hull


def test_every_point_of_every_hull_lies_in_a_sphere(rng: np.random.Generator) -> None:
    robot = ROBOTS["panda_mobile"]()
    covers = link_covers(robot)
    checked = 0
    for link in robot.links:
        for k, part in enumerate(link.parts):
            if not isinstance(part.shape, Hull):
                continue
            leaves, _ = covers[link.name, k]
            triangles = part.shape.vertices[part.shape.faces]
            weights = rng.dirichlet(np.ones(3), (len(triangles), 100))
            surface = np.einsum("tnk,tkx->tnx", weights, triangles).reshape(-1, 3)
            inside = (surface + rng.permutation(surface)) / 2
            points = np.concatenate([part.shape.vertices, surface, inside])
            outside = np.linalg.norm(points[:, None] - leaves[:, :3], axis=2) - leaves[:, 3]
            assert outside.min(axis=1).max() <= 0.0, link.name
            checked += 1
    assert checked == 11


def test_slack_bounds_how_far_spheres_stand_out() -> None:
    robot = ROBOTS["panda_mobile"]()
    covers = link_covers(robot)
    assert len(covers) == 11
    for link in robot.links:
        for k, part in enumerate(link.parts):
            if isinstance(part.shape, Hull):
                leaves, slack = covers[link.name, k]
                a, b, c = (part.shape.vertices[part.shape.faces[:, i]] for i in range(3))
                normals = np.cross(b - a, c - a)
                lengths = np.linalg.norm(normals, axis=1)
                normals, a = (
                    normals[lengths > 1e-9] / lengths[lengths > 1e-9, None],
                    a[lengths > 1e-9],
                )
                depth = np.einsum("fx,fx->f", normals, a)[:, None] - normals @ leaves[:, :3].T
                assert (leaves[:, 3] - depth.min(axis=0) <= slack + 1e-6).all(), link.name
