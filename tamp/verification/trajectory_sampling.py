"""Sample a motion so finely that nothing can hide between two samples."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tamp.verification.execution_state import Held
from tamp.verification.makers_limits import limits_of

POINT_STEP_M = 0.005
"""Metres that any point of the robot or the held body moves between two samples, at most."""
JOINT_STEP_RAD = math.radians(0.5)
"""Radians that any joint or the base turns between two samples, at most."""
FIRST_STEP_RAD = 0.2
"""Radians that all joints together turn between first samples, so that chords tell arcs."""
STEP_SAFETY_FACTOR = 1.1
"""How much finer than the chords ask for."""
MAX_REFINEMENTS = 4
ROUGH_REACH_M = 2.0
"""Metres from any joint to any point of the robot and its load, roughly: for piece sizes only."""
MAX_PIECE_SAMPLES = 4096
"""Samples of a piece of a motion that are made at once, at most, by a rough count."""
MAX_PIECE_ROWS = 64
"""Rows of a piece, at most."""


class Sampler:
    """Samples motions of a world's robot. A state is [x, y, yaw, q1..qn, opening], m and rad."""

    def __init__(self, world: World, robot: Robot) -> None:
        self._world, self._robot = world, robot
        self._solids: list[Solid] = list(world.links.values())
        self._hand = list(world.links).index(robot.hand)
        self._T_hand_tool = robot.T_hand_tool.matrix

    def tool(self, row: Array) -> Array:
        """Compute T_world_tool in a state, by pybullet's forward kinematics, shape (4, 4)."""
        self._world.set_robot(row[:3], row[3:-1], row[-1])
        hand = self._world.link_frames()[self._hand]
        return _matrices(hand[None])[0] @ self._T_hand_tool

    def held_frames(self, frames: Array, held: Held) -> Array:
        """Compute T_world_body of the held body for frames of the links, shape (n, 4, 4)."""
        return frames[:, self._hand] @ (self._T_hand_tool @ held.T_tool_body)

    def clipped(self, rows: Array) -> Array:
        """Clip rows to no farther out of the limits than matters; being out is reported elsewhere.

        The yaw has no limits: it stays as it is.
        """
        room, robot = self._world.scene.room, limits_of(self._robot)
        low = np.array(
            [room.x[0] - 1, room.y[0] - 1, -np.inf, *(limit - 1 for limit in robot.lower), 0.0]
        )
        high = np.array(
            [
                room.x[1] + 1,
                room.y[1] + 1,
                np.inf,
                *(limit + 1 for limit in robot.upper),
                robot.opening,
            ]
        )
        return np.clip(rows, low, high)

    def pieces(self, rows: Array, times: Array) -> Iterator[tuple[Array, Array]]:
        """Yield a motion's rows and times in pieces that fit memory, however far its rows are."""
        rows = _unwound(self.clipped(rows))
        if len(rows) == 1:
            yield rows, times
            return
        change = np.abs(np.diff(rows, axis=0))
        ways = np.linalg.norm(change[:, :2], axis=1) + ROUGH_REACH_M * change[:, 2:-1].sum(axis=1)
        first, cost = 0, 0.0
        for edge, needs in enumerate((ways / POINT_STEP_M).tolist()):
            if edge > first and (
                cost + needs > MAX_PIECE_SAMPLES or edge - first >= MAX_PIECE_ROWS
            ):
                yield rows[first : edge + 1], times[first : edge + 1]
                first, cost = edge, 0.0
            cost += needs
            if needs > MAX_PIECE_SAMPLES:
                yield from _cut(
                    rows[edge : edge + 2],
                    times[edge : edge + 2],
                    math.ceil(needs / MAX_PIECE_SAMPLES),
                )
                first, cost = edge + 1, 0.0
        if first < len(rows) - 1:
            yield rows[first:], times[first:]

    def sampled(self, rows: Array, times: Array, held: Held | None) -> tuple[Array, Array, Array]:
        """Interpolate rows and times; return them and the links' frames, shape (n, links, 4, 4)."""
        if len(rows) > 1:
            turned = np.abs(np.diff(rows[:, 2:-1], axis=0)).sum(axis=1)
            rows, times = _divided(rows, times, np.ceil(turned / FIRST_STEP_RAD))
        frames = self._frames(rows)
        for _ in range(MAX_REFINEMENTS):
            change = np.abs(np.diff(rows, axis=0))
            moved = np.linalg.norm(np.diff(self._corners(frames, held), axis=0), axis=2).max(
                axis=1, initial=0.0
            )
            parts = np.maximum(
                moved / POINT_STEP_M, change[:, 2:-1].max(axis=1, initial=0.0) / JOINT_STEP_RAD
            )
            if (parts <= 1 + 1e-6).all():
                break
            rows, times = _divided(rows, times, np.ceil(parts * STEP_SAFETY_FACTOR))
            frames = self._frames(rows)
        return rows, times, frames

    def _frames(self, rows: Array) -> Array:
        """Compute the links' frames, shape (n, links, 4, 4); rigid while only the base moves."""
        first = np.ones(len(rows), dtype=bool)
        first[1:] = (rows[1:, 3:] != rows[:-1, 3:]).any(axis=1)
        asked = []
        for row in rows[first]:
            self._world.set_robot(row[:3], row[3:-1], row[-1])
            asked.append(self._world.link_frames())
        stacked = np.stack(asked)
        frames = _matrices(stacked.reshape(-1, 7)).reshape(*stacked.shape[:2], 4, 4)
        if first.all():
            return frames
        T_base_links = np.linalg.inv(frames[:, :1]) @ frames
        return _base_frames(rows[:, :3])[:, None] @ T_base_links[np.cumsum(first) - 1]

    def _corners(self, frames: Array, held: Held | None) -> Array:
        """Compute corners of boxes around the links and the held body, shape (n, corners, 3)."""
        signs = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
        at = [(frames[:, i], solid) for i, solid in enumerate(self._solids)]
        if held is not None:
            at += [
                (T_world_held, solid)
                for one in held.all
                for T_world_held in (self.held_frames(frames, one),)
                for solid in self._world.solids[one.body]
            ]
        corners = [
            (solid.centre + signs * solid.half) @ T[:, :3, :3].transpose(0, 2, 1)
            + T[:, None, :3, 3]
            for T, solid in at
        ]
        return np.concatenate(corners, axis=1)


def _divided(rows: Array, times: Array, parts: Array) -> tuple[Array, Array]:
    """Divide a polyline: its i-th edge in parts[i] equal pieces (at least one)."""
    parts = np.maximum(parts, 1).astype(int)
    positions = np.concatenate(
        [np.linspace(i, i + 1, n, endpoint=False) for i, n in enumerate(parts)] + [[len(parts)]]
    )
    index = np.arange(len(rows))
    columns = [np.interp(positions, index, column) for column in (times, *rows.T)]
    return np.column_stack(columns[1:]), columns[0]


def _unwound(rows: Array) -> Array:
    """Unwind yaws: the same motion near zero, with no more turns than make a difference.

    A base that turns on the spot is everywhere after one turn; one that moves on by less than
    POINT_STEP_M in a turn is, after as many turns as it goes steps of that length, within
    POINT_STEP_M of wherever it was.
    """
    turning = np.diff(rows[:, 2])
    moved = np.linalg.norm(np.diff(rows[:, :2], axis=0), axis=1)
    kept = math.tau * np.maximum(1.0, np.ceil(moved / POINT_STEP_M))
    turning = np.where(
        np.abs(turning) > kept, np.sign(turning) * kept + np.fmod(turning, math.tau), turning
    )
    rows = rows.copy()
    rows[:, 2] = rows[0, 2] % math.tau + np.concatenate([[0.0], np.cumsum(turning)])
    return rows


def _cut(edge: Array, times: Array, count: int) -> Iterator[tuple[Array, Array]]:
    """Cut an edge of two rows in equal pieces."""
    for piece in range(count):
        share = np.array([[piece / count], [(piece + 1) / count]])
        yield edge[0] + share * (edge[1] - edge[0]), times[0] + share[:, 0] * (times[1] - times[0])


def _base_frames(rows: Array) -> Array:
    """Compute T_world_base of rows x, y, yaw, shape (n, 4, 4)."""
    result = np.tile(np.eye(4), (len(rows), 1, 1))
    cosine, sine = np.cos(rows[:, 2]), np.sin(rows[:, 2])
    result[:, 0, 0] = result[:, 1, 1] = cosine
    result[:, 1, 0], result[:, 0, 1] = sine, -sine
    result[:, :2, 3] = rows[:, :2]
    return result


def _matrices(frames: Array) -> Array:
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
