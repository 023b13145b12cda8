"""Forward kinematics and Jacobians of the whole robot."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import columns
from tamp.geometric.scene.pose import Array, Pose

if TYPE_CHECKING:
    from jaxtyping import Float

Rows: TypeAlias = list[list[float]]
"""A pose, row by row."""


@dataclass(frozen=True, eq=False)
class _Model:
    """Pinocchio's model and data, and the numbers of the flange's joint and the tool's frame."""

    library: Any
    model: Any
    data: Any
    flange: int
    tool: int


class Kinematics:
    """FK and Jacobians by pinocchio, on a model composed of the base's x, y, yaw and the arm's
    joints.

    One object per robot: it owns pinocchio's buffers, so it must not be shared between threads.
    Pinocchio is imported when it is asked first: many plans need only the compiled kernels.
    Configurations are [base x, base y, base yaw, q1..qn], metres and radians.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._joint_of_link = tuple(
            (joint.child, 4 + index) for index, joint in enumerate(robot.joints)
        )
        self._T_base_arm = robot.T_base_arm.matrix
        self._T_flange_hand = robot.T_flange_hand.matrix
        self._fingers = tuple(
            (f.child, f.origin.matrix, f.origin.rotation @ np.array(f.axis)) for f in robot.fingers
        )

    @cached_property
    def _of(self) -> _Model:
        # Its wheel lives behind a .pth that pyright does not run.
        import pinocchio  # pyright: ignore[reportMissingImports]

        def placed(pose: Pose) -> Any:
            return pinocchio.SE3(np.array(pose.matrix))

        robot, model, parent = self.robot, pinocchio.Model(), 0
        for kind in (pinocchio.JointModelPX, pinocchio.JointModelPY, pinocchio.JointModelRZ):
            parent = model.addJoint(parent, kind(), pinocchio.SE3.Identity(), f"base{parent}")

        origin = robot.T_base_arm
        for joint in robot.joints:
            slides = joint.kind == "prismatic"
            kind = pinocchio.JointModelPZ if slides else pinocchio.JointModelRZ
            parent = model.addJoint(parent, kind(), placed(origin @ joint.origin), joint.name)
            origin = Pose()

        T_flange_tool = placed(robot.T_flange_hand @ robot.T_hand_tool)
        frame = pinocchio.Frame("tool", parent, T_flange_tool, pinocchio.FrameType.OP_FRAME)
        tool = model.addFrame(frame)
        return _Model(pinocchio, model, model.createData(), parent, tool)

    def link_poses(
        self, conf: Float[Array, " conf"], opening: float
    ) -> dict[str, Float[Array, "4 4"]]:
        """Compute T_world_link (4, 4) of all links by name; each finger stands at opening / 2."""
        of, data, robot = self._of, self._of.data, self.robot
        of.library.forwardKinematics(of.model, data, conf)
        T_world_base = data.oMi[3].homogeneous
        poses = {robot.base: T_world_base, robot.foot: T_world_base @ self._T_base_arm}
        for name, index in self._joint_of_link:
            poses[name] = data.oMi[index].homogeneous
        T_world_hand = poses[robot.hand] = data.oMi[of.flange].homogeneous @ self._T_flange_hand
        for name, origin, axis in self._fingers:
            T_hand_finger = origin.copy()
            T_hand_finger[:3, 3] += axis * (opening / 2)
            poses[name] = T_world_hand @ T_hand_finger
        for name, T_base_link in robot.still_links.items():
            poses[name] = T_world_base @ T_base_link.matrix
        return poses

    def tool(self, conf: Float[Array, " conf"]) -> Float[Array, "4 4"]:
        """Compute T_world_tool, shape (4, 4)."""
        of = self._of
        of.library.forwardKinematics(of.model, of.data, conf)
        return of.library.updateFramePlacement(of.model, of.data, of.tool).homogeneous

    def tool_plainly(self, conf: Float[Array, " conf"]) -> Float[Array, "4 4"]:
        """Compute T_world_tool, shape (4, 4), as `tool` does to the last bit, without pinocchio:
        for few poses, since it takes a hundred microseconds.
        """
        cos, sin = math.cos(conf[2]), math.sin(conf[2])
        pose = [[cos, -sin, 0.0, conf[0]], [sin, cos, 0.0, conf[1]], [0.0, 0.0, 1.0, 0.0]]
        origin = self.robot.T_base_arm
        for joint, position in zip(self.robot.joints, conf[3:].tolist(), strict=True):
            move = _slid if joint.kind == "prismatic" else _turned
            pose = _product(pose, move((origin @ joint.origin).matrix.tolist(), position))
            origin = Pose()
        T_flange_tool = (self.robot.T_flange_hand @ self.robot.T_hand_tool).matrix
        return np.array([*_product(pose, T_flange_tool.tolist()), [0.0, 0.0, 0.0, 1.0]])

    def arm_tool(self, arm: Float[Array, " joints"]) -> Float[Array, "4 4"]:
        """Compute T_base_tool, shape (4, 4), at joint positions (n,)."""
        return self.tool(np.concatenate([(0.0, 0.0, 0.0), arm]))

    def jacobian(self, conf: Float[Array, " conf"]) -> Float[Array, "6 conf"]:
        """Compute the Jacobian of the tool by conf, shape (6, 3 + n), in the world's axes: the tool
        origin's velocity above the angular one.
        """
        of = self._of
        frame = of.library.ReferenceFrame.LOCAL_WORLD_ALIGNED
        return of.library.computeFrameJacobian(of.model, of.data, conf, of.tool, frame)


class ArmsKinematics:
    """FK of all arms of a robot in its states [x, y, yaw, then q1..qn, opening of each arm]."""

    def __init__(self, robot: Robot) -> None:
        self._arms = [Kinematics(replace(arm, still_links={})) for arm in robot.arms]
        self._columns = columns(robot)

    def _conf(self, row: Float[Array, " width"], arm: int) -> Float[Array, " conf"]:
        return np.concatenate([row[:3], row[self._columns[arm]][:-1]])

    def link_poses(self, row: Float[Array, " width"]) -> dict[str, Float[Array, "4 4"]]:
        """Compute T_world_link (4, 4) of all links by name."""
        poses: dict[str, Array] = {}
        for number, kinematics in enumerate(self._arms):
            opening = float(row[self._columns[number].stop - 1])
            poses |= kinematics.link_poses(self._conf(row, number), opening)
        return poses

    def tool(self, row: Float[Array, " width"], arm: int = 0) -> Float[Array, "4 4"]:
        """Compute T_world_tool of the arm of a number, shape (4, 4)."""
        return self._arms[arm].tool(self._conf(row, arm))


def base_matrix(base: Float[Array, " coordinates"]) -> Float[Array, "4 4"]:
    """Return T_world_base (4, 4) of a base pose x, y, yaw, or of a configuration."""
    cos, sin = math.cos(base[2]), math.sin(base[2])
    return np.array([[cos, -sin, 0, base[0]], [sin, cos, 0, base[1]], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def _product(A: Rows, B: Rows) -> Rows:
    """Multiply two poses, each of three rows at least, adding in Eigen's order: two rows at once
    from the left, the third by halves.
    """
    product = []
    for r, (a, b, c, shift) in enumerate(A[:3]):
        terms = [(a * B[0][k], b * B[1][k], c * B[2][k]) for k in range(4)]
        sums = [x + (y + z) if r == 2 else (x + y) + z for x, y, z in terms]
        product.append([*sums[:3], sums[3] + shift])
    return product


def _turned(T: Rows, angle: float) -> Rows:
    """Turn a pose about its z axis; the new y axis is the cross product of the others."""
    cos, sin = math.cos(angle), math.sin(angle)
    x = [cos * row[0] + sin * row[1] for row in T[:3]]
    z = [row[2] for row in T[:3]]
    y = [z[r - 2] * x[r - 1] - z[r - 1] * x[r - 2] for r in range(3)]
    return [[x[r], y[r], z[r], T[r][3]] for r in range(3)]


def _slid(T: Rows, way: float) -> Rows:
    """Move a pose along its z axis."""
    return [[*row[:3], row[3] + row[2] * way] for row in T[:3]]
