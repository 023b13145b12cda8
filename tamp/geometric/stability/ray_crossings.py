"""Ray casting, straight lines through a body: where they enter and leave its convex parts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.hulls import body_hull
from tamp.geometric.stability.ray_kernels import cross_all, stretch
from tamp.geometric.stability.shapes import once_a_shape

if TYPE_CHECKING:
    from jaxtyping import Float

Planes = NDArray[np.intp]

SEAM_WIDTH_M = 5e-4
"""Parts nearer to each other than this along a line count as one solid, metres."""


@dataclass(frozen=True)
class Crossing:
    """The crossing of a line with a solid: from `start` to `end` metres along it, with the outward
    normals (3,) there.
    """

    start: float
    end: float
    start_normal: Array
    end_normal: Array


class ConvexUnion:
    """A body's parts as intersections of half-spaces, and its surface as triangles. All in the
    body's frame, metres.
    """

    def __init__(self, body: Body) -> None:
        normals, offsets, first, corners, areas = [], [], [], [], []
        for part in body.parts:
            vertices, triangles = body_hull(replace(body, parts=(part,)))
            a, b, c = (vertices[triangles[:, i]] for i in range(3))
            normal = np.cross(b - a, c - a)
            area = np.linalg.norm(normal, axis=1)
            kept = area > 1e-12
            normal = normal[kept] / area[kept, None]
            first.append(sum(len(block) for block in normals))
            normals.append(normal)
            offsets.append(np.einsum("ij,ij->i", normal, a[kept]))
            areas.append(area[kept])
            corners.append(np.stack([a, b, c], axis=1)[kept])

        self._normals, self._offsets = np.concatenate(normals), np.concatenate(offsets)
        self._first = np.array([*first, len(self._normals)], dtype=np.int64)
        self._corners = np.concatenate(corners)
        self._cumulative = np.cumsum(np.concatenate(areas))
        self.centre = centre_of_mass(body)

    def extent(self, direction: Float[Array, " 3"]) -> tuple[float, float]:
        """Compute the least and the largest coordinate of the body along a direction (3,)."""
        along = self._corners.reshape(-1, 3) @ direction
        return float(along.min()), float(along.max())

    def surface_points(
        self, rng: np.random.Generator, count: int
    ) -> tuple[Float[Array, "count 3"], Float[Array, "count 3"]]:
        """Draw points (count, 3), uniform by area over all parts' surfaces, and their outward
        normals (count, 3).
        """
        index = np.searchsorted(self._cumulative, rng.random(count) * self._cumulative[-1])
        index = np.minimum(index, len(self._cumulative) - 1)
        u, v = np.sqrt(rng.random(count)), rng.random(count)
        weights = np.stack([1 - u, u * (1 - v), u * v], axis=1)
        return np.einsum("ij,ijk->ik", weights, self._corners[index]), self._normals[index]

    def crossings(
        self, origins: Float[Array, "k 3"], directions: Float[Array, "*k 3"]
    ) -> tuple[Float[Array, "k p"], Float[Array, "k p"], Planes, Planes]:
        """Intersect lines from `origins` (k, 3) along `directions` (k, 3), or (3,) for all, with
        each of the p parts.

        Returns:
            Starts and ends (k, p) in metres along the lines, an end before its start where a line
            misses the part; and the indices (k, p) of the planes there, for `normals`.
        """
        shape = len(origins), len(self._first) - 1
        starts, ends = np.empty(shape), np.empty(shape)
        start_planes, end_planes = np.empty(shape, dtype=np.intp), np.empty(shape, dtype=np.intp)
        cross_all(
            origins, np.atleast_2d(directions), self._normals, self._offsets, self._first, starts,
            ends, start_planes, end_planes,
        )  # fmt: skip
        return starts, ends, start_planes, end_planes

    def normals(self, planes: Planes) -> Float[Array, "... 3"]:
        """Return outward normals (..., 3) of planes."""
        return self._normals[planes]

    def solid_at(
        self, origin: Float[Array, " 3"], direction: Float[Array, " 3"]
    ) -> Crossing | None:
        """Find the stretch of solid that contains, or begins at, the origin of a line; None where
        there is none.
        """
        found, start, end, first, last = stretch(
            origin, direction, self._normals, self._offsets, self._first, SEAM_WIDTH_M
        )
        return Crossing(start, end, self._normals[first], self._normals[last]) if found else None


@once_a_shape
def solid_of(body: Body) -> ConvexUnion:
    """Return the solid of a body, made once for all bodies, and all scenes, of one shape."""
    return ConvexUnion(body)
