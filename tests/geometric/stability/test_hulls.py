"""Hulls of bodies against textbook volumes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Shape, Sphere
from tamp.geometric.stability.hulls import CYLINDER_SIDES, body_hull, part_mesh
from tests.geometric.making import hull

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)


def of(*parts: Part, **more: object) -> Body:
    return Body("thing", parts, Pose((5.0, 5.0, 5.0)), True, **more)  # type: ignore[arg-type]


def volume(vertices: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (Box((0.2, 0.3, 0.4)), 0.024),
        # A regular prism of n sides in the circle: n / 2 sin(2 pi / n) r^2 h.
        (
            Cylinder(0.1, 0.5),
            CYLINDER_SIDES / 2 * math.sin(2 * math.pi / CYLINDER_SIDES) * 0.01 * 0.5,
        ),
        (hull(TETRAHEDRON), 1 / 6),
    ],
    ids=["box", "cylinder", "tetrahedron"],
)
def test_a_mesh_looks_outward_and_has_the_shapes_volume(shape: Shape, expected: float) -> None:
    assert volume(*part_mesh(Part(shape))) == pytest.approx(expected)
    moved = Part(shape, Pose.from_xyz_rpy((1.0, 2.0, 3.0), (0.3, 0.4, 0.5)))
    assert volume(*part_mesh(moved)) == pytest.approx(expected)


def test_a_balls_mesh_lies_within_it_and_nearly_fills_it() -> None:
    vertices, triangles = part_mesh(Part(Sphere(0.5)))
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(np.full(len(vertices), 0.5))
    assert 0.95 < volume(vertices, triangles) / (4 / 3 * math.pi * 0.125) < 1.0


def test_the_hull_of_two_parts_spans_what_is_between_them() -> None:
    apart = of(
        Part(Box((0.1, 0.1, 0.1)), Pose((-0.45, 0, 0))),
        Part(Box((0.1, 0.1, 0.1)), Pose((0.45, 0, 0))),
    )
    vertices, triangles = body_hull(apart)
    assert volume(vertices, triangles) == pytest.approx(
        1.0 * 0.1 * 0.1
    )  # in the body's frame, not the world's
    assert vertices.mean(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
