"""States of a robot as rows of numbers: the base, then each arm with its fingers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import RobotStart

if TYPE_CHECKING:
    from jaxtyping import Float


def arm_of(robot: Robot, name: str | None) -> Robot:
    """Return the arm of a name; the first without one.

    Raises:
        KeyError: There is none.
    """
    named = {arm.arm: arm for arm in robot.arms}
    return robot.arms[0] if name is None else named[name]


def columns(robot: Robot) -> tuple[slice, ...]:
    """Return which numbers of a state are of each arm: a state is [x, y, yaw] of the base, then of
    each arm q1..qn and the opening of its fingers; metres and radians.
    """
    found: list[slice] = []
    first = 3
    for arm in robot.arms:
        found.append(slice(first, first + len(arm.joints) + 1))
        first = found[-1].stop
    return tuple(found)


def rest_row(robot: Robot, base: Iterable[float] = (0.0, 0.0, 0.0)) -> Float[Array, " width"]:
    """Return the state with the base at x, y, yaw, all arms at home and their fingers open."""
    return np.array([*base, *(number for arm in robot.arms for number in (*arm.home, arm.opening))])


def start_row(robot: Robot, start: RobotStart) -> Float[Array, " width"]:
    """Return the state in which a problem begins: where it says nothing, arms are at home."""
    return with_arm(robot, rest_row(robot, start.base), 0, start.arm, None)


def with_arm(
    robot: Robot,
    row: Float[Array, " width"],
    arm: int,
    joints: Iterable[float] | None,
    opening: float | None,
) -> Float[Array, " width"]:
    """Return a state that differs by where the arm of a number stands, or its fingers."""
    changed, where = row.copy(), columns(robot)[arm]
    if joints is not None:
        changed[where.start : where.stop - 1] = list(joints)
    if opening is not None:
        changed[where.stop - 1] = opening
    return changed
