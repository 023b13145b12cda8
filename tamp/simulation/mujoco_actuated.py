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
"""Newtons a metre and newtons a metre a second of the base's motors, alike about its axis, and of
an arm's sliding joints: a lift bears the arm."""

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


def _weld(number: int, body: str) -> str:
    """Name what can bind a body to the hand of the arm of a number."""
    return f"{body_name(body)}/hand{number}"


class MujocoMotors(MujocoWorld, MotorSimulation):
    """A world with gravity and a robot on motors in MuJoCo."""

    def __init__(self, scene: Scene, robot: Robot, force: float | None = None) -> None:
        self.begin(robot, scene)
        self._forces = [arm.force if force is None else force for arm in robot.arms]
        self._ticks = 0
        self._aims = [arm.opening / 2 for arm in robot.arms]
        self._finger_counts = [len(arm.fingers) for arm in robot.arms]
        self._passed: set[str] = set()
        super().__init__(scene, robot, dynamic=True)

    # Building

    def _described(self) -> Model:
        """Describe the scene, motors, and welds that can bind each body to each hand."""
        model = super()._described()
        spec, mujoco = model.spec, self._mujoco

        joints = [joint.name for arm in self.arms for joint in arm.joints]
        slides = [joint.kind == "prismatic" for arm in self.arms for joint in arm.joints]
        efforts = [effort for arm in self.arms for effort in arm.effort]
        for joint in joints:
            spec.joint(joint).armature = ROTOR_INERTIA_KG_M2
        gains = [BASE_GAINS] * len(BASE_JOINTS)
        gains += [
            BASE_GAINS if slid else ARM_GAINS[effort >= STRONG_JOINT_NM]
            for slid, effort in zip(slides, efforts, strict=True)
        ]
        forces = (*(BASE_FORCE,) * len(BASE_JOINTS), *efforts)
        for name, (kp, kv), most in zip((*BASE_JOINTS, *joints), gains, forces, strict=True):
            self._add_motor(model, name, kp, kv, most)
        for arm, force in zip(self.arms, self._forces, strict=True):
            for finger in arm.fingers:
                self._add_motor(model, finger.name, *FINGER_GAINS, force)

        for number, arm in enumerate(self.arms):
            for name in self.scene.movable:
                weld = spec.add_equality(
                    name=_weld(number, name), type=mujoco.mjtEq.mjEQ_WELD,
                    objtype=mujoco.mjtObj.mjOBJ_BODY, name1=link_body(arm.hand),
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
        model = self._model
        links = [model.body(number).name for number in range(1, model.nbody)]
        self.robot_links = frozenset(
            name.removeprefix("link:")
            for name in links
            if not name.startswith("body:") and name != "floor"
        )
        count = len(self.conf)
        gains = model.actuator_gainprm[:count, 0]
        self._lead = -model.actuator_biasprm[:count, 2] / gains  # speed's share of the target, s
        self._motors = count
        self._hands = [model.body(link_body(arm.hand)).id for arm in self.arms]
        self._welds = [
            {name: model.equality(_weld(number, name)).id for name in self.scene.movable}
            for number in range(len(self.arms))
        ]
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
        wanted = [SQUEEZE_AIM_M if hand.squeezing else hand.opening / 2 for hand in self.hands]
        for number, hand in enumerate(self.hands):
            if not hand.squeezing:  # the force ends at once, not when the target has come back
                stands = self._width(number) / 2
                self._aims[number] = max(self._aims[number], min(stands, wanted[number]))
        for _ in range(steps):
            most = FINGER_SPEED * TIMESTEP_S
            for number, aim in enumerate(self._aims):
                self._aims[number] += float(np.clip(wanted[number] - aim, -most, most))
            control[self._motors :] = np.repeat(self._aims, self._finger_counts)
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
        return self._width(self.used)

    def _width(self, number: int) -> float:
        return float(self._data.qpos[self._fingers[number]].sum())

    def tool(self) -> Array:
        """Return the actual T_world_tool (4, 4)."""
        return self._hand_pose() @ self.arms[self.used].T_hand_tool.matrix

    def _hand_pose(self) -> Array:
        self._refresh()
        hand = self._hands[self.used]
        return pose_of(self._data.xpos[hand], self._data.xquat[hand])

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
            for finger in self.finger_links or (self.arms[self.used].hand,)
            for solid in self.solids[body]
        )

    # What happens to bodies

    def attach(self, body: str) -> None:
        """Fix a body to the hand where it is; the robot passes through it from now on."""
        self.detach()
        T_hand_body = Pose.from_matrix(np.linalg.inv(self._hand_pose()) @ self.pose(body))
        weld = self._welds[self.used][body]
        at = [*T_hand_body.position, *wxyz(T_hand_body.quaternion)]
        self._model.eq_data[weld, :3] = 0.0  # the anchor, in the body's frame
        self._model.eq_data[weld, 3:10] = at
        self._data.eq_active[weld] = 1
        self.hand.bound = body
        self.disable_collision(body, True)

    def detach(self) -> None:
        """Undo `bind`; the robot still passes through the body until `pass_through`
        says otherwise.
        """
        if self.bound is not None:
            self._data.eq_active[self._welds[self.used][self.bound]] = 0
            self.hand.bound = None

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
        kept = self._state()
        bound = {
            number: (hand.bound, self._model.eq_data[self._welds[number][hand.bound]].copy())
            for number, hand in enumerate(self.hands)
            if hand.bound is not None
        }
        for name in scene.bodies.keys() - self.scene.bodies.keys():
            self._poses[name] = scene.bodies[name].pose.matrix
        self.scene = scene
        self._passed &= scene.bodies.keys()
        self._build()
        self._restore(kept)
        for number, (name, at_hand) in bound.items():
            self.hands[number].bound = name if name in scene.bodies else None
            if name in scene.bodies:
                weld = self._welds[number][name]
                self._model.eq_data[weld], self._data.eq_active[weld] = at_hand, 1

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
