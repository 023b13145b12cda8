"""Base placement: where the arm reaches a tool pose from, by a precomputed inverse-reachability
table.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.robot_arrays import REMEDY, damaged, numbers, read_arrays
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

BROAD_SHARE = 0.1
"""The share of samples that do not follow the table, so that every base pose within reach can be
drawn.
"""

UPRIGHT = math.cos(math.radians(1.0))
"""Cosine of the angle between two feet's axes up to which they lean alike."""

FRONT_SPREAD_RAD = math.radians(25)
"""Standard deviation of the tool's bearing as seen from the arm's foot: the base mostly faces its
work.
"""


def asset(robot: Robot) -> Path:
    """Return the file of the robot's table; an arm of a body has that of the robot it is of."""
    folder = robot.folder if robot.tabled is None else robot.tabled[0]
    return folder / "reachability.npz"


def _read(file: Path) -> dict[str, Array]:
    """Read a table.

    Raises:
        InputError: It is missing or damaged.
    """
    if not file.is_file():
        raise InputError("the robot's reachability table is missing", file=file, remedy=REMEDY)
    arrays = read_arrays(file)
    table = {
        name: numbers(arrays, name, file, shape)
        for name, shape in (
            ("heights", (None,)), ("directions", (None, 3)), ("rotations", (None, 3, 3)),
            ("distances", (None,)), ("counts", (None, None, None, None)),
        )
    }  # fmt: skip
    shape = tuple(len(table[name]) for name in ("heights", "directions", "distances"))
    fits = table["counts"].shape[:3] == shape and len(table["rotations"]) == shape[1]
    rising = all(
        len(table[name]) > 1 and (np.diff(table[name]) > 0).all()
        for name in ("heights", "distances")
    )
    if not fits or not rising or (table["counts"] < 0).any():
        raise damaged(file, "its arrays do not fit together")
    return table


def reached_share(robot: Robot) -> tuple[Array, Array, Float[Array, "heights distances"]]:
    """Return heights above the floor and distances from the foot's axis, metres, and the share of
    the tool's directions in which the arm reaches there.

    Raises:
        InputError: The robot's table is missing or damaged.
    """
    table = _read(asset(robot))
    share = (table["counts"] > 0).any(axis=3).mean(axis=1)
    return table["heights"], table["distances"], share


class Reachability:
    """Draws base poses from which the arm likely reaches a tool pose.

    Whether a pose is reachable does not change when robot and tool move together in the plane, nor
    (but for joint 1's limits) when the base turns under the arm. What remains is the tool's height,
    the direction of "up" seen from the tool, the distance from the arm's foot to the tool, and the
    tool's heading relative to the line between them. The table holds, over these five numbers, how
    many comfortable IK solutions there are. After Vahrenkamp et al., "Robot placement based on
    reachability inversion" (ICRA 2013).

    An arm of a body takes the table of the robot that it is of, moved up and turned with its foot.
    Where its foot leans otherwise than that one's the table says nothing, and all draws are broad.

    Raises:
        InputError: The robot's table is missing or damaged.
    """

    def __init__(self, robot: Robot) -> None:
        table = _read(asset(robot))
        self._heights, self._directions = table["heights"], table["directions"]
        self._rotations, self._distances = table["rotations"], table["distances"]
        counts = table["counts"]
        self._headings = counts.shape[-1]
        # Far placements keep the base clear of the furniture that the object stands on: with the
        # cube of the distance two to four times as many draws are clear as by the counts alone, and
        # as many have IK.
        weights = np.where(counts > 0, counts**0.25, 0.0) * self._distances[:, None] ** 3
        self._cumulative = np.cumsum(weights.reshape(*counts.shape[:2], -1), axis=2)
        self._foot = np.array(robot.T_base_arm.position[:2])
        own = robot.T_base_arm if robot.tabled is None else robot.tabled[1]
        turned = robot.T_base_arm.rotation @ own.rotation.T
        self._upright = bool(turned[2, 2] > UPRIGHT)
        self._rise = robot.T_base_arm.position[2] - own.position[2]
        self._turn = math.atan2(turned[1, 0], turned[0, 0])

    def sample(
        self, T_world_tool: Float[Array, "4 4"], rng: np.random.Generator, count: int
    ) -> Float[Array, "count 3"]:
        """Sample base poses x, y, yaw (count, 3) in metres and radians, in random order; collisions
        are not looked at.

        Most follow the table, a tenth (all, where the table knows no placement) is spread over
        everything within reach.
        """
        step = self._heights[1] - self._heights[0]
        level = round((T_world_tool[2, 3] - self._rise - self._heights[0]) / step)
        direction = int(np.argmax(self._directions @ T_world_tool[2, :3]))

        distance, heading, bearing = self._broad(rng, count)
        covered = self._upright and 0 <= level < len(self._heights)
        if covered and self._cumulative[level, direction, -1] > 0:
            follow = rng.random(count) >= BROAD_SHARE
            drawn = self._from_table(level, direction, rng, count)
            bounded = np.clip(
                rng.normal(0.0, FRONT_SPREAD_RAD, count),
                -2.5 * FRONT_SPREAD_RAD,
                2.5 * FRONT_SPREAD_RAD,
            )
            distance, heading = (
                np.where(follow, drawn[0], distance),
                np.where(follow, drawn[1], heading),
            )
            bearing = np.where(follow, bounded, bearing)

        turn = T_world_tool[:3, :3] @ self._rotations[direction].T
        yaw_of_tool = math.atan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
        towards = yaw_of_tool - heading  # world direction from the arm's foot to the tool
        yaw = towards - bearing - self._turn

        cos, sin = np.cos(yaw), np.sin(yaw)
        foot_x, foot_y = self._foot
        x = T_world_tool[0, 3] - distance * np.cos(towards) - (cos * foot_x - sin * foot_y)
        y = T_world_tool[1, 3] - distance * np.sin(towards) - (sin * foot_x + cos * foot_y)
        return np.column_stack([x, y, (yaw + math.pi) % (2 * math.pi) - math.pi])

    def _from_table(
        self, level: int, direction: int, rng: np.random.Generator, count: int
    ) -> tuple[Array, Array]:
        """Sample distances (count,) and headings (count,), uniform within cells that are drawn by
        their weights.
        """
        cumulative = self._cumulative[level, direction]
        cell = np.searchsorted(cumulative, rng.random(count) * cumulative[-1], side="right")
        row, column = np.divmod(np.minimum(cell, len(cumulative) - 1), self._headings)
        width = self._distances[1] - self._distances[0]
        distance = self._distances[row] + width * (rng.random(count) - 0.5)
        heading = (column + rng.random(count) - 0.5) * (2 * math.pi / self._headings)
        return distance, heading

    def _broad(self, rng: np.random.Generator, count: int) -> tuple[Array, Array, Array]:
        """Sample distances, headings and bearings (count,), uniform over the disc around the tool
        and all directions.
        """
        farthest = self._distances[-1] * 1.1
        angles = rng.uniform(-math.pi, math.pi, (2, count))
        return farthest * np.sqrt(rng.random(count)), angles[0], angles[1]
