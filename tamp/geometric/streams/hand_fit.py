"""Closing the hand on a body: which proposed hand poses are real grasps. Decided by exact
collision.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.ray_crossings import ConvexUnion

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


class GraspChecker:
    """The hand and one body, as FCL objects in the body's frame."""

    def __init__(self, body: Body, solid: ConvexUnion, robot: Robot) -> None:
        self._solid, self._robot = solid, robot
        self._body = FclBody(body.parts)
        self._parts = [self._body.place(index, np.eye(4)) for index in range(len(body.parts))]
        hand, (left, right) = robot.link(robot.hand), robot.finger_links
        self._hand, self._left, self._right = (
            FclBody(hand.parts),
            FclBody(left.parts),
            FclBody(right.parts),
        )
        self._T_tool_hand = robot.T_hand_tool.inverse().matrix

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
        widest = self._robot.opening / 2
        if self._hits(T_body_tool, widest):
            return None
        left, right = (self._first_contact(T_body_tool, finger) for finger in (0, 1))
        if left is None or right is None or left + right > self.widest:
            return None
        T = T_body_tool.copy()
        T[:3, 3] += T[:3, 1] * (left - right) / 2
        opening = left + right + OPENING_SLACK_M
        patches = self._opposed(T, opening)
        if patches is None:
            return None
        for back in np.arange(0.0, CLEAR_APPROACH + 1e-9, 0.02):
            moved = T.copy()
            moved[:3, 3] -= back * T[:3, 2]
            if self._hits(moved, widest):
                return None
        return Closed(T, opening, patches)

    def _hits(self, T_body_tool: Array, finger: float) -> bool:
        """Check whether the hand with both fingers at `finger` metres from the middle touches the
        body.
        """
        if self._touches(self._hand, T_body_tool @ self._T_tool_hand):
            return True
        return any(self._finger_touches(T_body_tool, index, finger) for index in (0, 1))

    def _finger_touches(self, T_body_tool: Array, index: int, position: float) -> bool:
        joint = self._robot.fingers[index]
        T_hand_finger = joint.origin.matrix.copy()
        T_hand_finger[:3, 3] += T_hand_finger[:3, :3] @ np.array(joint.axis) * position
        return self._touches(
            (self._left, self._right)[index], T_body_tool @ self._T_tool_hand @ T_hand_finger
        )

    def _touches(self, link: FclBody, T_body_link: Array) -> bool:
        items = (link.place(index, T_body_link) for index in range(len(link.objects)))
        return any(touch(item, part, 0.0) for item in items for part in self._parts)

    def _first_contact(self, T_body_tool: Array, index: int) -> float | None:
        """Find how far from the middle a closing finger meets the body, to 0.1 mm; None when it
        does not.
        """
        free, blocked = self._robot.opening / 2, -0.02
        # Walk first: a thin wall could be jumped over.
        for position in np.arange(free, blocked, -0.005):
            if self._finger_touches(T_body_tool, index, position):
                blocked = position
                break
            free = position
        else:
            return None
        while free - blocked > 1e-4:
            middle = (free + blocked) / 2
            if self._finger_touches(T_body_tool, index, middle):
                blocked = middle
            else:
                free = middle
        return free

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
