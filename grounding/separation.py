"""Separations of a body at many poses from the bodies around it: separating axes between convex
hulls, all at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from grounding.body_geometry import BodyGeometry
from grounding.relation_scene import Placed
from tamp.geometric.scene.pose import Array
from tamp.system.compilation import njit

FAR = 1.0
"""What is said where there is nothing around, metres."""

SAME_PLACE = 1e-9
"""Middles that are no farther apart have no line between them, metres."""


class Obstacles:
    """Bodies that stand still, prepared for `separations`.

    Args:
        placed: The bodies, their matrices T_frame_body in any one frame whose z points up.

    Attributes:
        count: How many, m.
        low: The least coordinates, shape (m, 3).
        high: The largest coordinates, shape (m, 3).
        axes: Their own ones, shape (m, 3, 3).
        spans: Least and largest coordinates along these, shape (m, 3, 2).
        points: Outermost vertices, the last one repeated, shape (m, v, 3),
        sizes: and how many each has, shape (m,).
    """

    def __init__(self, placed: Sequence[Placed]) -> None:
        self.count = len(placed)
        if not placed:
            return
        matrices = np.array([item.matrix for item in placed])
        self.sizes = np.array([len(item.form.outer) for item in placed])
        own = np.zeros((len(placed), self.sizes.max(), 3))
        for row, item in enumerate(placed):
            own[row, : len(item.form.outer)] = item.form.outer
            own[row, len(item.form.outer) :] = item.form.outer[-1]
        self.axes = np.ascontiguousarray(matrices[:, :3, :3].transpose(0, 2, 1))
        self.points = own @ self.axes + matrices[:, None, :3, 3]
        self.low, self.high = self.points.min(axis=1), self.points.max(axis=1)
        # along a body's own axes its own box is moved by where its origin is
        origin = self.axes @ matrices[:, :3, 3, None]  # (m, 3, 1)
        self.spans = origin + np.array([item.form.outer_box for item in placed]).transpose(0, 2, 1)


def separations(form: BodyGeometry, poses: Array, obstacles: Obstacles) -> Array:
    """Compute signed distances along the best of some axes, metres: a lower bound of the distance,
    negative when hulls overlap.

    The axes are both bodies' own, the vertical, and the line between the centres: exact for boxes
    that stand upright and for cylinders beside each other, a little pessimistic at corners.

    Args:
        form: The body that is placed.
        poses: T_frame_body, shape (n, 4, 4).
        obstacles: The m bodies around, in the same frame.

    Returns:
        Shape (n, m).
    """
    count = len(poses)
    if not obstacles.count:
        return np.zeros((count, 0))
    out = np.empty((count, obstacles.count))
    placed = (
        obstacles.points,
        obstacles.sizes,
        obstacles.axes,
        obstacles.spans,
        obstacles.low,
        obstacles.high,
    )
    # The kernel takes no read-only arrays, which the matrices of poses are.
    poses = np.require(poses, float, ["C", "W"])
    _separate(form.outer, form.outer_box, poses, *placed, out)
    return out


@njit(
    "void(float64[:,::1], float64[:,::1], float64[:,:,::1], float64[:,:,::1], "
    "int64[::1], float64[:,:,::1], float64[:,:,:], float64[:,::1], float64[:,::1], float64[:,::1])",
    cache=True,
)
def _separate(own, box, poses, others, sizes, axes, spans, low, high, out):
    """Compute `separations` into `out` (n, m): own (v, 3) and box (2, 3) in the body's frame, the
    rest of `Obstacles`.
    """
    points = np.empty_like(own)
    for n in range(len(poses)):
        pose = poses[n]
        least, most = np.full(3, np.inf), np.full(3, -np.inf)
        for v in range(len(own)):
            for k in range(3):
                at = (
                    pose[k, 0] * own[v, 0]
                    + pose[k, 1] * own[v, 1]
                    + pose[k, 2] * own[v, 2]
                    + pose[k, 3]
                )
                points[v, k] = at
                least[k], most[k] = min(least[k], at), max(most[k], at)

        for m in range(len(sizes)):
            best = max(least[2] - high[m, 2], low[m, 2] - most[2])  # the vertical
            for k in range(3):  # the obstacle's axes
                x, y, z = axes[m, k]
                first, last = np.inf, -np.inf
                for v in range(len(own)):
                    at = x * points[v, 0] + y * points[v, 1] + z * points[v, 2]
                    first, last = min(first, at), max(last, at)
                best = max(best, first - spans[m, k, 1], spans[m, k, 0] - last)

            for k in range(3):  # the body's axes
                x, y, z = pose[0, k], pose[1, k], pose[2, k]
                first, last = np.inf, -np.inf
                for v in range(sizes[m]):
                    at = x * others[m, v, 0] + y * others[m, v, 1] + z * others[m, v, 2]
                    first, last = min(first, at), max(last, at)
                origin = x * pose[0, 3] + y * pose[1, 3] + z * pose[2, 3]
                best = max(best, origin + box[0, k] - last, first - origin - box[1, k])

            # the horizontal line between the centres
            x = (least[0] + most[0] - low[m, 0] - high[m, 0]) / 2
            y = (least[1] + most[1] - low[m, 1] - high[m, 1]) / 2
            length = math.sqrt(x * x + y * y)
            if length > SAME_PLACE:
                x, y = x / length, y / length
                first, last = np.inf, -np.inf
                for v in range(len(own)):
                    first = min(first, x * points[v, 0] + y * points[v, 1])
                for v in range(sizes[m]):
                    last = max(last, x * others[m, v, 0] + y * others[m, v, 1])
                best = max(best, first - last)
            out[n, m] = best
