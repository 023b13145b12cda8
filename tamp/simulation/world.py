"""Interface of the engines: bodies and the robot where they are put, distances, rays, time."""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Self

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import columns
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.simulation.solid import Solid

FLOOR_NAME = "floor"
"""The floor's name among bodies."""


class World(ABC):
    """The scene's bodies and its robot in an engine of their own, a context manager.

    `tamp.simulation.engines.open_world` makes one.

    Attributes:
        scene: Its bodies, at their starts.
        robot: The arm and hand of its URDF on its base; None leaves the robot out.
        dynamic: Movable bodies have mass and fall, each one piece. Otherwise nothing moves by
            itself, and each convex part is a piece of its own, which makes distances exact.
        solids: The pieces of each body, by its name.
        links: The robot's links, by their names, as `robot.links`.
        floor: The floor's piece.
    """

    scene: Scene
    robot: Robot | None
    dynamic: bool
    solids: dict[str, tuple[Solid, ...]]
    links: dict[str, Solid]
    floor: Solid

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Give the engine's memory back."""

    # Where things are

    @abstractmethod
    def pose(self, body: str) -> Array:
        """Return T_world_body, shape (4, 4)."""

    @abstractmethod
    def place(self, body: str, T_world_body: Array) -> None:
        """Put a body somewhere, at rest."""

    @abstractmethod
    def set_robot(
        self,
        base: Sequence[float] | Array,
        arm: Sequence[float] | Array,
        opening: float,
        number: int = 0,
    ) -> None:
        """Put base at x, y, yaw, the arm of a number at joint angles, its fingers at opening / 2;
        metres, radians.
        """

    def set_state(self, row: Array) -> None:
        """Put the robot in a state: x, y, yaw, then of each arm q1..qn and the opening."""
        if self.robot is not None:
            for number, where in enumerate(columns(self.robot)):
                own = row[where]
                self.set_robot(row[:3], own[:-1], float(own[-1]), number)

    @abstractmethod
    def link_frames(self) -> Array:
        """Return each link's frame, position (m) and quaternion xyzw, shape (l, 7), as `links`."""

    def link_poses(self) -> dict[str, Array]:
        """Return T_world_link (4, 4) of the links as they stand; the base's is on the floor."""
        frames = self.link_frames().tolist()
        return {
            name: Pose((x, y, z), (qx, qy, qz, qw)).matrix
            for name, (x, y, z, qx, qy, qz, qw) in zip(self.links, frames, strict=True)
        }

    # What touches what

    @abstractmethod
    def distance(self, first: Solid, second: Solid, reach: float = 0.02) -> float:
        """Compute two solids' distance, metres; negative in penetration, infinite past `reach`."""

    def body_distance(self, first: str, second: str, reach: float = 0.02) -> float:
        """Compute the distance of two bodies as that of two solids."""
        pairs = itertools.product(self.solids[first], self.solids[second])
        return min((self.distance(a, b, reach) for a, b in pairs), default=math.inf)

    @abstractmethod
    def rays(self, starts: Array, ends: Array) -> list[tuple[str | None, float]]:
        """Cast rays (n, 3), metres: the owner's name of each hit or None, and how far (0-1).

        A ray that begins inside a body, by less than 0.5 mm, meets it at once, at 0. One that
        begins deeper does so in MuJoCo, and goes out unseen in pybullet.
        """

    @abstractmethod
    def step(self, seconds: float) -> None:
        """Let time pass."""
