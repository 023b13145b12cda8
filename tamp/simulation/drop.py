"""Drop tests in pybullet by the thousand: one client, shapes made once.

Measured (tests/simulation/test_drop.py): compounds give the same distances as their pieces alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Sphere
from tamp.simulation.drops import ENGINE_STEP_S, Contact, Drops, Item
from tamp.simulation.physics import HULL_PAD, load_bullet
from tamp.simulation.shapes import centre_of_mass, obj
from tamp.system.scratch import scratch_folder


class BulletDrops(Drops):
    """Drop tests in pybullet."""

    def __init__(self) -> None:
        self._bullet = load_bullet()
        self.client = self._bullet.connect(self._bullet.DIRECT)
        if self.client < 0:
            raise RuntimeError("pybullet has no more room for another client")
        self._bullet.setGravity(0.0, 0.0, -9.81, physicsClientId=self.client)
        half = [50.0, 50.0, 0.5]
        plane = self._bullet.createCollisionShape(
            self._bullet.GEOM_BOX, halfExtents=half, physicsClientId=self.client
        )  # fmt: skip
        self._floor = self._bullet.createMultiBody(
            0.0, plane, -1, [0.0, 0.0, -0.5], physicsClientId=self.client
        )
        self._shapes: dict[Item, tuple[int, Array]] = {}
        self._obstacles: list[tuple[int, Item]] = []
        self._boxes: list[tuple[Array, Array]] = []
        self._body: tuple[int, Item] | None = None

    def close(self) -> None:
        """Give the engine's memory back."""
        self._bullet.disconnect(physicsClientId=self.client)

    def set_up(self, body: Item, obstacles: Sequence[tuple[Item, Array]]) -> None:
        """Replace the scene: a body that can fall, and obstacles that stand still at their
        T_world_obstacle (4, 4).
        """
        for handle, _ in [*self._obstacles, *([self._body] if self._body else [])]:
            self._bullet.removeBody(handle, physicsClientId=self.client)
        self._obstacles = [
            (self._add(item, matrix, fixed=True), item) for item, matrix in obstacles
        ]
        self._boxes = [bounds(item.parts, Pose.from_matrix(matrix)) for item, matrix in obstacles]
        self._body = (self._add(body, np.eye(4), fixed=False), body)

    def contacts(self, T_world_body: Array, reach: float = 0.005) -> list[Contact]:
        """Find the obstacles that are nearer to the body at this pose than `reach` metres; the
        floor is obstacle -1.
        """
        handle, item = self._placed(T_world_body)
        low, high = bounds(item.parts, Pose.from_matrix(T_world_body))
        found = [Contact(-1, float(low[2]))] if low[2] < reach else []
        near = self._bullet.getAABB(handle, physicsClientId=self.client)
        low, high = np.array(near[0]) - reach, np.array(near[1]) + reach
        for number, (other, obstacle) in enumerate(self._obstacles):
            box = self._boxes[number]
            if (box[0] > high).any() or (low > box[1]).any():
                continue
            points = self._bullet.getClosestPoints(
                handle, other, reach, physicsClientId=self.client
            )
            if points:
                pads = sum(HULL_PAD for one in (item, obstacle) if _is_hull(one))
                found.append(Contact(number, min(point[8] for point in points) + pads))
        return found

    def drop(self, T_world_body: Array, seconds: float) -> Array:
        """Let the body go at rest; T_world_body (4, 4) afterwards. Ends early when it has come to
        rest.
        """
        handle, item = self._placed(T_world_body)
        bullet, client = self._bullet, self.client
        for step in range(math.ceil(seconds / ENGINE_STEP_S)):
            bullet.stepSimulation(physicsClientId=client)
            if step % 60 == 59:
                linear, angular = bullet.getBaseVelocity(handle, physicsClientId=client)
                if max(map(abs, linear)) < 1e-4 and max(map(abs, angular)) < 1e-3:
                    break
        at, turn = bullet.getBasePositionAndOrientation(handle, physicsClientId=client)
        matrix = Pose(tuple(at), tuple(turn)).matrix.copy()
        matrix[:3, 3] -= matrix[:3, :3] @ self._shapes[item][1]
        return matrix

    def _placed(self, T_world_body: Array) -> tuple[int, Item]:
        if self._body is None:
            raise ValueError("no scene has been set up")
        handle, item = self._body
        com = T_world_body[:3, :3] @ self._shapes[item][1] + T_world_body[:3, 3]
        pose = Pose.from_matrix(T_world_body)
        self._bullet.resetBasePositionAndOrientation(
            handle, com.tolist(), pose.quaternion, physicsClientId=self.client
        )  # fmt: skip
        self._bullet.resetBaseVelocity(handle, [0.0] * 3, [0.0] * 3, physicsClientId=self.client)
        return handle, item

    def _add(self, item: Item, matrix: Array, fixed: bool) -> int:
        if item not in self._shapes:
            self._shapes[item] = self._shape(item), centre_of_mass(item.parts)
        shape, centre = self._shapes[item]
        pose = Pose.from_matrix(matrix)
        handle = self._bullet.createMultiBody(
            0.0 if fixed else item.mass,
            shape,
            -1,
            pose.position,
            pose.quaternion,
            baseInertialFramePosition=[0.0] * 3 if fixed else centre.tolist(),
            physicsClientId=self.client,
        )
        self._bullet.changeDynamics(
            handle, -1, lateralFriction=item.friction, physicsClientId=self.client
        )
        return handle

    def _shape(self, item: Item) -> int:
        bullet, client = self._bullet, self.client
        keys = {
            Box: bullet.GEOM_BOX,
            Cylinder: bullet.GEOM_CYLINDER,
            Sphere: bullet.GEOM_SPHERE,
            Hull: bullet.GEOM_MESH,
        }

        arrays: dict[str, list[Any]] = {
            "shapeTypes": [],
            "radii": [],
            "lengths": [],
            "halfExtents": [],
            "fileNames": [],
        }

        with scratch_folder() as folder:  # an array of shapes takes its meshes from files only
            for number, part in enumerate(item.parts):
                shape = part.shape
                arrays["shapeTypes"].append(keys[type(shape)])
                arrays["radii"].append(
                    shape.radius if isinstance(shape, Cylinder | Sphere) else 0.0
                )
                arrays["lengths"].append(shape.height if isinstance(shape, Cylinder) else 0.0)
                arrays["halfExtents"].append(
                    [e / 2 for e in shape.size] if isinstance(shape, Box) else [0.0] * 3
                )
                arrays["fileNames"].append(
                    str(Path(folder) / f"{number}.obj") if isinstance(shape, Hull) else ""
                )

                if isinstance(shape, Hull):
                    Path(arrays["fileNames"][-1]).write_text(obj(shape))

            return bullet.createCollisionShapeArray(
                **arrays,
                meshScales=[[1.0, 1.0, 1.0]] * len(item.parts),
                collisionFramePositions=[list(part.pose.position) for part in item.parts],
                collisionFrameOrientations=[list(part.pose.quaternion) for part in item.parts],
                physicsClientId=client,
            )


def _is_hull(item: Item) -> bool:
    return isinstance(item.parts[0].shape, Hull)
