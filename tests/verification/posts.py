"""A room with a post that stands and a stick, for the judge's sweeps."""

from __future__ import annotations

import numpy as np

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Part, RobotStart, Room, Scene

ROBOT = ROBOTS["panda_mobile"]()
POST = Body("post", (Part(Box((0.02, 0.02, 2.0))),), Pose((2.0, 0.0, 1.0)), movable=False)
STICK = Body("stick", (Part(Box((0.02, 0.02, 0.3))),), Pose((-2.0, 0.0, 0.15)), movable=True)

ROOM = Scene(
    "s",
    {body.name: body for body in (POST, STICK)},
    RobotStart("panda_mobile", (0, 0, 0)),
    Room((-3, 3), (-3, 3)),
)


def row(x: float = 0.0, y: float = 0.0, yaw: float = 0.0, arm: Array | None = None) -> Array:
    return np.array([x, y, yaw, *(ROBOT.home if arm is None else arm), 0.04])
