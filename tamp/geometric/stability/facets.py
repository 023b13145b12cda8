"""Facets of a convex hull: normals, the turn that puts one down, and the tilt to tip over it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float, Int

SAME_FACET = 0.9995
"""Triangles whose normals' cosine is at least this belong to one facet."""


def facet_normals(
    vertices: Float[Array, "n 3"], triangles: Int[NDArray[np.int64], "m 3"]
) -> list[Float[Array, " 3"]]:
    """Compute outward normals, those of one flat facet once; largest facets first."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    cross = np.cross(b - a, c - a)
    areas = np.linalg.norm(cross, axis=1)
    order = np.argsort(-areas, kind="stable")
    order = order[areas[order] > 1e-9]
    left = cross[order] / areas[order, None]
    normals: list[Array] = []
    while len(left):
        normals.append(left[0])
        left = left[left @ left[0] < SAME_FACET]
    return normals


def rotation_to_down(normal: Float[Array, " 3"]) -> Float[Array, "3 3"]:
    """Compute the smallest rotation that turns a unit vector to -z."""
    axis = np.array([-normal[1], normal[0], 0.0])  # normal x (-z)
    sine, cosine = float(np.linalg.norm(axis)), float(-normal[2])
    if sine < 1e-9:
        return np.eye(3) if cosine > 0 else np.diag([1.0, -1.0, -1.0])
    x, y, z = axis / sine
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + sine * cross + (1 - cosine) * cross @ cross


def tipping_angle(base: Float[Array, "k 2"], centre: Float[Array, " 2"], height: float) -> float:
    """Compute the tilt, radians, that brings the centre of mass over the nearest edge of the base;
    negative when outside.
    """
    edges = np.roll(base, -1, axis=0) - base
    offsets = centre - base
    distances = (edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0]) / np.linalg.norm(
        edges, axis=1
    )
    return math.atan2(float(distances.min()), max(height, 1e-6))
