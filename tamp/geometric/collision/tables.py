"""The geometry as a structure of arrays, in the layout that the compiled kernels read."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Shape, Sphere

if TYPE_CHECKING:
    from jaxtyping import Float

POINT, BOX, CYLINDER, HULL = 0, 1, 2, 3
"""Kinds of convex cores; a sphere is a point with a margin."""

KIND, SIZE, CENTRE, RADIUS, RADIUS_OFFSET = 0, 1, 4, 7, 8
VERTICES, VERTEX_COUNT, COVER_SPHERES, COVER_COUNT, COVER_ERROR = 9, 10, 11, 12, 13
FRAME, ON_FLOOR, LOW, HIGH = 14, 15, 16, 19
PART_COLUMNS = 22
"""Columns of a row that describes one convex part.

KIND; SIZE: half extents of its box around CENTRE, both in the part's frame; RADIUS of its sphere
around CENTRE; RADIUS_OFFSET around the core; VERTICES and COVER_SPHERES: first row and number
of rows in those tables; COVER_ERROR: how far its spheres may stand out of it; FRAME: joint (1..n)
that moves it, 0 for the base; ON_FLOOR: may touch the floor; LOW and HIGH: corners of the world's
box around it (obstacles only). Metres.
"""

SLIDES_COLUMN = 12
"""Column of a joint's row after its pose: 1 where it slides along its z, 0 where it turns."""


class Tables(NamedTuple):
    """All that the kernels know about a robot among bodies. Every pose is 9 numbers of R, row by
    row, then 3 of t.

    Attributes:
        room: x low, x high, y low, y high of the base's centre, metres.
        joints: (n, 13), each joint's frame at 0 in the one before it, the first in the base, and
            SLIDES; they turn about z or slide along it.
        vertices: (3, v) of all hulls, each in its part's frame; one column a vertex, for vector
            instructions.
        leaves: (l, 4) centres and radii of the spheres that cover parts, each in its part's frame.
        parts: (n, PART_COLUMNS) the robot's convex parts, those of an attached body last.
        part_poses: (n, 12) in their frames.
        pairs: (k, 2) rows of `parts` that are checked against each other, the one nearer to the
            base first.
        obstacles: (m, PART_COLUMNS) the bodies' convex parts.
        obstacle_poses: (m, 12) in the world.
    """

    room: Array
    joints: Array
    vertices: Array
    leaves: Array
    parts: Array
    part_poses: Array
    pairs: Array
    obstacles: Array
    obstacle_poses: Array

    def packed(self) -> Float[Array, " packed"]:
        """Pack all tables into one vector, which is what the kernels take: Python hands over one
        array in a microsecond less than nine. It starts with the offset, rows and columns of each;
        `unpack` reads it.
        """
        header: list[int] = []
        offset = 3 * len(self)
        for table in self:
            rows, columns = table.shape if table.ndim == 2 else (1, len(table))
            header += [offset, rows, columns]
            offset += table.size
        return np.concatenate(
            [np.array(header, dtype=np.float64), *(table.ravel() for table in self)]
        )


def pose_rows(matrices: Float[Array, "n 4 4"]) -> Float[Array, "n 12"]:
    """Return homogeneous matrices (n, 4, 4) as rows (n, 12) of the tables."""
    return np.concatenate([matrices[:, :3, :3].reshape(-1, 9), matrices[:, :3, 3]], axis=1)


class TableRows:
    """Collects the rows of convex parts and the vertices and leaves that they point to."""

    def __init__(self) -> None:
        self._vertices: list[Array] = []
        self._leaves: list[Array] = []
        self._vertex_count = 0
        self._leaf_count = 0

    def row(
        self, part: Part, cover: tuple[Float[Array, "k 4"], float] | None = None
    ) -> Float[Array, " width"]:
        """Build the row of one part (PART_COLUMNS,), without its pose; `cover`: leaves (k, 4) in
        the part's frame, slack.
        """
        row = np.zeros(PART_COLUMNS)
        kind, size, centre, radius, offset = _core(part.shape)
        row[KIND], row[RADIUS], row[RADIUS_OFFSET] = kind, radius, offset
        row[SIZE : SIZE + 3], row[CENTRE : CENTRE + 3] = size, centre

        if isinstance(part.shape, Hull):
            row[VERTICES], row[VERTEX_COUNT] = self._vertex_count, len(part.shape.vertices)
            self._vertices.append(np.asarray(part.shape.vertices, dtype=np.float64))
            self._vertex_count += len(part.shape.vertices)
        row[COVER_ERROR] = row[RADIUS]
        if cover is not None:
            leaves, slack = cover
            row[COVER_SPHERES], row[COVER_COUNT] = self._leaf_count, len(leaves)
            row[COVER_ERROR] = slack
            self._leaves.append(leaves)
            self._leaf_count += len(leaves)
        return row

    def vertices(self) -> Float[Array, "3 v"]:
        """Return all hulls' vertices, (3, v)."""
        return np.ascontiguousarray(np.concatenate([np.zeros((0, 3)), *self._vertices]).T)

    def leaves(self) -> Float[Array, "l 4"]:
        """Return all leaves, (l, 4)."""
        return np.ascontiguousarray(np.concatenate([np.zeros((0, 4)), *self._leaves]))


def _core(shape: Shape) -> tuple[int, Array, Array, float, float]:
    """Return kind, half extents, centre, bounding radius and margin of a shape in its own frame."""
    origin = np.zeros(3)
    if isinstance(shape, Sphere):
        return POINT, np.full(3, shape.radius), origin, shape.radius, shape.radius
    if isinstance(shape, Box):
        half = np.array(shape.size) / 2
        return BOX, half, origin, float(np.linalg.norm(half)), 0.0
    if isinstance(shape, Cylinder):
        half = np.array([shape.radius, shape.radius, shape.height / 2])
        return CYLINDER, half, origin, float(np.hypot(shape.radius, shape.height / 2)), 0.0
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    centre = (low + high) / 2
    return (
        HULL,
        (high - low) / 2,
        centre,
        float(np.linalg.norm(shape.vertices - centre, axis=1).max()),
        0.0,
    )


def world_box(
    rows: Float[Array, "n width"], poses: Float[Array, "n 12"]
) -> tuple[Float[Array, "n 3"], Float[Array, "n 3"]]:
    """Compute low and high corners (n, 3) of the world's boxes around parts (n, PART_COLUMNS) at
    poses (n, 12).
    """
    rotations = poses[:, :9].reshape(-1, 3, 3)
    centres = np.einsum("nij,nj->ni", rotations, rows[:, CENTRE : CENTRE + 3]) + poses[:, 9:]
    half = np.einsum("nij,nj->ni", np.abs(rotations), rows[:, SIZE : SIZE + 3])
    return centres - half, centres + half
