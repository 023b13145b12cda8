"""The context that all streams of one problem share: the scene, the robot, and the tools that were
built for them once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.collision.hand_collisions import HandCollisions
from tamp.geometric.collision.swept_boxes import SweptBoxes
from tamp.geometric.collision.touching import Touching
from tamp.geometric.motion.passage import Passage
from tamp.geometric.motion.planners import COMPILED
from tamp.geometric.robot.arms import Posture, beside
from tamp.geometric.robot.base_fit import BaseFit, freedom
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.reachability import Reachability
from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.robot.states import arm_of
from tamp.geometric.samplers.mixture import Mixture
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Part, Scene
from tamp.geometric.stability.stable_poses import StableFaces, stable_faces_of
from tamp.geometric.values import BaseConf, Grasp, Load, Reach, Stance

if TYPE_CHECKING:
    from jaxtyping import Float

NO_OTHERS: Mapping[str, Stance] = MappingProxyType({})


@dataclass
class Context:
    """The shared tools of one problem's streams.

    Attributes:
        scene: The problem's geometry.
        robot: Its robot.
        mixtures: Relation to the generators that serve it.
        steering: How the base moves: "se2" in any direction, "reeds-shepp" like a car,
            "differential": turning on the spot and straight ahead.
        holding: What is in the hand at the start; the scene has that body where it was before.
        planner: Which sampling-based planner moves arm and base, one of `planners.PLANNERS`.
        heights: How high the hand reaches, metres, where `streams.reachable_height` measured
            it.
        solver: Inverse kinematics of the arm, where another context has it.
        footings: Of bodies at poses on movable ones, the convex polygons (n, 2) over all of which
            whatever stands on them must have its centre of mass, metres.
        swept_by_hand, swept_by_reach: Broad phases of the tests of one grasp, and of one reach,
            against one other body at a time.
    """

    scene: Scene
    robot: Robot
    mixtures: Mapping[str, Mixture]
    steering: str = "se2"
    holding: Grasp | None = None
    planner: str = COMPILED
    solver: ArmIK | None = None
    heights: dict[tuple[int, int], float | None] = field(
        default_factory=dict[tuple[int, int], "float | None"],
    )
    footings: dict[tuple[str, Pose], tuple[Array, ...]] = field(
        default_factory=dict[tuple[str, Pose], "tuple[Array, ...]"],
    )
    swept_by_hand: dict[tuple[Pose, Grasp], SweptBoxes] = field(
        default_factory=dict[tuple[Pose, Grasp], "SweptBoxes"],
    )
    swept_by_reach: dict[tuple[Grasp, BaseConf, Reach], SweptBoxes] = field(
        default_factory=dict[tuple[Grasp, "BaseConf", "Reach"], "SweptBoxes"],
    )
    _loaded: dict[tuple[str, Load], Context] = field(
        default_factory=dict[tuple[str, Load], "Context"],
    )
    _arms: dict[tuple[str, tuple[tuple[str, Stance], ...]], Context] = field(
        default_factory=dict[tuple[str, tuple[tuple[str, "Stance"], ...]], "Context"],
    )
    _boxes: dict[tuple[str, Pose], tuple[Array, Array]] = field(
        default_factory=dict[tuple[str, Pose], "tuple[Array, Array]"],
    )
    _radii: dict[str, float] = field(default_factory=dict[str, float])
    _fixed_only: dict[Grasp | None, Arrangement] = field(
        default_factory=dict["Grasp | None", Arrangement],
    )

    @cached_property
    def kinematics(self) -> Kinematics:
        """Forward kinematics of the robot."""
        return Kinematics(self.robot)

    @cached_property
    def ik(self) -> ArmIK:
        """Inverse kinematics of the arm."""
        return self.solver or ArmIK(self.robot)

    @cached_property
    def base_fit(self) -> BaseFit | None:
        """Return what moves base poses to where an arm of too few joints reaches; None for one of
        enough.
        """
        return BaseFit(self.robot) if freedom(self.robot) < 6 else None

    @cached_property
    def reachability(self) -> Reachability:
        """Return where the base may stand for a tool pose."""
        return Reachability(self.robot)

    @cached_property
    def collisions(self) -> Collisions:
        """Collision detection among the scene's bodies and the robot."""
        return Collisions(self.scene, self.robot, self.kinematics)

    @cached_property
    def touching(self) -> Touching:
        """Return the bodies that touch each other at the start."""
        return Touching(self.scene, () if self.holding is None else (self.holding.body,))

    @cached_property
    def hand(self) -> HandCollisions:
        """Collision detection of the hand alone."""
        return HandCollisions(self.scene, self.robot)

    @cached_property
    def passage(self) -> Passage:
        """Return how wide the ways of the base are among the fixed bodies."""
        return Passage(self.scene, self.robot)

    @cached_property
    def fixed_parts(
        self,
    ) -> tuple[list[tuple[str, Part, Pose]], Float[Array, "n 3"], Float[Array, "n 3"]]:
        """List of the fixed bodies: name, part and pose of the body; and all parts' lowest and
        highest corners, (n, 3).
        """
        bodies = [self.scene.bodies[name] for name in self.scene.fixed]
        parts = [(body.name, part, body.pose) for body in bodies for part in body.parts]
        boxes = np.array([bounds((part,), pose) for _, part, pose in parts]).reshape(-1, 2, 3)
        return parts, boxes[:, 0], boxes[:, 1]

    @cached_property
    def home(self) -> Float[Array, " joints"]:
        """Return the arm's configuration between actions, shape (n,)."""
        arm = self.scene.robot.arm
        return np.array(self.robot.home if arm is None else arm)

    @cached_property
    def carrying_up(self) -> Float[Array, " 3"]:
        """Return the direction of up in the tool's frame while the arm is at home, shape (3,)."""
        return self.kinematics.tool_plainly(self.conf(np.zeros(3), self.home))[2, :3]

    def stands(
        self, T_world_tool: Float[Array, "4 4"], rng: np.random.Generator, count: int
    ) -> Float[Array, "k 3"]:
        """Sample base poses (k, 3) from which the arm likely reaches a tool pose (4, 4); a robot
        that does not drive has the one where it is.
        """
        if self.robot.drive == "fixed":
            return np.array([self.scene.robot.base])
        drawn = self.reachability.sample(T_world_tool, rng, count)
        if self.base_fit is None:
            return drawn
        return np.array([self.base_fit.fit(T_world_tool, base) for base in drawn])

    def stable_faces(self, body: str) -> StableFaces:
        """Return the ways in which a body can rest."""
        return stable_faces_of(self.scene.bodies[body])

    def box(self, body: str, pose: Pose) -> tuple[Float[Array, " 3"], Float[Array, " 3"]]:
        """Return low and high corner, (3,) each, of the world's box around a body, metres."""
        if (body, pose) not in self._boxes:
            self._boxes[body, pose] = bounds(self.scene.bodies[body].parts, pose)
        return self._boxes[body, pose]

    def radius(self, body: str) -> float:
        """Return the radius of a sphere around the body's frame that contains the body, metres."""
        if body not in self._radii:
            low, high = bounds(self.scene.bodies[body].parts, Pose())
            self._radii[body] = float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))
        return self._radii[body]

    def conf(
        self, base: tuple[float, float, float] | Float[Array, " 3"], arm: Float[Array, " joints"]
    ) -> Float[Array, " conf"]:
        """Return the configuration (3 + n,) of a base and an arm."""
        return np.concatenate([np.asarray(base, dtype=float), arm])

    def attachment(self, grasp: Grasp) -> Attachment:
        """Return the grasp as the collision layer wants it."""
        return Attachment(grasp.body, grasp.T_tool_body, grasp.opening)

    def fixed_only(self, grasp: Grasp | None) -> Arrangement:
        """Return the robot, with what it holds, among the fixed bodies."""
        if grasp not in self._fixed_only:
            attachment = None if grasp is None else self.attachment(grasp)
            self._fixed_only[grasp] = self.collisions.arrangement({}, attachment)
        return self._fixed_only[grasp]

    def loaded(self, body: str, load: Load) -> Context:
        """Return the context in which a body and what stands on it are one: they are carried
        together.
        """
        if not load:
            return self
        if (body, load) not in self._loaded:
            bodies = dict(self.scene.bodies)
            parts = [
                Part(part.shape, T_body_rider @ part.pose)
                for rider, T_body_rider in load
                for part in bodies.pop(rider).parts
            ]
            whole = bodies[body]
            bodies[body] = replace(whole, parts=(*whole.parts, *parts))
            made = Context(
                replace(self.scene, bodies=bodies), self.robot, self.mixtures, self.steering,
                planner=self.planner,
            )  # fmt: skip
            self._loaded[body, load] = made
        return self._loaded[body, load]

    def of_arm(self, name: str, others: Mapping[str, Stance] = NO_OTHERS) -> Context:
        """Return the context in which one of the robot's arms moves, and the others hold still.

        Args:
            name: Of the arm.
            others: How others stand, by their names; at home and empty where nothing is said.

        Raises:
            KeyError: There is no such arm.
        """
        key = name, tuple(sorted(others.items(), key=lambda one: one[0]))
        if key not in self._arms:
            postures = {other: self._posture(other, how) for other, how in others.items()}
            robot = beside(self.robot.arms, name, postures)
            solver = self.of_arm(name).ik if others else None
            self._arms[key] = Context(
                self.scene, robot, self.mixtures, self.steering, planner=self.planner,
                solver=solver, footings=self.footings,
            )  # fmt: skip
        return self._arms[key]

    def _posture(self, name: str, stance: Stance) -> Posture:
        arm, grasp = arm_of(self.robot, name), stance.grasp
        joints = stance.joints or arm.home
        if grasp is None:
            return Posture(joints, arm.opening)
        held = Link(grasp.body, self.scene.bodies[grasp.body].parts)
        return Posture(joints, grasp.opening, (held, grasp.T_tool_body))

    def scene_at(self, poses: Mapping[str, Pose], proposed: str | None = None) -> Scene:
        """Return the scene at a step of the plan: movable bodies at their poses there, those in the
        hand absent.

        The one that a pose is proposed for stays, at its start: its shape is wanted. Without any
        poses nothing is known about the step, and everything is at its start.
        """
        if not poses:
            return replace(self.scene, bodies=dict(self.scene.bodies))
        bodies = {
            name: replace(body, pose=poses[name]) if name in poses and name != proposed else body
            for name, body in self.scene.bodies.items()
            if not body.movable or name in poses or name == proposed
        }
        return replace(self.scene, bodies=bodies)
