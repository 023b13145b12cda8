"""Convex hulls of points: closed triangle surfaces, with few corners, also of points that are
nearly flat.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float, Int

HULL_TOLERANCE_M = 0.0005
"""Metres that a point may lie outside of a simplified hull."""

_BLOCK_ROWS = 20_000
_THINNEST_M = 0.001


def hull_of(
    points: Float[Array, "k 3"],
) -> tuple[Float[Array, "n 3"], Int[NDArray[np.integer], "m 3"]]:
    """Compute vertices (n, 3) and outward faces (m, 3) of the convex hull of points; flat points
    are thickened to 1 mm.

    Raises:
        ValueError: The points lie on one line.
    """
    points = thickened(points)
    hull = ConvexHull(points)
    order = np.sort(hull.vertices)
    number = np.full(len(points), -1)
    number[order] = np.arange(len(order))
    faces = number[hull.simplices]
    corners = points[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return points[order], faces


def simplified(points: Float[Array, "n 3"]) -> Float[Array, "m 3"]:
    """Simplify a hull: corners of it, as few as keep every point within 0.5 mm of the hull."""
    corners, _ = hull_of(points)
    chosen = np.unique(np.argmax(corners @ directions(24).T, axis=0))
    while len(chosen) < len(corners):
        try:
            equations = ConvexHull(corners[chosen]).equations
        except QhullError:  # the few corners lie in a plane
            return corners
        outermost, beyond = _outermost(corners, equations)
        farthest = np.unique(outermost[beyond > HULL_TOLERANCE_M])
        if not len(farthest):
            return corners[chosen]
        chosen = np.union1d(chosen, farthest)
    return corners


def _outermost(points: Array, equations: Array) -> tuple[NDArray[np.int64], Array]:
    """Find for each plane (k, 4) the point that lies farthest beyond it, and how far; a block of
    points at a time.
    """
    best, index = np.full(len(equations), -np.inf), np.zeros(len(equations), dtype=np.int64)
    for start in range(0, len(points), _BLOCK_ROWS):
        beyond = points[start : start + _BLOCK_ROWS] @ equations[:, :3].T + equations[:, 3]
        found = np.argmax(beyond, axis=0)
        height = beyond[found, np.arange(len(equations))]
        higher = height > best
        best[higher], index[higher] = height[higher], found[higher] + start
    return index, best


def thickened(points: Float[Array, "n 3"]) -> Float[Array, "m 3"]:
    """Return the points; when they lie within 1 mm of a plane, moved 0.5 mm to both sides of it."""
    centred = points - points.mean(axis=0)
    # The right singular vector of the least singular value is the normal of the best plane.
    _, vectors = np.linalg.eigh(centred.T @ centred)
    normal = vectors[:, 0]
    if np.ptp(centred @ normal) >= _THINNEST_M:
        return points
    if np.ptp(centred @ vectors[:, 1]) < 1e-6:
        raise ValueError("all its points lie on one line")
    return np.concatenate([points + normal * _THINNEST_M / 2, points - normal * _THINNEST_M / 2])


def directions(count: int) -> Float[Array, "n 3"]:
    """Return the six axis directions, and about `count` spread evenly over the sphere (Fibonacci),
    shape (n, 3).
    """
    index = np.arange(count) + 0.5
    z = 1 - 2 * index / count
    around = np.pi * (1 + 5**0.5) * index
    radius = np.sqrt(1 - z**2)
    even = np.stack([radius * np.cos(around), radius * np.sin(around), z], axis=1)
    return np.concatenate([np.eye(3), -np.eye(3), even])
