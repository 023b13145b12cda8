"""The convex hull of a body, in its own frame."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.outline import outline as outline
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, Shape, Sphere

if TYPE_CHECKING:
    from jaxtyping import Float

CYLINDER_SIDES = 32
"""Sides of the prism that stands for a cylinder."""

Triangles = NDArray[np.int64]


def prepare(bodies: Iterable[Body]) -> None:
    """Import what the hulls of bodies need, so that it is there before planning begins."""
    if any(len(body.parts) > 1 for body in bodies):
        importlib.import_module("scipy.spatial")


def body_hull(body: Body) -> tuple[Float[Array, "n 3"], Triangles]:
    """Compute vertices (n, 3) and triangles (m, 3), outward, of the convex hull of all parts.
    Metres.
    """
    if len(body.parts) == 1:
        return _placed(body.parts[0])
    # Half a second to import, and only bodies of several parts need it.
    from scipy.spatial import ConvexHull

    vertices = np.concatenate([_placed(part)[0] for part in body.parts])
    hull = ConvexHull(vertices)
    triangles = hull.simplices.astype(np.int64)
    centre = vertices[hull.vertices].mean(axis=0)
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - centre) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return vertices, triangles


def part_mesh(part: Part) -> tuple[Float[Array, "n 3"], Triangles]:
    """Return vertices (n, 3) and triangles (m, 3), outward, of one part in its body's frame; within
    it where round.
    """
    return _placed(part)


def _placed(part: Part) -> tuple[Array, Triangles]:
    vertices, triangles = _mesh(part.shape)
    return part.pose.apply(vertices), triangles


def _mesh(shape: Shape) -> tuple[Array, Triangles]:
    if isinstance(shape, Hull):
        return shape.vertices, np.asarray(shape.faces, dtype=np.int64)
    if isinstance(shape, Box):
        half = np.array(shape.size) / 2
        return _prism(np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]]) * half[:2], half[2])
    if isinstance(shape, Cylinder):
        angles = np.arange(CYLINDER_SIDES) * 2 * math.pi / CYLINDER_SIDES
        return _prism(
            shape.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1), shape.height / 2
        )
    return _ball(shape)


def _prism(corners: Array, half_height: float) -> tuple[Array, Triangles]:
    n = len(corners)
    low = np.column_stack([corners, np.full(n, -half_height)])
    high = np.column_stack([corners, np.full(n, half_height)])
    triangles: list[tuple[int, int, int]] = []
    for i in range(n):
        j = (i + 1) % n
        triangles += [(i, j, n + j), (i, n + j, n + i)]
        if 0 < i < n - 1:
            triangles += [(0, j, i), (n, n + i, n + j)]
    return np.concatenate([low, high]), np.array(triangles, dtype=np.int64)


def _ball(shape: Sphere) -> tuple[Array, Triangles]:
    golden = math.pi * (3 - math.sqrt(5))
    count = 200
    z = 1 - 2 * (np.arange(count) + 0.5) / count
    ring = np.sqrt(1 - z * z)
    angle = golden * np.arange(count)
    vertices = shape.radius * np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=1)
    from scipy.spatial import ConvexHull

    triangles = ConvexHull(vertices).simplices.astype(np.int64)
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return vertices, triangles
