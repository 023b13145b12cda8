"""Forward kinematics and Jacobians of the whole robot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

# Its wheel lives behind a .pth that pyright does not run.
import pinocchio  # pyright: ignore[reportMissingImports]

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose

if TYPE_CHECKING:
    from jaxtyping import Float


class Kinematics:
    """FK and Jacobians by pinocchio, on a model composed of the base's x, y, yaw and the arm's
    joints.

    One object per robot: it owns pinocchio's buffers, so it must not be shared between threads.
    Configurations are [base x, base y, base yaw, q1..qn], metres and radians.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        model = pinocchio.Model()
        parent = 0
        for kind in (pinocchio.JointModelPX, pinocchio.JointModelPY, pinocchio.JointModelRZ):
            parent = model.addJoint(parent, kind(), pinocchio.SE3.Identity(), f"base{parent}")

        origin = robot.T_base_arm
        for joint in robot.joints:
            slides = joint.kind == "prismatic"
            kind = pinocchio.JointModelPZ if slides else pinocchio.JointModelRZ
            parent = model.addJoint(parent, kind(), _se3(origin @ joint.origin), joint.name)
            origin = Pose()

        self._tool = model.addFrame(
            pinocchio.Frame(
                "tool",
                parent,
                _se3(robot.T_flange_hand @ robot.T_hand_tool),
                pinocchio.FrameType.OP_FRAME,
            )
        )

        self._model, self._data, self._flange = model, model.createData(), parent
        self._joint_of_link = tuple(
            (joint.child, 4 + index) for index, joint in enumerate(robot.joints)
        )
        self._T_base_arm = robot.T_base_arm.matrix
        self._T_flange_hand = robot.T_flange_hand.matrix
        self._fingers = tuple(
            (f.child, f.origin.matrix, f.origin.rotation @ np.array(f.axis)) for f in robot.fingers
        )

    def link_poses(
        self, conf: Float[Array, " conf"], opening: float
    ) -> dict[str, Float[Array, "4 4"]]:
        """Compute T_world_link (4, 4) of all links by name; each finger stands at opening / 2."""
        data, robot = self._data, self.robot
        pinocchio.forwardKinematics(self._model, data, conf)
        T_world_base = data.oMi[3].homogeneous
        poses = {robot.base: T_world_base, robot.foot: T_world_base @ self._T_base_arm}
        for name, index in self._joint_of_link:
            poses[name] = data.oMi[index].homogeneous
        T_world_hand = poses[robot.hand] = data.oMi[self._flange].homogeneous @ self._T_flange_hand
        for name, origin, axis in self._fingers:
            T_hand_finger = origin.copy()
            T_hand_finger[:3, 3] += axis * (opening / 2)
            poses[name] = T_world_hand @ T_hand_finger
        return poses

    def tool(self, conf: Float[Array, " conf"]) -> Float[Array, "4 4"]:
        """Compute T_world_tool, shape (4, 4)."""
        pinocchio.forwardKinematics(self._model, self._data, conf)
        return pinocchio.updateFramePlacement(self._model, self._data, self._tool).homogeneous

    def arm_tool(self, arm: Float[Array, " joints"]) -> Float[Array, "4 4"]:
        """Compute T_base_tool, shape (4, 4), at joint positions (n,)."""
        return self.tool(np.concatenate([(0.0, 0.0, 0.0), arm]))

    def jacobian(self, conf: Float[Array, " conf"]) -> Float[Array, "6 conf"]:
        """Compute the Jacobian of the tool by conf, shape (6, 3 + n), in the world's axes: the tool
        origin's velocity above the angular one.
        """
        frame = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        return pinocchio.computeFrameJacobian(self._model, self._data, conf, self._tool, frame)


def base_matrix(base: Float[Array, " coordinates"]) -> Float[Array, "4 4"]:
    """Return T_world_base (4, 4) of a base pose x, y, yaw, or of a configuration."""
    cos, sin = math.cos(base[2]), math.sin(base[2])
    return np.array([[cos, -sin, 0, base[0]], [sin, cos, 0, base[1]], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def _se3(pose: Pose) -> pinocchio.SE3:
    return pinocchio.SE3(np.array(pose.matrix))
