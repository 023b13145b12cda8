"""Directions of a parallel gripper's grasps: how its fingers close and how it approaches."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body, Box, Cylinder, Sphere
from tamp.geometric.stability.ray_crossings import ConvexUnion

if TYPE_CHECKING:
    from jaxtyping import Float

DIRECTION_STEP_RAD = math.radians(15)
"""Spacing of approach directions about the closing axis."""

MAX_UPWARD_PART = 0.1
"""Approaches whose upward part is larger come from below: of use only after the body was turned
over."""

LEVEL_CLOSING = 0.3
"""A closing axis whose upward part is larger brings a finger under the body: of use where that
stands on little."""


def straight(
    axes: list[Float[Array, " 3"]], up: Float[Array, " 3"]
) -> list[tuple[Float[Array, " 3"], Float[Array, " 3"]]]:
    """List closing and approach directions from above and from the sides."""
    return [
        (axis, a)
        for axis in axes
        for a in _approaches(axis, up, math.pi / 2)
        if a @ up < MAX_UPWARD_PART
    ]


def slanted(
    axes: list[Float[Array, " 3"]], up: Float[Array, " 3"]
) -> list[tuple[Float[Array, " 3"], Float[Array, " 3"]]]:
    """List closing and approach directions 30, 45 and 60 degrees from straight down."""
    level = [axis for axis in axes if abs(axis @ up) < LEVEL_CLOSING]
    return [
        (axis, a)
        for axis in level
        for a in _approaches(axis, up, DIRECTION_STEP_RAD)
        if -0.9 < a @ up < -0.4
    ]


def closing_axes(
    body: Body, solid: ConvexUnion, up: Float[Array, " 3"], widest: float, rng: np.random.Generator
) -> list[Float[Array, " 3"]]:
    """List directions (3,) in which the fingers may close, each with both signs.

    A box's edges; for other bodies the horizontal directions in which they are narrowest, and some
    all around.
    """
    shape, R = body.parts[0].shape, body.parts[0].pose.rotation
    if len(body.parts) == 1 and isinstance(shape, Box):
        axes = [R[:, i] for i in range(3) if shape.size[i] <= widest]
    else:
        around = R[:, 2] if isinstance(shape, Cylinder) else up
        level = np.cross(around, up)
        first = (
            level / np.linalg.norm(level) if np.linalg.norm(level) > 0.1 else _perpendicular(around)
        )
        second = np.cross(around, first)

        def ring(angles: Array) -> list[Array]:
            return [math.cos(a) * first + math.sin(a) * second for a in angles]

        axes = [around, first, second]
        if abs(around @ up) > 0.9:
            axes += ring(rng.uniform(0.0, math.pi) + np.arange(4) * math.pi / 4)
        if not isinstance(shape, Cylinder | Sphere):
            fine = ring(np.arange(180) * math.pi / 180)
            widths = np.diff([solid.extent(axis) for axis in fine], axis=1).ravel()
            axes += [
                fine[i] for i in range(180) if widths[i] < min(widths[i - 1], widths[(i + 1) % 180])
            ]
    return [sign * axis for axis in axes for sign in (1.0, -1.0)]


def _approaches(closing: Array, up: Array, step: float) -> list[Array]:
    """List unit vectors (3,) perpendicular to the closing axis, `step` apart, radians, the first as
    much down as possible.
    """
    first, second = across(closing, up)
    return [math.cos(a) * first + math.sin(a) * second for a in angles(step)]


def across(
    closing: Float[Array, " 3"], up: Float[Array, " 3"]
) -> tuple[Float[Array, " 3"], Float[Array, " 3"]]:
    """Return two unit vectors (3,) perpendicular to the closing axis and each other; the first
    looks down.
    """
    down = -up + (up @ closing) * closing
    length = math.sqrt(down @ down)
    first = down / length if length > 0.1 else _perpendicular(closing)
    return first, cross(closing, first)


@cache
def angles(step: float) -> Float[Array, " n"]:
    """Return angles all around, `step` radians apart."""
    return np.arange(0.0, 2 * math.pi - 1e-9, step)


def _perpendicular(axis: Array) -> Array:
    other = np.cross(np.eye(3)[int(np.argmin(np.abs(axis)))], axis)
    return other / np.linalg.norm(other)


def cross(first: Float[Array, " 3"], second: Float[Array, " 3"]) -> Float[Array, " 3"]:
    """Compute `np.cross` of two vectors (3,), in a tenth of the time."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
