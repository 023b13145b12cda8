"""Reeds-Shepp curves, the shortest ways of a car, sampled as it drives them.

OMPL says how long a curve is and where the car is after a distance, not where it reverses or steers
otherwise. So the piece on which it is is followed as far as it goes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tamp.geometric.motion.path import nearest
from tamp.geometric.motion.sampling_based import PlaneSpace, shortest_curve
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

SHORTEST_CURVE_M = 1e-9
"""Metres: ends nearer to each other than this are one."""

KIND_STEP_M = 1e-5
"""Metres of a curve over which it is looked at whether the car drives forwards, and where it turns;
the places where that changes are found more exactly."""

SAME_POSE = 1e-7
"""Metres or radians that two computations of a pose on a curve may differ by."""

MOST_PIECES = 12
"""Arcs and straight lines of one curve; a Reeds-Shepp curve has five."""


@dataclass(frozen=True)
class _CurvePiece:
    """An arc or a straight line of a car's way.

    Attributes:
        x, y, yaw: Where it begins.
        radius: Of an arc, metres.
        direction: 1.0 forwards, -1.0 backwards.
        side: To which the yaw turns: 1 to the left, -1 to the right, 0 on a straight line.
    """

    x: float
    y: float
    yaw: float
    radius: float
    direction: float
    side: int

    @classmethod
    def through(cls, here: Array, next_to_it: Array, radius: float) -> _CurvePiece:
        """Return the one that leads from a pose to another, KIND_STEP_M away."""
        x, y, yaw = here.tolist()
        way = next_to_it - here
        turned = math.remainder(way[2], math.tau)
        forwards = way[0] * math.cos(yaw) + way[1] * math.sin(yaw) > 0.0
        side = round(turned * radius / KIND_STEP_M)
        return cls(x, y, yaw, radius, 1.0 if forwards else -1.0, side)

    def _along(self, distance: Any, sin: Any, cos: Any) -> tuple[Any, Any, Any]:
        """Compute x, y and yaw after a distance, of numbers by math's functions, of arrays by
        numpy's.
        """
        yaw = self.yaw + self.side * distance / self.radius
        if self.side == 0:
            ahead = self.direction * distance
            return self.x + ahead * math.cos(self.yaw), self.y + ahead * math.sin(self.yaw), yaw
        bend = self.direction * self.radius / self.side
        x = self.x + bend * (sin(yaw) - math.sin(self.yaw))
        y = self.y - bend * (cos(yaw) - math.cos(self.yaw))
        return x, y, yaw

    def poses(self, distance: Float[Array, " n"]) -> Float[Array, "n 3"]:
        """Compute x, y (metres) and yaw (radians) at distances from its beginning, metres."""
        return np.column_stack(self._along(distance, np.sin, np.cos))

    def passes(self, distance: float, pose: Float[Array, " 3"]) -> bool:
        """Check whether it is at a pose, x, y and yaw modulo a turn, after a distance, metres."""
        x, y, yaw = self._along(distance, math.sin, math.cos)
        other_x, other_y, other_yaw = pose.tolist()
        turn = math.remainder(yaw - other_yaw, math.tau)
        return max(abs(x - other_x), abs(y - other_y), abs(turn)) < SAME_POSE


def curve(
    plane: PlaneSpace, start: Float[Array, " 3"], end: Float[Array, " 3"], step: float
) -> Float[Array, "n 3"]:
    """Sample the shortest Reeds-Shepp curve of `plane`, at most `step` metres apart, where the car
    reverses and where it steers otherwise; shape (n, 3).

    The ends are exactly `start` and `end`, the yaws between them go on from the start's.
    """
    length, at = shortest_curve(plane, start, end)
    if plane.turning_radius is None or length < SHORTEST_CURVE_M:
        return np.array([start, end], dtype=float)

    rows, done = [np.array([start], dtype=float)], 0.0
    while length - done > KIND_STEP_M and len(rows) <= MOST_PIECES:
        piece = _CurvePiece.through(
            nearest(rows[-1][-1], at(done), (2,)), at(done + KIND_STEP_M), plane.turning_radius
        )

        low, high = done, length
        if piece.passes(length - done, at(length)):
            low = length
        while high - low > KIND_STEP_M / 10:
            middle = (low + high) / 2
            if piece.passes(middle - done, at(middle)):
                low = middle
            else:
                high = middle

        count = max(1, math.ceil((high - done) / step))
        rows.append(piece.poses(np.linspace(0.0, low - done, count + 1)[1:]))
        rows[-1][-1] = nearest(rows[-1][-1], at(high), (2,))
        done = high

    more = np.linspace(done, length, max(1, math.ceil((length - done) / step)) + 1)[1:]
    rows += [np.array([at(distance)]) for distance in more if length - done > KIND_STEP_M]
    return np.array([*np.concatenate(rows)[:-1], end], dtype=float)
