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
    """

    def __init__(self, placed: Sequence[Placed]) -> None:
        self.count = len(placed)
        if not placed:
            return
        longest = max(len(item.form.outer) for item in placed)
        stack = []
        for item in placed:
            points = item.form.outer @ item.matrix[:3, :3].T + item.matrix[:3, 3]
            stack.append(np.concatenate([points, np.repeat(points[-1:], longest - len(points), axis=0)]))
        self.points = np.stack(stack)  # (m, v, 3)
        self.axes = np.stack([item.matrix[:3, :3].T for item in placed])  # (m, 3 axes, 3)
        self.centres = (self.points.min(axis=1) + self.points.max(axis=1)) / 2
        along = np.einsum("mvi,mai->mav", self.points, self.axes)
        self.low, self.high = along.min(axis=2), along.max(axis=2)  # (m, 3)
        self.bottom, self.top = self.points[:, :, 2].min(axis=1), self.points[:, :, 2].max(axis=1)


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
    points = form.outer @ rotations.transpose(0, 2, 1) + positions[:, None]  # (n, v, 3)
    low, high = points.min(axis=1), points.max(axis=1)
    # the vertical
    best = np.maximum(low[:, None, 2] - obstacles.top, obstacles.bottom - high[:, None, 2])
    # the obstacles' axes
    axes = obstacles.axes.reshape(-1, 3)
    along = points.reshape(-1, 3) @ axes.T  # (n v, m 3)
    along = along.reshape(count, -1, len(axes))
    own_low, own_high = along.min(axis=1), along.max(axis=1)
    gaps = np.maximum(own_low - obstacles.high.ravel(), obstacles.low.ravel() - own_high)
    best = np.maximum(best, gaps.reshape(count, obstacles.count, 3).max(axis=2))
    # the body's axes
    axes = rotations.transpose(0, 2, 1).reshape(-1, 3)
    along = obstacles.points.reshape(-1, 3) @ axes.T  # (m v, n 3)
    along = along.reshape(obstacles.count, -1, len(axes))
    other_low, other_high = along.min(axis=1), along.max(axis=1)  # (m, n 3)
    centre = np.einsum("nai,ni->na", rotations.transpose(0, 2, 1), positions).ravel()
    corners = form.outer_box
    own_low, own_high = centre + np.tile(corners[0], count), centre + np.tile(corners[1], count)
    gaps = np.maximum(own_low - other_high, other_low - own_high)
    best = np.maximum(best, gaps.reshape(obstacles.count, count, 3).max(axis=2).T)
    # the horizontal line between the centres
    line = ((low + high) / 2)[:, None, :2] - obstacles.centres[:, :2]  # (n, m, 2)
    line = line / np.maximum(np.linalg.norm(line, axis=2, keepdims=True), 1e-9)
    own = (points[:, :, :2] @ line.transpose(0, 2, 1)).min(axis=1)
    other = (obstacles.points[:, :, :2] @ line.transpose(1, 2, 0)).max(axis=1).T
    return np.maximum(best, own - other)
