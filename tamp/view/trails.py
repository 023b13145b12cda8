"""Trails in pictures: the paths of the hand and the base, drawn as lines that grow with time."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.robot.kinematics import ArmsKinematics
from tamp.geometric.scene.pose import Array
from tamp.view.mesh import Mesh, unit
from tamp.view.rasterizer import Triangles, triangles
from tamp.view.timeline import Timeline, holding, tool_path

EMPTY_COLOUR, FULL_COLOUR, DRIVE_COLOUR = (
    (0.2, 0.45, 0.85, 1.0),
    (0.95, 0.45, 0.1, 1.0),
    (0.3, 0.3, 0.35, 1.0),
)
"""Of the hand's path, empty and with a body in it, and of the base's."""

TRAIL_RADIUS_M = 0.006
"""Half the thickness of a path's line, metres."""

POINT_SPACING_M = 0.02
"""A path's line leaves out points that are nearer to each other, metres."""


@dataclass(frozen=True, eq=False)
class Trail:
    """The line of a path, and when each of its triangles is passed, shape (n,), increasing."""

    line: Triangles
    passed: Array

    def until(self, time: float) -> Triangles:
        """Return the triangles that were passed by then."""
        count = int(np.searchsorted(self.passed, time, side="right"))
        return Triangles(
            self.line.corners[:count], self.line.normals[:count], self.line.colours[:count]
        )


def trails(timeline: Timeline, kinematics: ArmsKinematics) -> list[Trail]:
    """Make the trails of the hands, empty and with a body in them, and of the base."""
    lines: list[tuple[Array, NDArray[np.bool_], tuple[float, float, float, float]]] = []
    for arm in range(len(timeline.robot.arms)):
        full = np.array([*holding(timeline, arm), False])
        tool = tool_path(timeline, kinematics, arm)
        lines += [(tool, ~full, EMPTY_COLOUR), (tool, full, FULL_COLOUR)]
    base = np.column_stack([timeline.rows[:, :2], np.full(len(timeline.rows), 0.01)])
    lines.append((base, np.full(len(base), True), DRIVE_COLOUR))
    drawn = [_trail(points, timeline.times, shown, colour) for points, shown, colour in lines]
    return [trail for trail in drawn if len(trail.passed)]


def _trail(
    points: Array, times: Array, shown: NDArray[np.bool_], colour: tuple[float, float, float, float]
) -> Trail:
    """Make three-sided rods along the stretches of a polyline that are shown."""
    kept = [0]
    for i in range(1, len(points)):
        if (
            np.linalg.norm(points[i] - points[kept[-1]]) >= POINT_SPACING_M
            or shown[i] != shown[kept[-1]]
        ):
            kept.append(i)

    ends = np.array([(a, b) for a, b in itertools.pairwise(kept) if shown[a]], dtype=int).reshape(
        -1, 2
    )
    starts, stops = points[ends[:, 0]], points[ends[:, 1]]
    along = stops - starts
    steep = np.abs(along[:, 2]) > 0.9 * np.linalg.norm(along, axis=1)
    side = unit(np.cross(along, np.where(steep[:, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])))
    up = unit(np.cross(side, along))
    turns = np.array([0.5, 2.6, 4.7])[:, None, None]
    ring = TRAIL_RADIUS_M * (np.cos(turns) * side + np.sin(turns) * up)
    vertices = np.concatenate([starts + ring, stops + ring]).transpose(1, 0, 2).reshape(-1, 3)
    rod = [(i, j, 3 + j) for i, j in ((0, 1), (1, 2), (2, 0))] + [
        (i, 3 + j, 3 + i) for i, j in ((0, 1), (1, 2), (2, 0))
    ]
    faces = (6 * np.arange(len(ends))[:, None, None] + np.array(rod)).reshape(-1, 3)
    return Trail(triangles(Mesh(vertices, faces, colour)), np.repeat(times[ends[:, 1]], len(rod)))
