"""Ray casting, straight lines through a body: where they enter and leave its convex parts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.hulls import body_hull, centre_of_mass

if TYPE_CHECKING:
    from jaxtyping import Float

Planes = NDArray[np.intp]

SEAM_WIDTH_M = 5e-4
"""Parts nearer to each other than this along a line count as one solid, metres."""


@dataclass(frozen=True)
class Contact:
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
        self._first = np.array(first)
        last = np.append(self._first[1:], len(self._normals))
        # The planes of each part, (p, most), the first one repeated behind the last: one look for
        # all parts.
        places = np.arange((last - self._first).max())
        self._planes = np.where(
            places < (last - self._first)[:, None],
            self._first[:, None] + places,
            self._first[:, None],
        )
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
        slope = np.atleast_2d(directions) @ self._normals.T
        room = self._offsets - origins @ self._normals.T
        with np.errstate(divide="ignore", invalid="ignore"):
            t = room / slope
        outside = (np.abs(slope) < 1e-12) & (room < 0)
        enter = np.where(outside, np.inf, np.where(slope < -1e-12, t, -np.inf))
        leave = np.where(slope > 1e-12, t, np.inf)
        start_plane = self._first + np.argmax(enter[:, self._planes], axis=2)
        end_plane = self._first + np.argmin(leave[:, self._planes], axis=2)
        rows = np.arange(len(origins))[:, None]
        return enter[rows, start_plane], leave[rows, end_plane], start_plane, end_plane

    def normals(self, planes: Planes) -> Float[Array, "... 3"]:
        """Return outward normals (..., 3) of planes."""
        return self._normals[planes]

    def solid_at(self, origin: Float[Array, " 3"], direction: Float[Array, " 3"]) -> Contact | None:
        """Find the stretch of solid that contains, or begins at, the origin of a line; None where
        there is none.
        """
        starts, ends, start_planes, end_planes = (
            row[0] for row in self.crossings(origin[None], direction)
        )
        crossed = np.flatnonzero(ends > starts)
        here = crossed[(starts[crossed] <= SEAM_WIDTH_M) & (ends[crossed] >= -SEAM_WIDTH_M)]
        if len(here) == 0:
            return None

        first, last = here[np.argmin(starts[here])], here[np.argmax(ends[here])]
        for _ in range(len(crossed)):  # parts that touch the stretch lengthen it, one after another
            low = crossed[
                (starts[crossed] < starts[first]) & (ends[crossed] >= starts[first] - SEAM_WIDTH_M)
            ]
            high = crossed[
                (ends[crossed] > ends[last]) & (starts[crossed] <= ends[last] + SEAM_WIDTH_M)
            ]
            if len(low) == 0 and len(high) == 0:
                break
            first = low[np.argmin(starts[low])] if len(low) else first
            last = high[np.argmax(ends[high])] if len(high) else last

        normals = self._normals[start_planes[first]], self._normals[end_planes[last]]
        return Contact(float(starts[first]), float(ends[last]), *normals)
