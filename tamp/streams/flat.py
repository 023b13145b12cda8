"""Bodies that lie too flat: wide all around, so that a finger would have to get under them, into what they lie on."""

from __future__ import annotations

import math

import numpy as np

from tamp.streams.context import Context
from tamp.streams.hand_fit import CONE
from tamp.streams.hulls import part_mesh
from tamp.streams.slices import cut, distances
from tamp.world.bounds import bounds
from tamp.world.pose import Array, Pose
from tamp.world.scene import Box, Cylinder

LEVEL = math.cos(math.radians(1.0))
"""Cosine of the largest tilt with which a body counts as lying flat."""

UNDER = 0.002
"""A finger is thicker than this, metres: where its support is nearer, it gets not under a body."""

BESIDE = 0.02
"""So far around the body the support must reach for that, metres."""

HALF_MILLIMETRE = 5e-4
"""What a width must exceed the hand's opening by, metres."""


def too_flat(context: Context, body: str, pose: Pose) -> str | None:
    """In words that a box or a can that lies flat here has no grasp; None unless that is proven.

    Its sides are farther apart than the hand opens, so one finger would hold its underside; and all of that, and what
    is around, lies on one convex part of a fixed body.
    """
    shape = context.scene.bodies[body]
    if len(shape.parts) != 1:
        return None
    placed = pose @ shape.parts[0].pose
    width = _width(shape.parts[0].shape, placed)
    if width is None or width <= context.robot.opening + HALF_MILLIMETRE:
        return None
    low, high = bounds(shape.parts, pose)
    if high[2] - low[2] > context.robot.opening:  # there is no grasp of it at all, which others say
        return None
    corners = _underside(placed, shape.parts[0].shape)
    for name in context.scene.fixed:
        other = context.scene.bodies[name]
        for part in other.parts:
            vertices, triangles = part_mesh(part)
            below = cut(other.pose.apply(vertices), triangles, float(low[2]) - UNDER)
            if below is not None and (distances(corners, below) <= 0.0).all():
                tall = f"{1000 * (high[2] - low[2]):.0f} mm tall, {100 * width:.0f} cm wide"
                return f"too flat to be grasped ({tall}): no finger gets between it and {name}"
    return None


def _width(shape: object, placed: Pose) -> float | None:
    """The least distance between contacts on two sides of a box or can that lies flat, metres."""
    if isinstance(shape, Box):
        up = np.abs(placed.rotation[2])
        axis = int(np.argmax(up))
        return min(size for i, size in enumerate(shape.size) if i != axis) if up[axis] >= LEVEL else None
    if isinstance(shape, Cylinder) and abs(placed.rotation[2, 2]) >= LEVEL:
        return 2 * shape.radius * math.cos(CONE)
    return None


def _underside(placed: Pose, shape: object) -> Array:
    """Corners (n, 2) of a rectangle around the body as seen from above, grown by BESIDE."""
    size = np.array(shape.size if isinstance(shape, Box) else (0.0, 0.0, 0.0))
    if isinstance(shape, Cylinder):
        size = np.array((2 * shape.radius, 2 * shape.radius, shape.height))
    half = size / 2 + BESIDE
    signs = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    return placed.apply(signs * half)[:, :2]
