"""The judge's own table of each robot's limits, from data sheets; shared with no planner."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tamp.geometric.loading.robots import ASSETS
from tamp.geometric.robot.robot import Robot


@dataclass(frozen=True)
class MakersLimits:
    """Positions, speeds and accelerations of a robot's parts, in metres, radians and seconds.

    Attributes:
        lower, upper: The arm's joints.
        velocity, acceleration: Of base x, y and yaw, then of the arm's joints.
        finger: Speed of each finger.
        opening: The largest distance between the fingers.
        jerk: Of the arm's joints. Stated, not judged: a plan's accelerations change in steps, and
            the controller that interpolates it, every millisecond on a Panda, rounds these off.
    """

    lower: tuple[float, ...]
    upper: tuple[float, ...]
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    finger: float
    opening: float
    jerk: tuple[float, ...]


PANDA_MOBILE = MakersLimits(
    lower=(-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973),
    upper=(2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973),
    velocity=(0.6, 0.6, 1.0, 2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61),
    acceleration=(0.8, 0.8, 1.5, 15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0),
    finger=0.05,
    opening=0.08,
    jerk=(7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0),
)
"""Arm: Franka Emika, "Robot and interface specifications" of the Franka Control Interface, limits
in joint space. Hand: the data sheet of the Franka Hand (80 mm, 50 mm/s a finger). The base is our
own.
"""

MAKERS_LIMITS: Mapping[str, MakersLimits] = {"panda_mobile": PANDA_MOBILE}
"""By the robot's name."""


def limits_of(robot: Robot) -> MakersLimits:
    """Return the maker's limits of a robot; of one that has no entry, what it says of itself."""
    listed = MAKERS_LIMITS.get(robot.name) if robot.folder.parent == ASSETS else None
    return listed or MakersLimits(
        robot.lower, robot.upper, robot.velocity, robot.acceleration,
        robot.finger_speed, robot.opening, (),
    )  # fmt: skip
