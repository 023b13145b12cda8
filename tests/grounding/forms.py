"""Forms and situations made by hand."""

from __future__ import annotations

import numpy as np

from grounding.body_geometry import BodyGeometry, geometry_of
from grounding.relation_scene import Placed, Region, RelationScene
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Box, Cylinder, Part, Scene
from tests.geometric.making import body, crate, scene, table


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


TOP = 0.4
"""Metres above the ground of the table of `on_table`."""


def on_table(body: Placed, *others: Placed, height: float = np.inf) -> RelationScene:
    """A body on a solid table of 0.8 x 0.6 x 0.4 m about the origin, `height` metres free above it."""
    size, corners = np.array([0.8, 0.6, height]), np.array([[-0.4, -0.3, -0.2], [0.4, 0.3, 0.2]])
    region = Region(False, Pose((0.0, 0.0, TOP / 2)).matrix, size, corners)
    return RelationScene(at(box(0.8, 0.6, TOP), 0.0, 0.0, TOP / 2), region, body, others)


STANDS = 0.5 + CONTACT_GAP + 0.1


def with_brick(
    x: float = 0.2, y: float = 0.1, z: float = STANDS, roll: float = 0.0, *, beside: float = 0.0
) -> Scene:
    """A brick of 0.06 x 0.1 x 0.2 m on a table half a metre high, another one `beside` metres along x."""
    brick = body("brick", Box((0.06, 0.1, 0.2)), (x, y, z))
    pose = Pose.from_xyz_rpy((x, y, z), (roll, 0.0, 0.0))
    bodies = [table(), crate(), type(brick)(**{**vars(brick), "pose": pose})]
    return scene(
        *bodies, *([body("other", Box((0.06, 0.1, 0.2)), (x + beside, y, z))] if beside else [])
    )
