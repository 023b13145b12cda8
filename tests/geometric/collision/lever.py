"""A robot of two balls for the kernels of edges: one on the base, one on a lever that turns on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tamp.geometric.collision.tables import (
    FRAME,
    ON_FLOOR,
    PART_COLUMNS,
    TableRows,
    Tables,
    pose_rows,
)
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part, Sphere

ROOM_M = 2.0
"""Half the side of the room, metres."""


def tables(
    obstacles: Sequence[tuple[float, float, float]] = (), pairs: bool = False, floor: bool = False
) -> Tables:
    """Balls of 0.1 m: part 0 at the base's centre, part 1 a metre ahead at joint 0, both 0.5 m high.

    Args:
        obstacles: Where cubes of 0.2 m have their middles, metres.
        pairs: Whether the balls are checked against each other.
        floor: Whether they may touch the floor.
    """
    rows = TableRows()
    parts = np.array([rows.row(Part(Sphere(0.1))) for _ in range(2)])
    parts[1, FRAME], parts[:, ON_FLOOR] = 1, float(floor)
    cubes = np.array([rows.row(Part(Box((0.2, 0.2, 0.2)))) for _ in obstacles])
    at = pose_rows(np.array([Pose(place).matrix for place in obstacles]).reshape(-1, 4, 4))
    cubes = cubes.reshape(-1, PART_COLUMNS)
    if len(at):
        cubes[:, 16:19], cubes[:, 19:22] = at[:, 9:] - 0.1, at[:, 9:] + 0.1
    height, ahead = Pose((0.0, 0.0, 0.5)).matrix, Pose((1.0, 0.0, 0.5)).matrix
    joint = np.append(pose_rows(np.eye(4)[None]), 0.0)[None]
    return Tables(
        np.array([-ROOM_M, ROOM_M, -ROOM_M, ROOM_M]), joint, rows.vertices(), rows.leaves(), parts,
        pose_rows(np.stack([height, ahead])), np.array([[0.0, 1.0]] if pairs else np.zeros((0, 2))),
        cubes, at,
    )  # fmt: skip


def conf(x: float, y: float, yaw: float = 0.0, lever: float = 0.0) -> Array:
    return np.array([x, y, yaw, lever])


def outcome(verdict: int) -> int:
    """FREE, HIT or UNDECIDED."""
    return verdict & 3
