"""The height that the hand reaches at a place, measured with the arm itself: a reason that names it
has a figure that holds.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.robot.kinematics import base_matrix
from tamp.geometric.scene.pose import Array
from tamp.geometric.streams.approach import LIFT_DISTANCE_M

if TYPE_CHECKING:
    from jaxtyping import Float

LOW_HEIGHT_M = 0.9
"""Nothing below this is too high for the arm, metres: no need to measure."""

FOOT_DISTANCES_M = np.arange(0.10, 1.0, 0.05)
"""Distances between the arm's foot and the tool that are looked at, metres."""

EXTRA_DISTANCES_M = (0.0, 0.05, 0.10)
"""How much farther than it must stand the robot is thought to stand in the measurement, metres."""

BEARING_COUNT = 16
"""Directions from which the robot is thought to come."""

HAND_PITCHES_RAD = np.radians((0.0, 15.0, 30.0, 45.0))
"""How much the hand is thought to look down: what stands on something is in the way of one that
looks up."""

HEIGHT_PRECISION_M = 0.005
"""Of the measured height, metres."""

SAME_PLACE_M = 0.05
"""Places nearer to each other than this are taken for one, metres."""


def too_high(context: Context, point: Float[Array, " 3"]) -> str | None:
    """Say that a point (3,) is higher than the hand reaches there; None where it is not."""
    x, y, z = (float(value) for value in point)
    if z < LOW_HEIGHT_M:
        return None
    reached = highest(context, x, y)
    if reached is None or z + LIFT_DISTANCE_M <= reached:
        return None
    return f"too high: the hand reaches to {reached:.2f} m here"


def highest(context: Context, x: float, y: float) -> float | None:
    """Return the height of the tool above a point that the arm gets to from where the robot can
    stand; None without such.

    The hand looks level or down by up to 45 degrees, towards the point.
    """
    key = (round(x / SAME_PLACE_M), round(y / SAME_PLACE_M))
    if key not in context.heights:
        distance = _nearest_stand(context, x, y)
        context.heights[key] = None if distance is None else _measured(context, distance)
    return context.heights[key]


def _nearest_stand(context: Context, x: float, y: float) -> float | None:
    """Find how near to the point the arm's foot gets, the robot facing it, the arm at home, among
    the fixed bodies.
    """
    if context.robot.drive == "fixed":
        T = base_matrix(np.array(context.scene.robot.base)) @ context.robot.T_base_arm.matrix
        return float(math.hypot(x - T[0, 3], y - T[1, 3]))
    room, foot = context.scene.room, float(np.linalg.norm(context.robot.T_base_arm.position[:2]))
    among = context.fixed_only(None)
    for distance in FOOT_DISTANCES_M:
        for angle in np.arange(BEARING_COUNT) * 2 * math.pi / BEARING_COUNT:
            base = np.array((x, y, 0.0)) - (distance + foot) * np.array(
                (math.cos(angle), math.sin(angle), 0.0)
            )
            base[2] = angle
            inside = room.x[0] <= base[0] <= room.x[1] and room.y[0] <= base[1] <= room.y[1]
            if inside and among.free(context.conf(base, context.home)):
                return float(distance)
    return None


def _measured(context: Context, distance: float) -> float | None:
    """Measure the greatest height of the tool so far in front of the arm's foot that has a
    solution.
    """
    foot = context.robot.T_base_arm.position
    best = None
    for pitch in HAND_PITCHES_RAD:
        approach = np.array((math.cos(pitch), 0.0, -math.sin(pitch)))
        for closing in (np.array((0.0, 1.0, 0.0)), np.cross(approach, (0.0, 1.0, 0.0))):
            for more in EXTRA_DISTANCES_M:
                T = np.eye(4)
                T[:3, 0], T[:3, 1], T[:3, 2] = np.cross(closing, approach), closing, approach
                T[:3, 3] = (foot[0] + distance + more, 0.0, foot[2])
                height = _top(context, T, best or LOW_HEIGHT_M - 0.4)
                best = height if best is None else max(best, height or best)
    return best


def _top(context: Context, T: Array, least: float) -> float | None:
    """Search the height up to which the tool has solutions above `least`, in steps that halve; None
    where not even there.
    """

    def reached(height: float) -> bool:
        T[2, 3] = height
        return len(context.ik.solve(T, enough=1)) > 0

    if not reached(least):
        return None
    step = 0.32
    while step > HEIGHT_PRECISION_M / 2:
        if reached(least + step):
            least += step
        else:
            step /= 2
    return least
