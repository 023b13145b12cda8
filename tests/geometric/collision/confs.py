"""Configurations of a robot whose arm is at home."""

from __future__ import annotations

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array


def at(robot: Robot, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> Array:
    """The configuration (3 + n,) with the base at x, y (metres), yaw (radians)."""
    return np.array([x, y, yaw, *robot.home])
