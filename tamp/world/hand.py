"""The hand and the wrist behind it against bodies: what is in their way is in it wherever the base stands."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tamp.world.bounds import bounds
from tamp.world.collision import Attachment
from tamp.world.fcl_bodies import FclBody, touch
from tamp.world.pose import Array, Pose
from tamp.world.robot import Robot
from tamp.world.scene import Cylinder, Hull, Part, Scene

Placed = tuple[str, Pose]


class HandCollisions:
    """Exact collision of the hand, its fingers, the wrist and the body in the hand, placed by the tool's pose.

    The wrist is the last link, and of the link before, which turns about the last joint's axis, what is there however
    it turns. It only says no: a hand that is free here may still belong to an arm that is not.
    """

    def __init__(self, scene: Scene, robot: Robot) -> None:
        self._scene = scene
        self._robot = robot
        T_hand_last = robot.T_flange_hand.inverse()
        wrist = (*robot.links[-4].parts, *_core(robot))
        behind = tuple(Part(part.shape, T_hand_last @ part.pose) for part in wrist)
        self._parts_of_hand = (*robot.links[-3].parts, *behind)
        self._hand = FclBody(self._parts_of_hand)
        self._fingers = [FclBody(link.parts) for link in robot.links[-2:]]
        self._bodies = {name: FclBody(body.parts) for name, body in scene.bodies.items()}
        self._held = {name: FclBody(scene.bodies[name].parts) for name in scene.movable}
        self._T_tool_hand = robot.T_hand_tool.inverse().matrix
        self._reach = max(
            _radius(bounds(self._parts_of_hand, robot.T_hand_tool.inverse())),
            *(_radius(_finger_in_tool(robot, i)) for i in range(2)),
        )
        self._boxes: dict[Placed, tuple[Array, Array]] = {}

    def hits(
        self, tools: Sequence[Array], opening: float, attachment: Attachment | None, others: Iterable[Placed]
    ) -> str | None:
        """The first of `others` that the hand hits at one of the poses.

        Args:
            tools: T_world_tool (4, 4).
            opening: Of the fingers, metres.
            attachment: The body in the hand, or None.
            others: Bodies by name and pose.
        """
        standing = list(others)
        if not standing:
            return None
        owners, lows, highs = self._parts(standing)
        reach = self._reach
        if attachment is not None:
            held = self._scene.bodies[attachment.body].parts
            reach = max(reach, _radius(bounds(held, attachment.T_tool_body)))
        for tool in tools:
            centre = tool[:3, 3]
            gaps = np.maximum(np.maximum(lows - centre, centre - highs), 0.0)
            near = np.flatnonzero((gaps * gaps).sum(axis=1) <= reach * reach)
            if not len(near):
                continue
            moving = [mover.place(k, matrix) for mover, matrix, k in self._moving(tool, opening, attachment)]
            for index in near:
                name, pose, part = owners[index]
                other = self._bodies[name].place(part, pose.matrix)
                if any(touch(mover, other, 0.0) for mover in moving):
                    return name
        return None

    def _parts(self, standing: list[Placed]) -> tuple[list[tuple[str, Pose, int]], Array, Array]:
        owners: list[tuple[str, Pose, int]] = []
        lows: list[Array] = []
        highs: list[Array] = []
        for name, pose in standing:
            if (name, pose) not in self._boxes:
                boxes = [bounds((part,), pose) for part in self._scene.bodies[name].parts]
                self._boxes[name, pose] = np.array([low for low, _ in boxes]), np.array([high for _, high in boxes])
            low, high = self._boxes[name, pose]
            owners += [(name, pose, part) for part in range(len(low))]
            lows.append(low)
            highs.append(high)
        return owners, np.concatenate(lows), np.concatenate(highs)

    def _moving(self, tool: Array, opening: float, attachment: Attachment | None) -> list[tuple[FclBody, Array, int]]:
        hand = tool @ self._T_tool_hand
        moving = [(self._hand, hand, k) for k in range(len(self._hand.objects))]
        for body, joint in zip(self._fingers, self._robot.fingers, strict=True):
            matrix = hand @ _finger(joint.origin.matrix, joint.origin.rotation @ np.array(joint.axis), opening)
            moving += [(body, matrix, k) for k in range(len(body.objects))]
        if attachment is not None:
            held = self._held[attachment.body]
            matrix = tool @ attachment.T_tool_body.matrix
            moving += [(held, matrix, k) for k in range(len(held.objects))]
        return moving


def _finger(origin: Array, axis: Array, opening: float) -> Array:
    """T_hand_finger (4, 4) of a finger that stands at half the opening."""
    matrix = origin.copy()
    matrix[:3, 3] += axis * (opening / 2)
    return matrix


def _finger_in_tool(robot: Robot, index: int) -> tuple[Array, Array]:
    """The box of a finger, wide open, in the tool's frame."""
    joint = robot.fingers[index]
    finger = _finger(joint.origin.matrix, joint.origin.rotation @ np.array(joint.axis), robot.opening)
    return bounds(robot.links[-2 + index].parts, robot.T_hand_tool.inverse() @ Pose.from_matrix(finger))


def _core(robot: Robot) -> list[Part]:
    """In the last link's frame: the largest cylinder about the last joint's axis within each part of the link before.

    A half-space n x <= d holds a cylinder of radius r and heights [low, high] along the unit axis u when
    |n - (n u) u| r + (n u) h <= d at both ends.
    """
    joint = robot.joints[-1]
    axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
    inverse = joint.origin.inverse()
    cores: list[Part] = []
    for part in robot.links[-5].parts:
        if not isinstance(part.shape, Hull):
            continue
        vertices = inverse.apply(part.pose.apply(part.shape.vertices))
        a, b, c = (vertices[part.shape.faces[:, i]] for i in range(3))
        normals = np.cross(b - a, c - a)
        normals = normals[np.linalg.norm(normals, axis=1) > 1e-12]
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        offsets = (vertices @ normals.T).max(axis=0)
        slopes = normals @ axis
        across = np.linalg.norm(normals - slopes[:, None] * axis, axis=1)
        best = (0.0, 0.0, 0.0, 0.0)
        for radius in np.arange(0.01, 0.1, 0.002):
            room = offsets - across * radius
            up, down = slopes > 1e-9, slopes < -1e-9
            if (room[~up & ~down] < 0).any():
                break
            high, low = float((room[up] / slopes[up]).min()), float((room[down] / slopes[down]).max())
            best = max(best, (radius**2 * max(high - low, 0.0), float(radius), low, high))
        volume, radius, low, high = best
        if volume > 0.0:
            matrix = _along(axis)
            matrix[:3, 3] = axis * (low + high) / 2
            cores.append(Part(Cylinder(radius, high - low), Pose.from_matrix(matrix)))
    return cores


def _along(axis: Array) -> Array:
    """A frame (4, 4) whose z is a unit vector."""
    other = np.cross(np.eye(3)[int(np.argmin(np.abs(axis)))], axis)
    matrix = np.eye(4)
    matrix[:3, 0] = other / np.linalg.norm(other)
    matrix[:3, 1], matrix[:3, 2] = np.cross(axis, matrix[:3, 0]), axis
    return matrix


def _radius(box: tuple[Array, Array]) -> float:
    """Of a sphere around the origin that contains a box, metres."""
    return float(np.linalg.norm(np.maximum(np.abs(box[0]), np.abs(box[1]))))
