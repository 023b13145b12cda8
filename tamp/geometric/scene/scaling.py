"""Bodies made larger or smaller."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Shape, Sphere, Visual


def scale_part(part: Part, factor: float) -> Part:
    """Scale a part of a body by a factor about the body's origin."""
    return Part(_scale_shape(part.shape, factor), scale_pose(part.pose, factor))


def scale_pose(pose: Pose, factor: float) -> Pose:
    """Scale the position of a pose."""
    x, y, z = pose.position
    return Pose((x * factor, y * factor, z * factor), pose.quaternion)


def scale_visual(visual: Visual, factor: float) -> Visual:
    """Scale what is drawn of a body by a factor about its origin."""
    x, y, z = visual.scale
    return replace(
        visual,
        scale=(x * factor, y * factor, z * factor),
        pose=scale_pose(visual.pose, factor),
        shapes=tuple(scale_part(part, factor) for part in visual.shapes),
    )


def _scale_shape(shape: Shape, factor: float) -> Shape:
    if isinstance(shape, Box):
        x, y, z = shape.size
        return Box((x * factor, y * factor, z * factor))
    if isinstance(shape, Cylinder):
        return Cylinder(shape.radius * factor, shape.height * factor)
    if isinstance(shape, Sphere):
        return Sphere(shape.radius * factor)
    vertices = np.array(shape.vertices) * factor
    vertices.flags.writeable = False
    return Hull(vertices, shape.faces)
