"""What all engines have in common: states row by row, links by name, bodies of several pieces."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tests.simulation.scenes import without_an_engine


def piece(owner: str, x: float) -> Solid:
    """A piece at x metres."""
    T = np.eye(4)
    T[0, 3] = x
    return Solid(owner, 0, 0, T, np.zeros(3), np.zeros(3))


class Line(World):
    """Pieces on a line: their distance is that of their numbers."""

    def __init__(self, robot: Robot | None = None, **bodies: Sequence[float]) -> None:
        self.robot = robot
        self.solids = {name: tuple(piece(name, x) for x in at) for name, at in bodies.items()}
        self.told: list[Any] = []

    def close(self) -> None:
        self.told.append("closed")

    def set_robot(self, base: Array, arm: Array, opening: float, number: int = 0) -> None:
        self.told.append((number, list(base), list(arm), opening))

    def link_frames(self) -> Array:
        half = math.sqrt(0.5)
        return np.array(
            [[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0], [4.0, 5.0, 6.0, 0.0, 0.0, half, half]]
        )

    def distance(self, first: Solid, second: Solid, reach: float = 0.02) -> float:
        gap = abs(first.offset[0, 3] - second.offset[0, 3])
        return gap if gap <= reach else math.inf


LINE = without_an_engine(Line)


def test_a_row_is_split_over_the_arms() -> None:
    robot = ROBOTS["two_pandas"]()
    world = LINE(robot)
    row = np.arange(19.0)  # x, y, yaw; seven joints and an opening; the same of the second arm
    world.set_state(row)
    assert world.told == [
        (0, [0.0, 1.0, 2.0], [float(n) for n in range(3, 10)], 10.0),
        (1, [0.0, 1.0, 2.0], [float(n) for n in range(11, 18)], 18.0),
    ]
    alone = LINE()
    alone.set_state(row)
    assert alone.told == []


def test_links_are_told_by_name_in_their_order() -> None:
    world = LINE()
    world.links = {"base": piece("base", 0.0), "hand": piece("hand", 0.0)}
    poses = world.link_poses()
    assert poses["base"] == pytest.approx(
        np.array([[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    )
    assert poses["hand"] == pytest.approx(
        np.array([[0, -1, 0, 4], [1, 0, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1]])
    )


def test_the_nearest_two_pieces_are_the_bodies_distance() -> None:
    world = LINE(a=(0.0, 1.0), b=(1.5, 1.01), empty=())
    assert world.body_distance("a", "b") == pytest.approx(0.01)
    assert world.body_distance("a", "b", reach=0.001) == math.inf
    assert world.body_distance("a", "empty") == math.inf


def test_a_world_is_closed_at_the_end_of_its_block() -> None:
    with LINE() as world:
        assert world.told == []
    assert world.told == ["closed"]
