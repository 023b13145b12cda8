"""Forward kinematics of all links in many states at once, measured from the engine joint by joint.

A link's frame is the product of the exponentials of the joints before it (Lynch and Park, Modern
Robotics, 2017, 4.1). Each is measured: the engine is asked where the links are with the joint at a
few values. What that gives is tried against the engine before it is relied on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import rest_row
from tamp.geometric.scene.pose import Array
from tamp.simulation.world import World

STILL = 1e-6
"""What the frame differs by of a link that a joint does not move: engines may round to floats."""
EXACT = 1e-5
"""Metres, or parts of a rotation, by which computed frames may differ from the engine's."""
TRIALS = 6
"""States in which they are compared."""


@dataclass(frozen=True, eq=False)
class _Motion:
    """A joint's motion of links, T(q) = still + q slide + sin(q) sine + cos(q) cosine, (4, 4)."""

    still: Array
    slide: Array
    sine: Array
    cosine: Array

    def at(self, values: Array) -> Array:
        """Compute T of values (n,), radians or metres, shape (n, 4, 4)."""
        q = values[:, None, None]
        if self.slide.any():
            return self.still + q * self.slide
        return self.still + np.sin(q) * self.sine + np.cos(q) * self.cosine

    def is_like(self, other: _Motion) -> bool:
        """Tell whether it is the same motion."""
        return all(
            np.abs(mine - others).max() < STILL
            for mine, others in (
                (self.still, other.still),
                (self.slide, other.slide),
                (self.sine, other.sine),
                (self.cosine, other.cosine),
            )
        )


class LinkFrames:
    """Computes links' frames. A state is [x, y, yaw, then q1..qn, opening of each arm], metres and
    radians.

    Attributes:
        measured: Whether the measured joints give the engine's frames; else it is asked each time.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        self._world = world
        count = len(rest_row(robot)) - 3
        self._zero_frames = self._asked(np.zeros(count))
        self._motions: list[tuple[int, _Motion]] = []
        self._paths: list[tuple[int, ...]] = [() for _ in self._zero_frames]
        for joint in range(count):
            self._measure(joint, count)
        self.measured = self._agrees(robot)

    def __call__(self, rows: Array) -> Array:
        """Compute the links' frames in states (n, 4 + joints), shape (links, n, 4, 4)."""
        return self._computed(rows) if self.measured else self.engines(rows)

    def engines(self, rows: Array) -> Array:
        """Ask the engine for the same, state by state."""
        asked = []
        for row in rows:
            self._world.set_state(row)
            asked.append(self._world.link_frames())
        stacked = np.stack(asked, axis=1)
        return matrices(stacked.reshape(-1, 7)).reshape(*stacked.shape[:2], 4, 4)

    def _asked(self, values: Array) -> Array:
        """Ask the engine for the frames with the base at the origin, shape (links, 4, 4)."""
        return self.engines(np.array([[0.0, 0.0, 0.0, *values]]))[:, 0]

    def _measure(self, joint: int, joints: int) -> None:
        """Measure how a joint moves each link; links that it moves alike share a motion."""
        unit = np.eye(joints)[joint]
        inverse = np.linalg.inv(self._zero_frames)
        one, quarter, half = (
            self._asked(value * unit) @ inverse for value in (1.0, math.pi / 2, math.pi)
        )
        none = np.zeros((4, 4))
        found: list[int] = []

        for link in range(len(self._zero_frames)):
            if np.abs(one[link] - np.eye(4)).max() < STILL:
                continue
            if np.abs(one[link, :3, :3] - np.eye(3)).max() < STILL:
                motion = _Motion(np.eye(4), one[link] - np.eye(4), none, none)
            else:
                still = (np.eye(4) + half[link]) / 2
                motion = _Motion(still, none, quarter[link] - still, np.eye(4) - still)
            alike = (number for number in found if self._motions[number][1].is_like(motion))
            number = next(alike, len(self._motions))
            if number == len(self._motions):
                self._motions.append((joint, motion))
                found.append(number)
            self._paths[link] += (number,)

    def _computed(self, rows: Array) -> Array:
        moves = [motion.at(rows[:, 3 + joint]) for joint, motion in self._motions]
        products: dict[tuple[int, ...], Array] = {(): base_frames(rows[:, :3])}
        result = np.empty((len(self._zero_frames), len(rows), 4, 4))
        for link, path in enumerate(self._paths):
            for length in range(1, len(path) + 1):
                if path[:length] not in products:
                    before = products[path[: length - 1]]
                    products[path[:length]] = before @ moves[path[length - 1]]
            np.matmul(products[path], self._zero_frames[link], out=result[link])
        return result

    def _agrees(self, robot: Robot) -> bool:
        """Tell whether computed frames are the engine's, in states spread over the joints' span."""
        low = np.array([limit for arm in robot.arms for limit in (*arm.lower, 0.0)])
        high = np.array([limit for arm in robot.arms for limit in (*arm.upper, arm.opening)])
        trials = np.arange(1.0, TRIALS + 1)[:, None]
        shares = (trials * np.arange(1.0, 1 + len(low)) * math.sqrt(2)) % 1.0
        bases = trials * np.array([0.3, -0.2, 0.7])
        rows: Array = np.concatenate([bases, low + shares * (high - low)], axis=1)
        return bool(np.abs(self._computed(rows) - self.engines(rows)).max() < EXACT)


def base_frames(rows: Array) -> Array:
    """Compute T_world_base of rows x, y, yaw, shape (n, 4, 4)."""
    result = np.tile(np.eye(4), (len(rows), 1, 1))
    cosine, sine = np.cos(rows[:, 2]), np.sin(rows[:, 2])
    result[:, 0, 0] = result[:, 1, 1] = cosine
    result[:, 1, 0], result[:, 0, 1] = sine, -sine
    result[:, :2, 3] = rows[:, :2]
    return result


def matrices(frames: Array) -> Array:
    """Compute homogeneous matrices (n, 4, 4) of positions and quaternions xyzw, shape (n, 7)."""
    x, y, z, w = frames[:, 3:].T
    result = np.zeros((len(frames), 4, 4))
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    for row, columns in enumerate(rows):
        for column, values in enumerate(columns):
            result[:, row, column] = values
    result[:, :3, 3] = frames[:, :3]
    result[:, 3, 3] = 1.0
    return result
