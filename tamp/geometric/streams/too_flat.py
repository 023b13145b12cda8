"""Bodies that lie too flat: wide all around, so that a finger would have to get under them, into
what they lie on.
"""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import LEVEL_COSINE, Box, Cylinder
from tamp.geometric.stability.hulls import part_mesh
from tamp.geometric.stability.placement import WIDER_M
from tamp.geometric.stability.slices import cut, distances
from tamp.geometric.streams.hand_fit import FRICTION_CONE_RAD
from tamp.stream import Rejection, RejectionKind

FINGER_THICKNESS_M = 0.002
"""A finger is thicker than this, metres: where its support is nearer, it gets not under a body."""

SUPPORT_MARGIN_M = 0.02
"""So far around the body the support must reach for that, metres."""


def too_flat(context: Context, body: str, pose: Pose) -> Rejection | None:
    """Reject a box or a can that lies flat here and has no grasp, with the body beneath it; None
    unless that is proven.

    Its sides are farther apart than the hand opens, so one finger would hold its underside; and all
    of that, and what is around, lies on one convex part of a fixed body.
    """
    shape = context.scene.bodies[body]
    if context.robot.suction is not None:  # it needs no finger beneath
        return None
    if len(shape.parts) != 1 or _is_narrow(shape.parts[0].shape, context.robot.opening):
        return None

    part = shape.parts[0]
    width = _width(part.shape, pose.rotation[2] @ part.pose.rotation)
    if width is None or width <= context.robot.opening + WIDER_M:
        return None

    low, high = bounds(shape.parts, pose)
    if high[2] - low[2] > context.robot.opening:  # there is no grasp of it at all, which others say
        return None

    corners = _underside(pose @ part.pose, part.shape)
    least, most, under = (
        corners.min(axis=0),
        corners.max(axis=0),
        float(low[2]) - FINGER_THICKNESS_M,
    )
    parts, lows, highs = context.fixed_parts
    around = (lows[:, 2] < under) & (under < highs[:, 2])
    around &= (lows[:, :2] < least).all(axis=1) & (most < highs[:, :2]).all(axis=1)
    for index in np.flatnonzero(around):
        name, piece, where = parts[index]
        vertices, triangles = part_mesh(piece)
        below = cut(where.apply(vertices), triangles, under)
        if below is not None and (distances(corners, below) <= 0.0).all():
            tall = f"{1000 * (high[2] - low[2]):.0f} mm tall, {100 * width:.0f} cm wide"
            what = f"too flat to be grasped ({tall}): no finger gets between it and {name}"
            return Rejection(what, kind=RejectionKind.NO_GRASP, bodies=(name,))

    return None


def _is_narrow(shape: object, opening: float) -> bool:
    """Check whether the hand gets around it whichever side is down; most bodies are so."""
    if isinstance(shape, Box):
        return sum(size <= opening for size in shape.size) >= 2
    return (
        not isinstance(shape, Cylinder) or 2 * shape.radius * math.cos(FRICTION_CONE_RAD) <= opening
    )


def _width(shape: object, up: Array) -> float | None:
    """Compute the least distance, metres, of contacts on two sides of a box or can that lies flat;
    `up` (3,) in its frame.
    """
    if isinstance(shape, Box):
        level = [
            size
            for size, part in zip(shape.size, up.tolist(), strict=True)
            if abs(part) < LEVEL_COSINE
        ]
        return min(level) if len(level) == 2 else None
    if isinstance(shape, Cylinder) and abs(float(up[2])) >= LEVEL_COSINE:
        return 2 * shape.radius * math.cos(FRICTION_CONE_RAD)
    return None


def _underside(placed: Pose, shape: object) -> Array:
    """Return corners (n, 2) of a rectangle around the body as seen from above, grown by
    SUPPORT_MARGIN_M.
    """
    size = np.array(shape.size if isinstance(shape, Box) else (0.0, 0.0, 0.0))
    if isinstance(shape, Cylinder):
        size = np.array((2 * shape.radius, 2 * shape.radius, shape.height))
    half = size / 2 + SUPPORT_MARGIN_M
    signs = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    return placed.apply(signs * half)[:, :2]
