"""Physics in MuJoCo of a scene under gravity with a robot on motors.

Settings, measured (docs/engines.md): an elliptic cone, impratio 10 and three iterations without
slip hold a body for minutes; MuJoCo's own lose it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.simulation.actuation import (
    BASE_FORCE,
    BETWEEN_FINGERS_M,
    COMMANDS_PER_SECOND,
    FINGER_SPEED,
    MotorSimulation,
    contact_pair,
)
from tamp.simulation.mobile_urdf import BASE_JOINTS
from tamp.simulation.mujoco_model import (
    CONTACT_SOFTNESS,
    FELT,
    PASSED,
    TIMESTEP_S,
    Model,
    body_name,
    link_body,
    pose_of,
    wxyz,
)
from tamp.simulation.mujoco_world import MujocoWorld

BASE_GAINS = (2e5, 1.5e4)
"""Newtons a metre and newtons a metre a second of the base's motors, alike about its axis."""

ARM_GAINS = {True: (4500.0, 450.0), False: (2000.0, 200.0)}
"""The same of the arm's, newton metres and radians: of strong joints, and of the others."""

STRONG_JOINT_NM = 50.0
"""Newton metres from which a joint is strong."""

ROTOR_INERTIA_KG_M2 = 0.1
"""Inertia of the rotors of the arm's motors, kg m2."""

FINGER_GAINS = (2e4, 200.0)
"""The same of the fingers', newtons and metres."""

SQUEEZE_AIM_M = -0.01
"""Metres at which squeezing fingers aim: past each other, so that they press."""


class MujocoMotors(MujocoWorld, MotorSimulation):
    """A world with gravity and a robot on motors in MuJoCo."""

    def __init__(self, scene: Scene, robot: Robot, force: float | None = None) -> None:
        self._force = robot.force if force is None else force
        self._robot, self._ticks = robot, 0
        self._T_hand_tool = robot.T_hand_tool.matrix
        self.opening = self.widest = robot.opening
        self._aims = robot.opening / 2
        self.squeezing = False
        self.bound: str | None = None
        self._passed: set[str] = set()
        self.hand_link = robot.hand
        self.finger_links = tuple(one.name for one in robot.finger_links)
        super().__init__(scene, robot, dynamic=True)
        self.conf = np.array([*scene.robot.base, *(scene.robot.arm or robot.home)], dtype=float)

    # Building

    def _described(self) -> Model:
        """Describe the scene, motors, and a weld that can bind each body to the hand."""
        model = super()._described()
        spec, mujoco, robot = model.spec, self._mujoco, self._robot

        for joint in robot.joints:
            spec.joint(joint.name).armature = ROTOR_INERTIA_KG_M2
        driven = (*BASE_JOINTS, *(joint.name for joint in robot.joints))
        gains = [BASE_GAINS] * len(BASE_JOINTS)
        gains += [ARM_GAINS[effort >= STRONG_JOINT_NM] for effort in robot.effort]
        forces = (*(BASE_FORCE,) * len(BASE_JOINTS), *robot.effort)
        for name, (kp, kv), most in zip(driven, gains, forces, strict=True):
            self._add_motor(model, name, kp, kv, most)
        for finger in robot.fingers:
            self._add_motor(model, finger.name, *FINGER_GAINS, self._force)

        for name in self.scene.movable:
            weld = spec.add_equality(
                name=body_name(name), type=mujoco.mjtEq.mjEQ_WELD,
                objtype=mujoco.mjtObj.mjOBJ_BODY, name1=link_body(self.hand_link),
                name2=body_name(name),
            )  # fmt: skip
            weld.active, (weld.solref, weld.solimp) = False, CONTACT_SOFTNESS
        return model

    def _add_motor(self, model: Model, joint: str, kp: float, kv: float, most: float) -> None:
        mujoco = self._mujoco
        # A URDF's effort would clamp what the motor gives, unseen.
        model.spec.joint(joint).actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        motor = model.spec.add_actuator(
            name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED, biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        )  # fmt: skip
        motor.gainprm[0], motor.biasprm[1], motor.biasprm[2] = kp, -kp, -kv
        motor.forcelimited, motor.forcerange = mujoco.mjtLimited.mjLIMITED_TRUE, [-most, most]

    def _index(self) -> None:
        super()._index()
        model, robot = self._model, self._robot
        links = [model.body(number).name for number in range(1, model.nbody)]
        self.robot_links = frozenset(
            name.removeprefix("link:")
            for name in links
            if not name.startswith("body:") and name != "floor"
        )
        count = len(BASE_JOINTS) + len(robot.joints)
        gains = model.actuator_gainprm[:count, 0]
        self._lead = -model.actuator_biasprm[:count, 2] / gains  # speed's share of the target, s
        self._motors = count
        self._hand = model.body(link_body(self.hand_link)).id
        self._welds = {name: model.equality(body_name(name)).id for name in self.scene.movable}
        for name in self._passed & self.scene.bodies.keys():
            self.disable_collision(name, True)

    # Time

    def step_motors(self, rates: Sequence[float] | None = None) -> None:
        """Step the simulation by 1 / COMMANDS_PER_SECOND s towards `conf` and `opening`; `rates`
        (3 + n,) are the trajectory's speeds there.
        """
        control, steps = self._data.ctrl, round(1 / COMMANDS_PER_SECOND / TIMESTEP_S)
        control[: self._motors] = self.conf
        if rates is not None:
            control[: self._motors] += self._lead * rates
        wanted = SQUEEZE_AIM_M if self.squeezing else self.opening / 2
        if not self.squeezing:  # the force ends at once, not when the target has come back
            self._aims = max(self._aims, min(self.width() / 2, wanted))
        for _ in range(steps):
            most = FINGER_SPEED * TIMESTEP_S
            self._aims += float(np.clip(wanted - self._aims, -most, most))
            control[self._motors :] = self._aims
            self._mujoco.mj_step(self._model, self._data)
        self._fresh = False
        self._ticks += 1

    @property
    def time(self) -> float:
        """Return the simulated time, seconds since the beginning."""
        return self._ticks / COMMANDS_PER_SECOND

    # What is

    def actual(self) -> Array:
        """Return the actual configuration (3 + n,)."""
        return self._data.qpos[self._driven].copy()

    def width(self) -> float:
        """Return how far the fingers are apart, metres."""
        return float(self._data.qpos[self._fingers].sum())

    def tool(self) -> Array:
        """Return the actual T_world_tool (4, 4)."""
        self._refresh()
        return (
            pose_of(self._data.xpos[self._hand], self._data.xquat[self._hand]) @ self._T_hand_tool
        )

    def touches(self) -> dict[tuple[str, str], float]:
        """Return the contact forces, newtons, between the robot's links and bodies, and between
        pairs of bodies one of which can move.

        The link comes first in a pair; two bodies are sorted. "floor" is a body.
        """
        found: dict[tuple[str, str], float] = {}
        contacts, forces = self._data.contact, self._data.efc_force
        rows = contacts.efc_address.tolist()
        for (a, b), row in zip(contacts.geom.tolist(), rows, strict=True):
            if row < 0:
                continue
            first, second = self._owner_of[a], self._owner_of[b]
            if first == second:
                continue
            of_robot = bool(self._is_link[a]), bool(self._is_link[b])
            pair = contact_pair(first, second, of_robot, self.robot_links)
            found[pair] = found.get(pair, 0.0) + float(forces[row])
        return found

    def near_fingers(self, body: str, reach: float = BETWEEN_FINGERS_M) -> bool:
        """Check whether both fingers, or the cup, are this near to a body, metres."""
        return all(
            self.distance(self.links[finger], solid, reach) < reach
            for finger in self.finger_links or (self.hand_link,)
            for solid in self.solids[body]
        )

    # What happens to bodies

    def attach(self, body: str) -> None:
        """Fix a body to the hand where it is; the robot passes through it from now on."""
        self.detach()
        self._refresh()
        T_world_hand = pose_of(self._data.xpos[self._hand], self._data.xquat[self._hand])
        T_hand_body = Pose.from_matrix(np.linalg.inv(T_world_hand) @ self.pose(body))
        weld = self._welds[body]
        at = [*T_hand_body.position, *wxyz(T_hand_body.quaternion)]
        self._model.eq_data[weld, :3] = 0.0  # the anchor, in the body's frame
        self._model.eq_data[weld, 3:10] = at
        self._data.eq_active[weld] = 1
        self.bound = body
        self.disable_collision(body, True)

    def detach(self) -> None:
        """Undo `bind`; the robot still passes through the body until `pass_through`
        says otherwise.
        """
        if self.bound is not None:
            self._data.eq_active[self._welds[self.bound]] = 0
            self.bound = None

    def disable_collision(self, body: str, passes: bool) -> None:
        """Switch collisions between the robot and a body: whether they do not feel each other."""
        (self._passed.add if passes else self._passed.discard)(body)
        model, geoms = self._model, self._geoms[self._numbers[body]]
        model.geom_contype[geoms], model.geom_conaffinity[geoms] = PASSED if passes else FELT
        # Pairs of their own know no masks: below a margin this negative nothing is a contact.
        mine = np.isin(model.pair_geom1, geoms) | np.isin(model.pair_geom2, geoms)
        mine &= self._is_link[model.pair_geom1] | self._is_link[model.pair_geom2]
        model.pair_margin[mine] = -1.0 if passes else 0.0

    def set_pose(self, body: str, T_world_body: Array) -> None:
        """Move a body somewhere at once, at rest."""
        self.place(body, T_world_body)

    def reset_scene(self, scene: Scene) -> None:
        """Take bodies away that a scene does not have, and add those that only it has, where it
        says.
        """
        bound, kept = self.bound, self._state()
        at_hand = None if bound is None else self._model.eq_data[self._welds[bound]].copy()
        for name in scene.bodies.keys() - self.scene.bodies.keys():
            self._poses[name] = scene.bodies[name].pose.matrix
        self.scene, self.bound = scene, None
        self._passed &= scene.bodies.keys()
        self._build()
        self._restore(kept)
        if bound is not None and bound in scene.bodies:
            self._model.eq_data[self._welds[bound]] = at_hand
            self._data.eq_active[self._welds[bound]] = 1
            self.bound = bound

    def _state(self) -> dict[str, tuple[Array, Array]]:
        """Return positions and speeds by joint."""
        model, data = self._model, self._data
        sizes = {0: (7, 6), 1: (4, 3)}
        kept: dict[str, tuple[Array, Array]] = {}
        for number in range(model.njnt):
            wide, fast = sizes.get(int(model.jnt_type[number]), (1, 1))
            at, speed = int(model.jnt_qposadr[number]), int(model.jnt_dofadr[number])
            kept[model.joint(number).name] = (
                data.qpos[at : at + wide].copy(), data.qvel[speed : speed + fast].copy(),
            )  # fmt: skip
        return kept

    def _restore(self, kept: dict[str, tuple[Array, Array]]) -> None:
        model, data = self._model, self._data
        for number in range(model.njnt):
            if (name := model.joint(number).name) in kept:
                places, speeds = kept[name]
                at, speed = int(model.jnt_qposadr[number]), int(model.jnt_dofadr[number])
                data.qpos[at : at + len(places)] = places
                data.qvel[speed : speed + len(speeds)] = speeds
        self._mujoco.mj_forward(model, data)  # contacts are known at once
        self._fresh = True
