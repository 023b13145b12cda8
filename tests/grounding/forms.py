"""Forms and situations made by hand."""

from __future__ import annotations

import numpy as np

from grounding.body_geometry import BodyGeometry, geometry_of
from grounding.relation_scene import Placed
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part


def box(x: float, y: float, z: float) -> BodyGeometry:
    return geometry_of((Part(Box((x, y, z))),))


def can(radius: float, height: float) -> BodyGeometry:
    return geometry_of((Part(Cylinder(radius, height)),))


def at(form: BodyGeometry, x: float, y: float, z: float, yaw: float = 0.0) -> Placed:
    return Placed(form, Pose.from_xyz_yaw(x, y, z, yaw).matrix)


def turned(
    roll: float, pitch: float, yaw: float, position: tuple[float, float, float] = (0, 0, 0)
) -> np.ndarray:
    return Pose.from_xyz_rpy(position, (roll, pitch, yaw)).matrix
