"""Closing the hand on a body: which proposed hand poses are real grasps. Decided by exact
collision.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.tables import TableRows, pose_rows
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.ray_crossings import ConvexUnion
from tamp.geometric.streams.hand_kernels import closed

if TYPE_CHECKING:
    from jaxtyping import Float

FRICTION_CONE_RAD = math.atan(0.4)
"""Half angle of the friction cone at a contact, radians."""

HAND_CLEARANCE_M = 0.001
"""Metres that the open hand needs beside what it grasps, on both sides together."""

ROOMY_CLEARANCE_M = 0.005
"""A grasp that leaves the open hand less is weak: where the arm is not exact, a finger may push the
body away."""

OPENING_SLACK_M = 5e-4
"""Metres by which the opening exceeds the body's width, so that holding is not a collision."""

PAD_GIVE_M = 1.5e-3
"""A pad, which gives a little, touches what is within this of its plane, metres."""

CLEAR_APPROACH = 0.10
"""The open hand must be free of the body while it draws back this far, metres."""

BACK_STEP_M = 0.02
"""Steps in which it is looked at there, metres."""

PAD_POINTS_M = np.array([(x, 0.0, z) for x in (-0.006, 0.0, 0.006) for z in (-0.006, 0.0, 0.006)])
"""Sample points of a pad (9, 3) around the tool's origin: it is 17 mm wide and high."""


@dataclass(frozen=True, eq=False)
class Closed:
    """A closed hand: T_body_tool (4, 4) centred between the contacts, the opening while holding,
    metres, and where each pad touches, points (k, 3) in the tool's frame.
    """

    T_body_tool: Array
    opening: float
    patches: tuple[Array, Array]


def _row(T: Array) -> Float[Array, " 12"]:
    """Return a pose (4, 4) as the kernels take it."""
    return np.concatenate([T[:3, :3].ravel(), T[:3, 3]])


class GraspChecker:
    """The hand and one body, as the compiled kernels take them."""

    def __init__(self, body: Body, solid: ConvexUnion, robot: Robot) -> None:
        self._solid, self._robot = solid, robot
        rows = TableRows()
        T_tool_hand = robot.T_hand_tool.inverse().matrix
        groups, parts, poses, along = [0], [], [], []
        fingers = zip(robot.finger_links, robot.fingers, strict=True)
        links = [(link, joint.origin.matrix, np.array(joint.axis)) for link, joint in fingers]
        for link, T_hand_link, axis in [*links, (robot.link(robot.hand), np.eye(4), np.zeros(3))]:
            T_tool_link = T_tool_hand @ T_hand_link
            parts += [rows.row(part) for part in link.parts]
            poses += [T_tool_link @ part.pose.matrix for part in link.parts]
            along += [T_tool_link[:3, :3] @ axis for _ in link.parts]
            groups.append(len(parts))

        body_rows = np.array([rows.row(part) for part in body.parts])
        body_poses = pose_rows(np.array([part.pose.matrix for part in body.parts]))
        self._tables = (
            np.array(groups), np.array(parts), pose_rows(np.array(poses)), np.array(along),
            body_rows, body_poses, rows.vertices(),
        )  # fmt: skip

    @property
    def widest(self) -> float:
        """Return the largest width that is grasped, metres."""
        return self._robot.opening - HAND_CLEARANCE_M

    def close(self, T_body_tool: Float[Array, "4 4"]) -> Closed | None:
        """Close the hand at a pose (4, 4).

        None when the open hand hits the body there or while drawing back along its axis, when the
        fingers meet nothing, or when the contacts do not oppose each other within the friction
        cone.
        """
        opening = self._robot.opening
        fits, left, right = closed(_row(T_body_tool), opening, 0.0, BACK_STEP_M, *self._tables)
        if not fits or left + right > self.widest:
            return None

        T = T_body_tool.copy()
        T[:3, 3] += T[:3, 1] * (left - right) / 2
        width = left + right + OPENING_SLACK_M
        patches = self._opposed(T, width)
        if (
            patches is None
            or not closed(_row(T), opening, CLEAR_APPROACH, BACK_STEP_M, *self._tables)[0]
        ):
            return None
        return Closed(T, width, patches)

    def _opposed(self, T_body_tool: Array, opening: float) -> tuple[Array, Array] | None:
        """Return where both pads touch the body, opposite each other and squarely enough not to
        slip; None where not.
        """
        closing = T_body_tool[:3, 1]
        origins = PAD_POINTS_M @ T_body_tool[:3, :3].T + T_body_tool[:3, 3]
        starts, ends, start_planes, end_planes = self._solid.crossings(origins, closing)
        between = (ends > starts) & (starts < opening / 2) & (ends > -opening / 2)
        patches: list[Array] = []
        for side, places, planes in ((1.0, ends, end_planes), (-1.0, -starts, start_planes)):
            reach = np.where(between, places, -np.inf)
            outermost = np.argmax(reach, axis=1)
            rows = np.arange(len(PAD_POINTS_M))
            touching = reach[rows, outermost] > opening / 2 - PAD_GIVE_M
            normals = self._solid.normals(planes[rows, outermost])
            square = touching & (side * normals @ closing > math.cos(FRICTION_CONE_RAD))
            if square.sum() < 3:
                return None
            patches.append(PAD_POINTS_M[square])
        if np.linalg.norm(patches[0].mean(axis=0) - patches[1].mean(axis=0)) >= 0.005:
            return None
        return patches[0], patches[1]
