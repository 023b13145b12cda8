"""The hand and the wrist behind it against bodies: what is in their way is in it wherever the base
stands.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.collisions import Attachment
from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.collision.swept_boxes import SweptBoxes, swept_balls
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Cylinder, Hull, Part, Scene

if TYPE_CHECKING:
    from jaxtyping import Float

Placed = tuple[str, Pose]

RADIUS_SLACK_M = 1e-4
"""What is added to the balls around parts, metres, so that rounding never keeps FCL from being
asked."""


class HandCollisions:
    """Exact collision of the hand, its fingers, the wrist and the body in the hand, placed by the
    tool's pose.

    The wrist is the last link, and of the link before, which turns about the last joint's axis,
    what is there however it turns. It only says no: a hand that is free here may still belong to an
    arm that is not.
    """

    def __init__(self, scene: Scene, robot: Robot) -> None:
        self._scene = scene
        self._robot = robot
        T_hand_last = robot.T_flange_hand.inverse()
        wrist = (*robot.link(robot.joints[-1].child).parts, *_core(robot))
        behind = tuple(Part(part.shape, T_hand_last @ part.pose) for part in wrist)
        self._parts_of_hand = (*robot.link(robot.hand).parts, *behind)
        self._hand = FclBody(self._parts_of_hand)
        self._fingers = [FclBody(link.parts) for link in robot.finger_links]
        self._bodies = {name: FclBody(body.parts) for name, body in scene.bodies.items()}
        self._held = {name: FclBody(scene.bodies[name].parts) for name in scene.movable}
        self._T_tool_hand = robot.T_hand_tool.inverse().matrix
        self._boxes: dict[Placed, tuple[Array, Array]] = {}
        self._open: dict[float, _Movers] = {}
        self._attached: dict[Placed, _Movers] = {}

    def hits(
        self,
        tools: Sequence[Float[Array, "4 4"]],
        opening: float,
        attachment: Attachment | None,
        others: Iterable[Placed],
    ) -> str | None:
        """Return the first of `others` that the hand hits at one of the poses.

        Args:
            tools: T_world_tool (4, 4).
            opening: Of the fingers, metres.
            attachment: The body in the hand, or None.
            others: Bodies by name and pose.
        """
        around = list(others)
        if not around:
            return None

        owners, lows, highs = self._parts(around)
        movers = [
            self._movers(opening),
            *([] if attachment is None else [self._holding(attachment)]),
        ]
        radii = np.concatenate([group.radii for group in movers])
        own = np.concatenate([group.centres for group in movers])
        parts = [part for group in movers for part in group.parts]

        at = np.array(tools)
        centres = own @ at[:, :3, :3].transpose(0, 2, 1) + at[:, None, :3, 3]
        gaps = np.maximum(
            np.maximum(lows[:, None] - centres[:, None], centres[:, None] - highs[:, None]), 0.0
        )
        near = np.nonzero(np.einsum("tpmi,tpmi->tpm", gaps, gaps) <= radii * radii)

        # Where each frame is; the same array, so that a part is placed once.
        placed: dict[tuple[int, int], Array] = {}
        for t, index, k in zip(*(axis.tolist() for axis in near), strict=True):
            name, pose, part = owners[index]
            body, number, frame = parts[k]
            matrix = placed.get((t, id(frame)))
            if matrix is None:
                matrix = placed[t, id(frame)] = tools[t] @ frame
            if touch(body.place(number, matrix), self._bodies[name].place(part, pose.matrix), 0.0):
                return name

        return None

    def swept(
        self, tools: Float[Array, "m 4 4"], openings: Sequence[float], attachment: Attachment
    ) -> SweptBoxes:
        """Box all that the hand, at any of the openings, and the body in it touch at the poses
        T_world_tool (m, 4, 4).
        """
        movers = [*(self._movers(opening) for opening in openings), self._holding(attachment)]
        return SweptBoxes.union(swept_balls(tools, group.centres, group.radii) for group in movers)

    def meets(
        self, opening: float, T_body_tool: Float[Array, "4 4"], other: HandCollisions,
        its_opening: float, T_body_other: Float[Array, "4 4"],
    ) -> bool:  # fmt: skip
        """Check whether the hand meets another one, each at its opening, metres, and its tool's
        pose.
        """
        own, its = self._movers(opening), other._movers(its_opening)
        at, there = _moved(own.centres, T_body_tool), _moved(its.centres, T_body_other)
        near = np.linalg.norm(at[:, None] - there[None], axis=2) <= own.radii[:, None] + its.radii
        for i, j in zip(*(axis.tolist() for axis in np.nonzero(near)), strict=True):
            (body, number, frame), (another, its_number, its_frame) = own.parts[i], its.parts[j]
            first = body.place(number, T_body_tool @ frame)
            if touch(first, another.place(its_number, T_body_other @ its_frame), 0.0):
                return True
        return False

    def _parts(self, around: list[Placed]) -> tuple[list[tuple[str, Pose, int]], Array, Array]:
        owners: list[tuple[str, Pose, int]] = []
        lows: list[Array] = []
        highs: list[Array] = []
        for name, pose in around:
            if (name, pose) not in self._boxes:
                boxes = [bounds((part,), pose) for part in self._scene.bodies[name].parts]
                self._boxes[name, pose] = (
                    np.array([low for low, _ in boxes]),
                    np.array([high for _, high in boxes]),
                )
            low, high = self._boxes[name, pose]
            owners += [(name, pose, part) for part in range(len(low))]
            lows.append(low)
            highs.append(high)
        return owners, np.concatenate(lows), np.concatenate(highs)

    def _movers(self, opening: float) -> _Movers:
        """Collect the parts of the hand, the wrist and the fingers."""
        if opening not in self._open:
            fingers = [
                (body, link.parts, self._T_tool_hand @ _finger(joint, opening))
                for body, link, joint in zip(
                    self._fingers, self._robot.finger_links, self._robot.fingers, strict=True
                )
            ]
            self._open[opening] = _Movers.of(
                [(self._hand, self._parts_of_hand, self._T_tool_hand), *fingers]
            )
        return self._open[opening]

    def _holding(self, attachment: Attachment) -> _Movers:
        """Collect the parts of the body in the hand."""
        name, T_tool_body = attachment.body, attachment.T_tool_body
        if (name, T_tool_body) not in self._attached:
            parts = self._scene.bodies[name].parts
            self._attached[name, T_tool_body] = _Movers.of(
                [(self._held[name], parts, T_tool_body.matrix)]
            )
        return self._attached[name, T_tool_body]


@dataclass(frozen=True, eq=False)
class _Movers:
    """Parts that move with the tool, with balls around them.

    Attributes:
        parts: Of which body, which part, and the body's T_tool_body (4, 4).
        centres: Of the balls in the tool's frame, (n, 3).
        radii: Of the balls, metres, (n,).
    """

    parts: list[tuple[FclBody, int, Array]]
    centres: Array
    radii: Array

    @classmethod
    def of(cls, bodies: Sequence[tuple[FclBody, tuple[Part, ...], Array]]) -> _Movers:
        """Bound all parts of bodies at their T_tool_body by balls."""
        parts: list[tuple[FclBody, int, Array]] = []
        centres: list[Array] = []
        radii: list[float] = []
        for body, shapes, T_tool_body in bodies:
            for number, part in enumerate(shapes):
                low, high = bounds((part,), Pose())
                parts.append((body, number, T_tool_body))
                centres.append(T_tool_body[:3, :3] @ ((low + high) / 2) + T_tool_body[:3, 3])
                radii.append(float(np.linalg.norm(high - low)) / 2 + RADIUS_SLACK_M)
        return cls(parts, np.array(centres), np.array(radii))


def _moved(points: Array, T: Array) -> Array:
    return points @ T[:3, :3].T + T[:3, 3]


def _finger(joint: Joint, opening: float) -> Array:
    """Compute T_hand_finger (4, 4) of a finger that stands at half the opening."""
    matrix = joint.origin.matrix.copy()
    matrix[:3, 3] += joint.origin.rotation @ np.array(joint.axis) * (opening / 2)
    return matrix


def _core(robot: Robot) -> list[Part]:
    """Compute the largest cylinder about the last joint's axis within each part of the link before,
    in the last link's frame.

    A half-space n x <= d holds a cylinder of radius r and heights [low, high] along the unit axis u
    when |n - (n u) u| r + (n u) h <= d at both ends.
    """
    joint = robot.joints[-1]
    if joint.kind == "prismatic" or len(robot.joints) < 2:
        return []
    axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
    inverse = joint.origin.inverse()
    cores: list[Part] = []
    for part in robot.link(robot.joints[-2].child).parts:
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
            high, low = (
                float((room[up] / slopes[up]).min()),
                float((room[down] / slopes[down]).max()),
            )
            best = max(best, (radius**2 * max(high - low, 0.0), float(radius), low, high))

        volume, radius, low, high = best
        if volume > 0.0:
            matrix = _along(axis)
            matrix[:3, 3] = axis * (low + high) / 2
            cores.append(Part(Cylinder(radius, high - low), Pose.from_matrix(matrix)))

    return cores


def _along(axis: Array) -> Array:
    """Return a frame (4, 4) whose z is a unit vector."""
    other = np.cross(np.eye(3)[int(np.argmin(np.abs(axis)))], axis)
    matrix = np.eye(4)
    matrix[:3, 0] = other / np.linalg.norm(other)
    matrix[:3, 1], matrix[:3, 2] = np.cross(axis, matrix[:3, 0]), axis
    return matrix
