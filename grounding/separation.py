"""How far a body at many poses is from the bodies around it: separating axes between convex hulls, all at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grounding.form import Form
from grounding.situation import Placed
from tamp.world.pose import Array

FAR = 1.0
"""What is said where there is nothing around, metres."""


class Obstacles:
    """Bodies that stand still, prepared for `separations`.

    Args:
        placed: The bodies, their matrices T_frame_body in any one frame whose z points up.

    Attributes:
        count: How many, m.
        low: The least coordinates, shape (m, 3).
        high: The largest coordinates, shape (m, 3).
    """

    def __init__(self, placed: Sequence[Placed]) -> None:
        self.count = len(placed)
        if not placed:
            return
        matrices = np.array([item.matrix for item in placed])
        longest = max(len(item.form.outer) for item in placed)
        rows = np.arange(longest)
        own = np.stack([item.form.outer[np.minimum(rows, len(item.form.outer) - 1)] for item in placed])  # (m, v, 3)
        self.axes = matrices[:, :3, :3].transpose(0, 2, 1).reshape(-1, 3)  # (3 m, 3)
        points = own @ matrices[:, :3, :3].transpose(0, 2, 1) + matrices[:, None, :3, 3]
        self.points = np.ascontiguousarray(points.transpose(1, 0, 2))  # (v, m, 3)
        self.low, self.high = self.points.min(axis=0), self.points.max(axis=0)
        self.centres = (self.low + self.high) / 2
        # along a body's own axes its own box is moved by where its origin is
        origin = (self.axes.reshape(-1, 3, 3) @ matrices[:, :3, 3, None])[:, :, 0]
        boxes = np.array([item.form.outer_box for item in placed])
        self.along_low, self.along_high = (origin + boxes[:, 0]).ravel(), (origin + boxes[:, 1]).ravel()  # (3 m,)


def separations(form: Form, poses: Array, obstacles: Obstacles) -> Array:
    """Signed distances along the best of some axes, metres: a lower bound of the distance, negative when hulls overlap.

    The axes are both bodies' own, the vertical, and the line between the centres: exact for boxes that stand upright
    and for cylinders beside each other, a little pessimistic at corners.

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
    rotations, positions = poses[:, :3, :3], poses[:, :3, 3]
    points = (form.outer @ rotations.reshape(-1, 3).T).reshape(-1, count, 3) + positions  # (v, n, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    # the vertical
    best = np.maximum(low[:, 2:] - obstacles.high[:, 2], obstacles.low[:, 2] - high[:, 2:])
    # the obstacles' axes
    along = (points.reshape(-1, 3) @ obstacles.axes.T).reshape(len(points), -1)  # (v, n 3 m)
    own_low, own_high = along.min(axis=0).reshape(count, -1), along.max(axis=0).reshape(count, -1)
    gaps = np.maximum(own_low - obstacles.along_high, obstacles.along_low - own_high)
    best = np.maximum(best, gaps.reshape(count, obstacles.count, 3).max(axis=2))
    # the body's axes
    axes = rotations.transpose(0, 2, 1)
    along = (obstacles.points.reshape(-1, 3) @ axes.reshape(-1, 3).T).reshape(len(obstacles.points), -1)  # (v, m 3 n)
    other_low, other_high = along.min(axis=0).reshape(-1, 3 * count), along.max(axis=0).reshape(-1, 3 * count)
    origin = (axes @ positions[:, :, None])[:, :, 0]
    own_low, own_high = (origin + form.outer_box[0]).ravel(), (origin + form.outer_box[1]).ravel()
    gaps = np.maximum(own_low - other_high, other_low - own_high)
    best = np.maximum(best, gaps.reshape(obstacles.count, count, 3).max(axis=2).T)
    # the horizontal line between the centres
    line = ((low + high) / 2)[:, None, :2] - obstacles.centres[:, :2]  # (n, m, 2)
    x, y = line[:, :, 0], line[:, :, 1]
    length = np.maximum(np.sqrt(x * x + y * y), 1e-9)
    x, y = x / length, y / length
    own = (points[:, :, :1] * x + points[:, :, 1:2] * y).min(axis=0)
    other = (obstacles.points[:, None, :, 0] * x + obstacles.points[:, None, :, 1] * y).max(axis=0)
    return np.maximum(best, own - other)
