"""Antipodal grasps at random: tool poses whose closing line meets the surface squarely twice."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.stability.ray_crossings import ConvexUnion
from tamp.geometric.streams.grasp_directions import (
    DIRECTION_STEP_RAD,
    MAX_UPWARD_PART,
    across,
    angles,
    cross,
)
from tamp.geometric.streams.hand_fit import FRICTION_CONE_RAD

if TYPE_CHECKING:
    from jaxtyping import Float

FINGERTIP_M = 0.009
"""Metres by which the finger tips reach beyond the tool's origin."""

GRASP_DEPTHS_M = (0.006, 0.030)
"""Least and largest depth of the tool's origin in the body along the approach: finger tips 1.5 to 4
cm deep, metres."""

STEEP_UPWARD_PART = 0.7
"""Random closing axes whose upward part is larger than this"""

KEEP_STEEP = 0.1
"""are kept with this probability."""

POINTS_PER_BATCH = 64
"""Surface points drawn at once."""


def at_depth(
    solid: ConvexUnion, point: Float[Array, " 3"], approach: Float[Array, " 3"], depth: float
) -> Float[Array, " 3"]:
    """Move the point to `depth` in the body along the approach; tips stay in a thin one."""
    low, high = solid.extent(approach)
    surface = solid.solid_at(point, approach)
    start = point @ approach + surface.start if surface is not None else low
    thickness = (point @ approach + surface.end if surface is not None else high) - start
    inside = min(depth, thickness - FINGERTIP_M - 0.003)
    return point + (start + inside - point @ approach) * approach


def antipodal_grasps(
    solid: ConvexUnion, up: Float[Array, " 3"], widest: float, rng: np.random.Generator
) -> Iterator[Float[Array, "4 4"] | None]:
    """Draw tool poses whose closing line meets the surface squarely on both sides; None for a draw
    without.
    """
    while True:
        points, normals = solid.surface_points(rng, POINTS_PER_BATCH)
        tilts = rng.normal(0.0, math.radians(4), (POINTS_PER_BATCH, 3))
        closings = tilts - (np.einsum("ij,ij->i", tilts, normals) + 1.0)[:, None] * normals
        closings /= np.linalg.norm(closings, axis=1, keepdims=True)
        _, ends, _, planes = solid.crossings(points, closings)
        cosines = np.einsum("ipj,ij->ip", solid.normals(planes), closings)
        square = cosines >= math.cos(FRICTION_CONE_RAD)
        narrow = np.any((ends > 0.002) & (ends <= widest) & square, axis=1)
        narrow &= (np.abs(closings @ up) < STEEP_UPWARD_PART) | (
            rng.random(POINTS_PER_BATCH) < KEEP_STEEP
        )
        # Far from under or over the centre of mass the body would turn in the hand.
        aside = solid.centre - points
        for along in (closings, np.broadcast_to(up, closings.shape)):
            aside = aside - np.einsum("ij,ij->i", aside, along)[:, None] * along

        near = rng.random(POINTS_PER_BATCH) < np.exp(-np.sum(aside**2, axis=1) / 0.03**2) + 0.1
        yield from (
            _around(solid, points[i], closings[i], up, widest, rng)
            if narrow[i] and near[i]
            else None
            for i in range(POINTS_PER_BATCH)
        )


def _around(
    solid: ConvexUnion,
    point: Array,
    closing: Array,
    up: Array,
    widest: float,
    rng: np.random.Generator,
) -> Array | None:
    """Draw a tool pose with a random approach about the line through a surface point."""
    width = solid.solid_at(point, closing)
    if width is None or width.start < -0.002 or width.end > widest:
        return None
    least = math.cos(FRICTION_CONE_RAD)
    if -(width.start_normal @ closing) < least or width.end_normal @ closing < least:
        return None
    angle = angles(DIRECTION_STEP_RAD)[rng.integers(len(angles(DIRECTION_STEP_RAD)))]
    first, second = across(closing, up)
    approach = math.cos(angle) * first + math.sin(angle) * second
    if approach @ up > MAX_UPWARD_PART and rng.random() > 0.15:
        return None
    middle = point + closing * (width.start + width.end) / 2
    return tool_pose(
        closing, approach, at_depth(solid, middle, approach, rng.uniform(*GRASP_DEPTHS_M))
    )


def tool_pose(
    closing: Float[Array, " 3"], approach: Float[Array, " 3"], origin: Float[Array, " 3"]
) -> Float[Array, "4 4"]:
    """Build T_body_tool (4, 4): y along the closing axis, z along the approach."""
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = cross(closing, approach), closing, approach, origin
    return T
