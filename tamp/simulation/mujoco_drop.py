"""Drop tests in MuJoCo: a model for each scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, RobotStart, Room, Scene
from tamp.simulation.drops import ENGINE_STEP_S, Contact, Drops, Item
from tamp.simulation.mujoco_world import MujocoWorld

FALLING_BODY = "falling"
"""The name of the body that falls; obstacles have numbers."""

_ROOM = Room((-50.0, 50.0), (-50.0, 50.0))
_ROBOT = RobotStart("", (0.0, 0.0, 0.0))


class MujocoDrops(Drops):
    """Drop tests in MuJoCo."""

    def __init__(self) -> None:
        self._world: MujocoWorld | None = None
        self._item: Item | None = None
        self._boxes: list[tuple[Array, Array]] = []

    def close(self) -> None:
        """Give the engine's memory back."""
        self._world = None

    def set_up(self, body: Item, obstacles: Sequence[tuple[Item, Array]]) -> None:
        """Replace the scene: a body that can fall, and obstacles that stand still at their
        T_world_obstacle (4, 4).
        """
        poses = [Pose.from_matrix(matrix) for _, matrix in obstacles]
        bodies = {
            str(number): _body(str(number), item, pose, movable=False)
            for number, ((item, _), pose) in enumerate(zip(obstacles, poses, strict=True))
        }
        bodies[FALLING_BODY] = _body(FALLING_BODY, body, Pose(), movable=True)
        scene = Scene("drop", MappingProxyType(bodies), _ROBOT, _ROOM)
        self._world, self._item = MujocoWorld(scene, dynamic=True), body
        self._boxes = [
            bounds(item.parts, pose) for (item, _), pose in zip(obstacles, poses, strict=True)
        ]

    def contacts(self, T_world_body: Array, reach: float = 0.005) -> list[Contact]:
        """Find the obstacles that are nearer to the body at this pose than `reach` metres; the
        floor is obstacle -1.
        """
        world, item = self._placed(T_world_body)
        low, high = bounds(item.parts, Pose.from_matrix(T_world_body))
        found = [Contact(-1, float(low[2]))] if low[2] < reach else []
        for number, box in enumerate(self._boxes):
            if (box[0] > high + reach).any() or (low - reach > box[1]).any():
                continue
            distance = world.body_distance(FALLING_BODY, str(number), reach)
            if distance < reach:
                found.append(Contact(number, distance))
        return found

    def drop(self, T_world_body: Array, seconds: float) -> Array:
        """Let the body go at rest; T_world_body (4, 4) afterwards. Ends early when it has come to
        rest.
        """
        world, _ = self._placed(T_world_body)
        for step in range(math.ceil(seconds / ENGINE_STEP_S)):
            world.step(ENGINE_STEP_S)
            if step % 60 == 59 and _still(world):
                break
        return world.pose(FALLING_BODY)

    def _placed(self, T_world_body: Array) -> tuple[MujocoWorld, Item]:
        if self._world is None or self._item is None:
            raise ValueError("no scene has been set up")
        self._world.place(FALLING_BODY, T_world_body)
        return self._world, self._item


def _still(world: MujocoWorld) -> bool:
    speed = world.speed(FALLING_BODY)
    return speed[0] < 1e-4 and speed[1] < 1e-3


def _body(name: str, item: Item, pose: Pose, *, movable: bool) -> Body:
    body = Body(name, item.parts, pose, movable, mass=item.mass)
    return replace(body, friction=item.friction)
