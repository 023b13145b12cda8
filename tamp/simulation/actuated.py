"""Physics in pybullet of a scene under gravity with a robot on motors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.simulation.actuation import (
    BASE_FORCE,
    BETWEEN_FINGERS_M,
    COMMANDS_PER_SECOND,
    MotorSimulation,
    contact_pair,
)
from tamp.simulation.fingers import Fingers, iterations, with_pads
from tamp.simulation.mobile_urdf import BASE_JOINTS, mobile_urdf
from tamp.simulation.physics import BulletWorld
from tamp.simulation.shapes import link_frame
from tamp.simulation.silence import silence
from tamp.system.scratch import scratch_folder

ROLLING_FRICTION_M = 0.001
"""Metres: rolling and spinning friction of bodies, without which a can that lies would never come
to rest.
"""

SLEEPING_SPEED = 0.003
"""Metres and radians a second: a body that was slower for two seconds is left out of the
computation until something touches it. With seven bodies at rest a step costs a quarter of what it
costs otherwise."""


class BulletMotors(BulletWorld, MotorSimulation):
    """A world with gravity and a robot on motors in pybullet."""

    def __init__(self, scene: Scene, robot: Robot, force: float | None = None) -> None:
        super().__init__(scene, None, dynamic=True)
        self.begin(robot, scene)
        self._steps = 0
        self._forces = [BASE_FORCE] * 3 + [most for arm in robot.arms for most in arm.effort]
        bullet, client = self._bullet, self.client
        bullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1, physicsClientId=client)
        for name in scene.movable:
            self._let_roll(name)

        with scratch_folder() as folder:
            urdf = Path(folder) / "mobile.urdf"
            urdf.write_text(with_pads(mobile_urdf(robot), robot), encoding="utf-8")
            flags = bullet.URDF_IGNORE_VISUAL_SHAPES
            with silence():  # it remarks on links without mass
                self._mover = bullet.loadURDF(
                    str(urdf), useFixedBase=True, flags=flags, physicsClientId=client
                )

        joint: dict[str, int] = {}
        link: dict[str, int] = {}
        for number in range(bullet.getNumJoints(self._mover, physicsClientId=client)):
            info = bullet.getJointInfo(self._mover, number, physicsClientId=client)
            joint[info[1].decode()], link[info[12].decode()] = number, number
            bullet.changeDynamics(
                self._mover, number, linearDamping=0, angularDamping=0, physicsClientId=client
            )
            self._owners[self._mover, number] = info[12].decode()

        names = (*BASE_JOINTS, *(one.name for arm in robot.arms for one in arm.joints))
        self._driven = [joint[name] for name in names]
        self._finger_joints = [[joint[one.name] for one in arm.fingers] for arm in robot.arms]
        self._fingers = [
            Fingers(bullet, client, self._mover, joints, arm.force if force is None else force)
            if joints
            else None
            for joints, arm in zip(self._finger_joints, robot.arms, strict=True)
        ]
        self._hands = [link[arm.hand] for arm in robot.arms]
        self._grasping = [
            joints or [hand] for joints, hand in zip(self._finger_joints, self._hands, strict=True)
        ]
        self.robot_links = frozenset(link)
        self._constraints = [-1] * len(robot.arms)

        for number, value in zip(self._driven, self.conf, strict=True):
            bullet.resetJointState(self._mover, number, float(value), physicsClientId=client)
        for joints, hand in zip(self._finger_joints, self.hands, strict=True):
            for number in joints:
                bullet.resetJointState(
                    self._mover, number, hand.opening / 2, physicsClientId=client
                )

    # Time

    def step_motors(self, rates: Sequence[float] | None = None) -> None:
        """Step the simulation by 1 / COMMANDS_PER_SECOND s towards `conf` and `opening`; `rates`
        (3 + n,) are the trajectory's speeds there.
        """
        bullet, client = self._bullet, self.client
        count = len(self._driven)
        bullet.setJointMotorControlArray(
            self._mover, self._driven, bullet.POSITION_CONTROL, targetPositions=self.conf.tolist(),
            targetVelocities=[0.0] * count if rates is None else list(rates), forces=self._forces,
            positionGains=[0.3] * count, velocityGains=[1.0] * count, physicsClientId=client,
        )  # fmt: skip
        pressing = [
            fingers.drive(hand.opening, hand.squeezing, COMMANDS_PER_SECOND)
            for fingers, hand in zip(self._fingers, self.hands, strict=True)
            if fingers is not None
        ]
        if pressing:
            bullet.setPhysicsEngineParameter(
                numSolverIterations=iterations(any(pressing)), physicsClientId=client
            )
        bullet.stepSimulation(physicsClientId=client)
        self._steps += 1

    # What is

    @property
    def time(self) -> float:
        """Return the simulated time, seconds since the beginning."""
        return self._steps / COMMANDS_PER_SECOND

    def actual(self) -> Array:
        """Return the actual configuration (3 + n,)."""
        states = self._bullet.getJointStates(self._mover, self._driven, physicsClientId=self.client)
        return np.array([state[0] for state in states])

    def width(self) -> float:
        """Return how far the fingers are apart, metres."""
        fingers = self._fingers[self.used]
        return 0.0 if fingers is None else fingers.width()

    def tool(self) -> Array:
        """Return the actual T_world_tool (4, 4)."""
        state = self._bullet.getLinkState(
            self._mover, self._hands[self.used], computeForwardKinematics=1,
            physicsClientId=self.client,
        )  # fmt: skip
        x, y, z, *turn = link_frame(state)
        T_world_hand = Pose((x, y, z), (turn[0], turn[1], turn[2], turn[3])).matrix
        return T_world_hand @ self.arms[self.used].T_hand_tool.matrix

    def speed(self, body: str) -> tuple[float, float]:
        """Return the speed of a movable body: metres and radians a second."""
        moving = self._bullet.getBaseVelocity(
            self.solids[body][0].handle, physicsClientId=self.client
        )
        return float(np.linalg.norm(moving[0])), float(np.linalg.norm(moving[1]))

    def touches(self) -> dict[tuple[str, str], float]:
        """Return the contact forces, newtons, between the robot's links and bodies, and between
        pairs of bodies one of which can move.

        The link comes first in a pair; two bodies are sorted. "floor" is a body.
        """
        found: dict[tuple[str, str], float] = {}
        for point in self._bullet.getContactPoints(physicsClientId=self.client):
            first = self._owners.get((point[1], point[3]))
            second = self._owners.get((point[2], point[4]))
            if first is None or second is None or first == second:
                continue
            of_robot = point[1] == self._mover, point[2] == self._mover
            pair = contact_pair(first, second, of_robot, self.robot_links)
            found[pair] = found.get(pair, 0.0) + float(point[9])
        return found

    def near_fingers(self, body: str, reach: float = BETWEEN_FINGERS_M) -> bool:
        """Check whether both fingers, or the cup, are this near to a body, metres."""
        handle = self.solids[body][0].handle
        return all(
            self._bullet.getClosestPoints(
                self._mover, handle, reach, finger, -1, physicsClientId=self.client
            )
            for finger in self._grasping[self.used]
        )

    # What happens to bodies

    def attach(self, body: str) -> None:
        """Fix a body to the hand where it is; the robot passes through it from now on."""
        self.detach()
        bullet, client, handle = self._bullet, self.client, self.solids[body][0].handle
        hand = self._hands[self.used]
        state = bullet.getLinkState(
            self._mover, hand, computeForwardKinematics=1, physicsClientId=client
        )
        # Of the centres of mass, as the engine wants them.
        T_world_hand = Pose(tuple(state[0]), tuple(state[1]))
        T_world_body = Pose(
            *map(tuple, bullet.getBasePositionAndOrientation(handle, physicsClientId=client))
        )
        T_hand_body = T_world_hand.inverse() @ T_world_body
        self._constraints[self.used] = bullet.createConstraint(
            self._mover, hand, handle, -1, bullet.JOINT_FIXED, [0, 0, 0],
            T_hand_body.position, [0, 0, 0], T_hand_body.quaternion, physicsClientId=client,
        )  # fmt: skip
        self.hand.bound = body
        self.disable_collision(body, True)

    def detach(self) -> None:
        """Undo `bind`; the robot still passes through the body until `pass_through`
        says otherwise.
        """
        if self.bound is not None:
            constraint = self._constraints[self.used]
            self._bullet.removeConstraint(constraint, physicsClientId=self.client)
            self.hand.bound = None

    def disable_collision(self, body: str, passes: bool) -> None:
        """Switch collisions between the robot and a body: whether they do not feel each other."""
        for link in range(-1, self._bullet.getNumJoints(self._mover, physicsClientId=self.client)):
            self._bullet.setCollisionFilterPair(
                self._mover, self.solids[body][0].handle, link, -1, 0 if passes else 1,
                physicsClientId=self.client,
            )  # fmt: skip

    def set_pose(self, body: str, T_world_body: Array) -> None:
        """Move a body somewhere at once, at rest."""
        self.place(body, T_world_body)
        self.wake(body)
        for solid in self.solids[body]:
            self._bullet.resetBaseVelocity(
                solid.handle, [0.0] * 3, [0.0] * 3, physicsClientId=self.client
            )

    def reset_scene(self, scene: Scene) -> None:
        """Take bodies away that a scene does not have, and add those that only it has, where it
        says.
        """
        for name in self.scene.bodies.keys() - scene.bodies.keys():
            self._forget(name)
            for solid in self.solids.pop(name):
                self._bullet.removeBody(solid.handle, physicsClientId=self.client)
        for name, body in scene.bodies.items():
            if name not in self.scene.bodies:
                self._add_body(body)
                if body.movable:
                    self._let_roll(name)
        self.scene = scene
        self.wake(self.bound)

    def _forget(self, body: str) -> None:
        """Take a body that goes out of the hands that it is bound to."""
        for constraint, hand in zip(self._constraints, self.hands, strict=True):
            if hand.bound == body:
                self._bullet.removeConstraint(constraint, physicsClientId=self.client)
                hand.bound = None

    def wake(self, body: str | None) -> None:
        """Wake all bodies; this one, which is handled, stays awake when it is at rest
        in the hand.
        """
        bullet = self._bullet
        for name in self.scene.movable:
            state = (
                bullet.ACTIVATION_STATE_DISABLE_SLEEPING
                if name == body
                else bullet.ACTIVATION_STATE_ENABLE_SLEEPING
            )
            bullet.changeDynamics(
                self.solids[name][0].handle, -1, physicsClientId=self.client,
                activationState=state | bullet.ACTIVATION_STATE_WAKE_UP,
            )  # fmt: skip

    def _let_roll(self, body: str) -> None:
        self._bullet.changeDynamics(
            self.solids[body][0].handle, -1,
            rollingFriction=ROLLING_FRICTION_M, spinningFriction=ROLLING_FRICTION_M,
            sleepThreshold=SLEEPING_SPEED, physicsClientId=self.client,
        )  # fmt: skip
