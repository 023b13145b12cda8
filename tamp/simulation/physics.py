"""Rigid-body simulation in pybullet: bodies and the robot in an engine of their own.

Measured (benchmarks/engine_distances.py): distances at faces are exact; edges and corners of boxes
and cylinders are rounded, so that distances there come out up to 1.5 mm too large. Hulls are padded
by 1 mm, added back here. (With a pad of zero, penetration is measured wrongly.)
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import start_row
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Hull, Part, Scene
from tamp.simulation.shapes import floor_under, half_extents, link_frame, mass_centre, obj
from tamp.simulation.silence import silence
from tamp.simulation.solid import Solid, arrays, described
from tamp.simulation.world import FLOOR_NAME, World
from tamp.system.scratch import scratch_folder

HULL_PAD = 0.001
"""Metres by which Bullet pads a convex hull."""


@dataclass(frozen=True, eq=False)
class _Arm:
    """An arm in the engine: its number, those of its joints and fingers and of the links after the
    foot; the foot, and its centre of mass, in the base's frame.
    """

    handle: int
    joints: list[int]
    indices: list[int]
    T_base_foot: Array
    T_base_com: Array


class BulletWorld(World):
    """The scene's bodies and its robot in a pybullet client without a window."""

    def __init__(self, scene: Scene, robot: Robot | None = None, *, dynamic: bool = False) -> None:
        self.scene, self.robot, self.dynamic = scene, robot, dynamic
        self._bullet = load_bullet()
        self.client = self._bullet.connect(self._bullet.DIRECT)
        if self.client < 0:
            raise RuntimeError("pybullet has no more room for another client")
        self._poses: dict[str, Array] = {}
        self._centres: dict[str, Array] = {}
        self.solids: dict[str, tuple[Solid, ...]] = {}
        self.floor = self._add_floor()
        for body in scene.bodies.values():
            self._add_body(body)
        self.links: dict[str, Solid] = {}
        if robot is not None:
            self._add_robot(robot)
        if dynamic:
            self._bullet.setGravity(0.0, 0.0, -9.81, physicsClientId=self.client)

    def close(self) -> None:
        """Give the engine's memory back."""
        self._bullet.disconnect(physicsClientId=self.client)

    # Where things are

    def pose(self, body: str) -> Array:
        """Return T_world_body, shape (4, 4)."""
        if not self.dynamic:
            return self._poses[body]
        handle = self.solids[body][0].handle
        at, turn = self._bullet.getBasePositionAndOrientation(handle, physicsClientId=self.client)
        T_world_com = Pose(tuple(at), tuple(turn)).matrix.copy()
        T_world_com[:3, 3] -= T_world_com[:3, :3] @ self._centres[body]
        return T_world_com

    def place(self, body: str, T_world_body: Array) -> None:
        """Put a body somewhere, at rest."""
        self._poses[body] = np.array(T_world_body)
        for solid in self.solids[body]:
            self._move(solid.handle, T_world_body @ solid.offset)

    def set_robot(
        self, base: Sequence[float] | Array, arm: Sequence[float] | Array, opening: float,
        number: int = 0,
    ) -> None:  # fmt: skip
        """Put base at x, y, yaw, the arm of a number at joint angles, its fingers at opening / 2;
        metres, radians.
        """
        at = (float(base[0]), float(base[1]), float(base[2]))
        if at != self._base_at:
            T_world_base = Pose.from_xyz_yaw(at[0], at[1], 0.0, at[2]).matrix
            for solid in self._base_solids:
                self._move(solid.handle, T_world_base @ solid.offset)
            for one in self._arms:
                self._move(one.handle, T_world_base @ one.T_base_com)
            self._base_at = at
            frames = (T_world_base, *(T_world_base @ one.T_base_foot for one in self._arms))
            poses = map(Pose.from_matrix, frames)
            self._base_frames = [(*pose.position, *pose.quaternion) for pose in poses]
        moved = self._arms[number]
        values = [[float(q)] for q in arm] + [[opening / 2]] * (len(moved.joints) - len(arm))
        self._bullet.resetJointStatesMultiDof(
            moved.handle, moved.joints, values, physicsClientId=self.client
        )

    def link_frames(self) -> Array:
        """Return each link's frame, position (m) and quaternion xyzw, shape (l, 7), as `links`."""
        frames, (base, *feet) = list[tuple[float, ...]](), self._base_frames
        for arm, foot in zip(self._arms, feet, strict=True):
            states = self._bullet.getLinkStates(
                arm.handle, arm.indices, physicsClientId=self.client
            )
            frames += [foot, *(link_frame(state) for state in states)]
        return np.array([base, *frames])

    # What touches what

    def distance(self, first: Solid, second: Solid, reach: float = 0.02) -> float:
        """Compute two solids' distance, metres; negative in penetration, infinite past `reach`."""
        pads = first.pad + second.pad
        points = self._bullet.getClosestPoints(
            first.handle, second.handle, reach, first.link, second.link, physicsClientId=self.client
        )  # fmt: skip
        return min((point[8] + pads for point in points), default=math.inf)

    def rays(self, starts: Array, ends: Array) -> list[tuple[str | None, float]]:
        """Cast rays (n, 3), metres: the owner's name of each hit or None, and how far (0-1)."""
        hits: list[tuple[str | None, float]] = []
        for at in range(0, len(starts), 8192):  # more at a time overflow the engine's shared memory
            some = slice(at, at + 8192)
            found = self._bullet.rayTestBatch(
                starts[some].tolist(), ends[some].tolist(), numThreads=1,
                physicsClientId=self.client,
            )  # fmt: skip
            hits += [(self._owners.get((hit[0], hit[1])), hit[2]) for hit in found]
        return hits

    def step(self, seconds: float) -> None:
        """Let time pass, in steps of 1/240 s."""
        for _ in range(math.ceil(seconds * 240)):
            self._bullet.stepSimulation(physicsClientId=self.client)

    # Building

    def _add_floor(self) -> Solid:
        self._owners: dict[tuple[int, int], str] = {}
        centre, half = floor_under(self.scene)
        shape = self._bullet.createCollisionShape(
            self._bullet.GEOM_BOX, halfExtents=half.tolist(), physicsClientId=self.client
        )  # fmt: skip
        handle = self._bullet.createMultiBody(
            0.0, shape, -1, centre.tolist(), physicsClientId=self.client
        )
        self._owners[handle, -1] = FLOOR_NAME
        return Solid(FLOOR_NAME, handle, -1, np.eye(4), centre, half)

    def _add_body(self, body: Body) -> None:
        if self.dynamic and body.movable:
            solids = [self._compound(body)]
            self._centres[body.name] = mass_centre(body)
        else:
            solids = [self._solid(body.name, part, body.friction) for part in body.parts]
            self._centres[body.name] = np.zeros(3)
        self.solids[body.name] = tuple(solids)
        self.place(body.name, body.pose.matrix)

    def _solid(self, owner: str, part: Part, friction: float = 0.5) -> Solid:
        centre, half = half_extents(part.shape)
        turned = np.abs(part.pose.rotation) @ half
        pad = HULL_PAD if isinstance(part.shape, Hull) else 0.0
        shape = self._bullet.createCollisionShape(
            **described(part, self._bullet), physicsClientId=self.client
        )
        handle = self._bullet.createMultiBody(0.0, shape, physicsClientId=self.client)
        self._bullet.changeDynamics(
            handle, -1, lateralFriction=friction, physicsClientId=self.client
        )
        self._owners[handle, -1] = owner
        return Solid(
            owner, handle, -1, part.pose.matrix, part.pose.apply(centre[None])[0], turned, pad
        )

    def _compound(self, body: Body) -> Solid:
        pieces = [described(part, self._bullet) for part in body.parts]

        with scratch_folder() as folder:  # an array of shapes takes its meshes from files only
            files = [""] * len(pieces)
            for number, one in enumerate(pieces):
                if "vertices" in one:
                    files[number] = str(Path(folder) / f"{number}.obj")
                    Path(files[number]).write_text(obj(body.parts[number].shape))
            shape = self._bullet.createCollisionShapeArray(
                **arrays(pieces),
                fileNames=files,
                meshScales=[[1.0, 1.0, 1.0]] * len(files),
                collisionFramePositions=[list(part.pose.position) for part in body.parts],
                collisionFrameOrientations=[list(part.pose.quaternion) for part in body.parts],
                physicsClientId=self.client,
            )

        centre = mass_centre(body)
        handle = self._bullet.createMultiBody(
            body.mass, shape, baseInertialFramePosition=centre.tolist(), physicsClientId=self.client
        )  # fmt: skip
        self._bullet.changeDynamics(
            handle, -1, lateralFriction=body.friction, physicsClientId=self.client
        )

        self._owners[handle, -1] = body.name
        offset = np.eye(4)
        offset[:3, 3] = centre
        return Solid(body.name, handle, -1, offset, np.zeros(3), np.full(3, np.inf))

    def _add_robot(self, robot: Robot) -> None:
        base = robot.link(robot.base)
        self._base_solids = tuple(self._solid(base.name, part) for part in base.parts)
        if len(self._base_solids) != 1:
            raise InputError(f"the base of the robot '{robot.name}' must be one convex part")
        self.links[base.name] = self._base_solids[0]
        self._arms = [self._add_arm(arm) for arm in robot.arms]

        self._base_at = (math.nan, math.nan, math.nan)
        self.set_state(start_row(robot, self.scene.robot))

    def _add_arm(self, robot: Robot) -> _Arm:
        bullet, client = self._bullet, self.client
        flags = bullet.URDF_USE_SELF_COLLISION | bullet.URDF_IGNORE_VISUAL_SHAPES
        handle = bullet.loadURDF(
            str(robot.urdf), useFixedBase=True, flags=flags, physicsClientId=client
        )
        inertial = bullet.getDynamicsInfo(handle, -1, physicsClientId=client)
        # The engine's base position is the one of the foot's centre of mass.
        T_foot_com = Pose(inertial[3], inertial[4]).matrix
        T_base_foot = robot.T_base_arm.matrix

        index = {robot.foot: -1}
        moving = {joint.name for joint in (*robot.joints, *robot.fingers)}
        joints: dict[str, int] = {}
        for number in range(bullet.getNumJoints(handle, physicsClientId=client)):
            info = bullet.getJointInfo(handle, number, physicsClientId=client)
            index[robot.prefix + info[12].decode()] = number
            if (name := robot.prefix + info[1].decode()) in moving:
                joints[name] = number
        still = {robot.base, robot.foot, *robot.still_links}
        others = [link.name for link in robot.links if link.name not in still]
        for name in (robot.foot, *others):
            self.links[name] = self._link_solid(name, handle, index[name], T_foot_com)
            self._owners[handle, index[name]] = name
        return _Arm(
            handle,
            [joints[one.name] for one in (*robot.joints, *robot.fingers)],
            [index[name] for name in others],
            T_base_foot,
            T_base_foot @ T_foot_com,
        )

    def _link_solid(self, name: str, arm: int, index: int, T_foot_com: Array) -> Solid:
        # The box around the link at its reset pose, taken from the engine and not from the
        # planner's hulls: here all joints are zero, so the link's frame is turned against the
        # world's; the box of its box is a little larger.
        bullet, client = self._bullet, self.client
        low, high = (
            np.array(corner) for corner in bullet.getAABB(arm, index, physicsClientId=client)
        )
        if index < 0:
            T_world_com = Pose(
                *bullet.getBasePositionAndOrientation(arm, physicsClientId=client)
            ).matrix
            T_world_link = T_world_com @ np.linalg.inv(T_foot_com)
        else:
            state = bullet.getLinkState(
                arm, index, computeForwardKinematics=1, physicsClientId=client
            )
            T_world_link = Pose(state[4], state[5]).matrix
        centre = T_world_link[:3, :3].T @ ((low + high) / 2 - T_world_link[:3, 3])
        half = np.abs(T_world_link[:3, :3].T) @ (high - low) / 2
        return Solid(name, arm, index, np.eye(4), centre, half, HULL_PAD)

    def _move(self, handle: int, T_world: Array) -> None:
        pose = Pose.from_matrix(T_world)
        self._bullet.resetBasePositionAndOrientation(
            handle, pose.position, pose.quaternion, physicsClientId=self.client
        )  # fmt: skip


def load_bullet() -> ModuleType:
    """Import pybullet, without the build time that it prints when imported."""
    if "pybullet" in sys.modules:
        return sys.modules["pybullet"]
    with silence():
        import pybullet
    return pybullet
