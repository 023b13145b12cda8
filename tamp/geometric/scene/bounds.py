"""The axis-aligned box around posed convex parts, exact for every shape."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere

if TYPE_CHECKING:
    from jaxtyping import Float


def bounds(parts: Iterable[Part], pose: Pose) -> tuple[Float[Array, " 3"], Float[Array, " 3"]]:
    """Compute the axis-aligned bounding box of the parts of a body at `pose`: its lowest and its
    highest corner.

    Returns:
        Two corners, each (3,), metres, in the frame that `pose` is in.
    """
    corners = [_part_bounds(part, pose.matrix @ part.pose.matrix) for part in parts]
    return np.min([low for low, _ in corners], axis=0), np.max(
        [high for _, high in corners], axis=0
    )


def _part_bounds(part: Part, matrix: Array) -> tuple[Array, Array]:
    shape, rotation, centre = part.shape, matrix[:3, :3], matrix[:3, 3]
    if isinstance(shape, Box):
        half = np.abs(rotation) @ np.array(shape.size) / 2
    elif isinstance(shape, Cylinder):
        # A disc with normal n reaches r * sqrt(1 - n_i^2) along axis i.
        axis = rotation[:, 2]
        half = np.abs(axis) * shape.height / 2 + shape.radius * np.sqrt(
            np.maximum(0.0, 1 - axis**2)
        )
    elif isinstance(shape, Sphere):
        half = np.full(3, shape.radius)
    else:
        points = shape.vertices @ rotation.T + centre
        return points.min(axis=0), points.max(axis=0)
    return centre - half, centre + half
