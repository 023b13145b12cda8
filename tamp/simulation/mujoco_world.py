"""Rigid-body simulation in MuJoCo: bodies and the robot in an engine of their own.

Measured (benchmarks/engine_distances.py): distances are within 0.1 mm of coal's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import start_row
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.simulation.mobile_urdf import BASE_JOINTS
from tamp.simulation.mujoco_model import (
    Model,
    add_body,
    add_floor,
    add_pairs,
    body_name,
    is_link,
    link_body,
    load_mujoco,
    new_model,
    owner_of,
    pose_of,
    wxyz,
)
from tamp.simulation.solid import Solid
from tamp.simulation.world import FLOOR_NAME, World


class MujocoWorld(World):
    """The scene's bodies and its robot in a model of MuJoCo."""

    def __init__(self, scene: Scene, robot: Robot | None = None, *, dynamic: bool = False) -> None:
        self.scene, self.robot, self.dynamic = scene, robot, dynamic
        self._mujoco = load_mujoco()
        self._poses = {name: body.pose.matrix for name, body in scene.bodies.items()}
        self._build()

    def close(self) -> None:
        """Give the engine's memory back."""
        del self._model, self._data

    # Building

    def _build(self) -> None:
        """Make model and data of the scene as it is."""
        model = self._described()
        self._model: Any = model.compile(f"the problem '{self.scene.name}'")
        self._data: Any = self._mujoco.MjData(self._model)
        self._index()
        self._fresh = False
        if self.robot is not None:
            self._index_robot(self.robot)
        self._refresh()

    def _described(self) -> Model:
        """Describe the scene for MuJoCo's compiler."""
        model = new_model(self.robot)
        add_floor(model, self.scene, plane=self.dynamic)
        for body in self.scene.bodies.values():
            add_body(model, body, free=self.dynamic and body.movable, placed=not self.dynamic)
        if self.dynamic:
            add_pairs(model)
        return model

    def _index(self) -> None:
        """Note which numbers the engine gave to bodies and shapes."""
        model = self._model
        self._numbers = {name: model.body(body_name(name)).id for name in self.scene.bodies}
        self._free = {
            name: int(model.jnt_qposadr[model.body_jntadr[number]])
            for name, number in self._numbers.items()
            if model.body_jntnum[number]
        }

        names = [model.geom(number).name for number in range(model.ngeom)]
        self._owner_of = [owner_of(name) for name in names]
        self._is_link = np.array([is_link(name) for name in names], dtype=bool)
        self._geoms = {
            number: range(first, first + count)
            for number, (first, count) in enumerate(
                zip(model.body_geomadr.tolist(), model.body_geomnum.tolist(), strict=True)
            )
        }

        self.solids = {}
        for name, number in self._numbers.items():
            if name in self._free:
                self.solids[name] = (self._solid(name, number, -1),)
            else:
                pieces = range(len(self._geoms[number]))
                self.solids[name] = tuple(self._solid(name, number, piece) for piece in pieces)
        self.floor = self._floor_solid()
        self.links: dict[str, Solid] = {}

    def _floor_solid(self) -> Solid:
        number = self._model.body(FLOOR_NAME).id
        if self.dynamic:
            return Solid(FLOOR_NAME, number, -1, np.eye(4), np.zeros(3), np.full(3, np.inf))
        half = self._model.geom_size[self._geoms[number][0]].copy()
        return Solid(FLOOR_NAME, number, -1, np.eye(4), self._model.body_pos[number].copy(), half)

    def _index_robot(self, robot: Robot) -> None:
        model = self._model
        for link in robot.links:
            self.links[link.name] = self._solid(link.name, model.body(link_body(link.name)).id, -1)
        self._frames = np.array([solid.handle for solid in self.links.values()])
        arms = [[joint.name for joint in arm.joints] for arm in robot.arms]
        self._base, *self._arms = (self._places(names) for names in ([*BASE_JOINTS], *arms))
        self._driven = np.concatenate([self._base, *self._arms])
        self._fingers = [self._places([one.name for one in arm.fingers]) for arm in robot.arms]
        self.set_state(start_row(robot, self.scene.robot))

    def _places(self, joints: Sequence[str]) -> NDArray[np.intp]:
        """Return where the engine keeps the positions of joints."""
        return np.array([self._model.joint(name).qposadr[0] for name in joints], dtype=np.intp)

    def _solid(self, owner: str, number: int, piece: int) -> Solid:
        """Describe one shape of a body, or all, with the box around it in the body's frame: a point
        of a link without shapes, such as one that two joints share.
        """
        geoms = self._geoms[number] if piece < 0 else [self._geoms[number][piece]]
        corners = np.concatenate([self._corners(geom) for geom in geoms] or [np.zeros((1, 3))])
        low, high = corners.min(axis=0), corners.max(axis=0)
        offset = np.eye(4)
        return Solid(owner, number, piece, offset, (low + high) / 2, (high - low) / 2)

    def _corners(self, geom: int) -> Array:
        """Return points whose box is the shape's, in its body's frame, shape (n, 3)."""
        model = self._model
        if model.geom_dataid[geom] >= 0:
            mesh = int(model.geom_dataid[geom])
            first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
            points = model.mesh_vert[first : first + count].astype(float)
        else:
            signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
            points = model.geom_aabb[geom, :3] + signs * model.geom_aabb[geom, 3:]
        T = pose_of(model.geom_pos[geom], model.geom_quat[geom])
        return points @ T[:3, :3].T + T[:3, 3]

    # Where things are

    def _refresh(self) -> None:
        """Bring the frames up to date with what was placed."""
        if not self._fresh:
            self._mujoco.mj_kinematics(self._model, self._data)
            self._fresh = True

    def pose(self, body: str) -> Array:
        """Return T_world_body, shape (4, 4)."""
        if body not in self._free:
            return self._poses[body]
        at = self._free[body]
        return pose_of(self._data.qpos[at : at + 3], self._data.qpos[at + 3 : at + 7])

    def place(self, body: str, T_world_body: Array) -> None:
        """Put a body somewhere, at rest."""
        self._poses[body] = np.array(T_world_body)
        pose = Pose.from_matrix(T_world_body)
        number, turn = self._numbers[body], wxyz(pose.quaternion)
        if body in self._free:
            at, speed = self._free[body], int(self._model.body_dofadr[number])
            self._data.qpos[at : at + 7] = [*pose.position, *turn]
            self._data.qvel[speed : speed + 6] = 0.0
        elif self._model.body_mocapid[number] >= 0:
            mocap = self._model.body_mocapid[number]
            self._data.mocap_pos[mocap], self._data.mocap_quat[mocap] = pose.position, turn
        else:
            self._model.body_pos[number], self._model.body_quat[number] = pose.position, turn
        self._fresh = False

    def speed(self, body: str) -> tuple[float, float]:
        """Return the speed of a movable body: metres and radians a second."""
        first = int(self._model.body_dofadr[self._numbers[body]])
        moving = self._data.qvel[first : first + 6]
        return float(np.linalg.norm(moving[:3])), float(np.linalg.norm(moving[3:]))

    def set_robot(
        self, base: Sequence[float] | Array, arm: Sequence[float] | Array, opening: float,
        number: int = 0,
    ) -> None:  # fmt: skip
        """Put base at x, y, yaw, the arm of a number at joint angles, its fingers at opening / 2;
        metres, radians.
        """
        self._data.qpos[self._base] = base
        self._data.qpos[self._arms[number]] = arm
        self._data.qpos[self._fingers[number]] = opening / 2
        self._fresh = False

    def link_frames(self) -> Array:
        """Return each link's frame, position (m) and quaternion xyzw, shape (l, 7), as `links`."""
        self._refresh()
        turns = self._data.xquat[self._frames][:, [1, 2, 3, 0]]
        return np.concatenate([self._data.xpos[self._frames], turns], axis=1)

    # What touches what

    def distance(self, first: Solid, second: Solid, reach: float = 0.02) -> float:
        """Compute two solids' distance, metres; negative in penetration, infinite past `reach`."""
        self._refresh()
        least = math.inf
        for a in self._shapes(first):
            for b in self._shapes(second):
                found = self._mujoco.mj_geomDistance(self._model, self._data, a, b, reach, None)
                if found < reach and found < least:
                    least = float(found)
        return least

    def _shapes(self, solid: Solid) -> Sequence[int]:
        geoms = self._geoms[solid.handle]
        return geoms if solid.link < 0 else geoms[solid.link : solid.link + 1]

    def rays(self, starts: Array, ends: Array) -> list[tuple[str | None, float]]:
        """Cast rays (n, 3), metres: the owner's name of each hit or None, and how far (0-1)."""
        self._refresh()
        hits: list[tuple[str | None, float]] = []
        geom, normal = np.zeros(1, dtype=np.int32), np.zeros(3)
        for start, way in zip(starts, ends - starts, strict=True):
            far = self._mujoco.mj_ray(
                self._model, self._data, start, way, None, 1, -1, geom, normal
            )
            if far >= 0.0 and normal @ way > 0.0:  # it leaves what it began in, wherever it ends
                hits.append((self._owner_of[geom[0]], 0.0))
            elif 0.0 <= far <= 1.0:
                hits.append((self._owner_of[geom[0]], float(far)))
            else:
                hits.append((None, 1.0))
        return hits

    def step(self, seconds: float) -> None:
        """Let time pass, in steps of TIMESTEP."""
        for _ in range(math.ceil(seconds / self._model.opt.timestep - 1e-9)):
            self._mujoco.mj_step(self._model, self._data)
        self._fresh = False
