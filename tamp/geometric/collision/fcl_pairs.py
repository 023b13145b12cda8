"""Exact collision checks by FCL of one pair of an arrangement."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.collision.kernels import FLOOR, ROOM, SELF
from tamp.geometric.collision.robot_tables import RobotParts
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part

if TYPE_CHECKING:
    from jaxtyping import Float

FLOOR_PART = Part(Box((40.0, 40.0, 1.0)), Pose((0.0, 0.0, -0.5)))


class ExactPairs:
    """Decides pairs by python-fcl, placing only the two parts in question.

    Args:
        kinematics: Of the robot.
        parts: The robot's parts.
        opening: Of the fingers, metres.
        links: FCL objects by link name.
        floor: The floor's.
        held: The attached body's objects and its pose in the tool's frame (4, 4), or None.
        obstacles: In the order of the obstacles' rows: a body's name, objects, T_world_body (4, 4),
            number of parts.
    """

    def __init__(
        self,
        kinematics: Kinematics,
        parts: RobotParts,
        opening: float,
        links: Mapping[str, FclBody],
        floor: FclBody,
        held: tuple[FclBody, Array] | None,
        obstacles: list[tuple[str, FclBody, Array, int]],
    ) -> None:
        self._kinematics = kinematics
        self._parts = parts
        self._opening = opening
        self._links = links
        self._held = held
        self._obstacles = obstacles
        self._floor = floor

    def nearer(self, conf: Float[Array, " conf"], part: int, other: int, padding: float) -> bool:
        """Check whether that pair (as in `edge_check.pair_of`) is nearer than `padding` metres at
        `conf`; 0: intersects.
        """
        if other == ROOM:
            return True
        poses = self._kinematics.link_poses(conf, self._opening)
        first = self._place(poses, conf, part)
        if other == FLOOR:
            second = self._floor.place(0, np.eye(4))
        elif other <= SELF:
            second = self._place(poses, conf, SELF - other)
        else:
            _, body, matrix, k = self._row(other)
            second = body.place(k, matrix)
        return touch(first, second, padding)

    def names(self, part: int, other: int) -> tuple[str, str]:
        """Return the names of that pair."""
        first = self._parts.owners[part][0]
        if other <= SELF:
            return first, self._parts.owners[SELF - other][0]
        if other < 0:
            return first, "floor" if other == FLOOR else "room"
        return first, self._row(other)[0]

    def _row(self, other: int) -> tuple[str, FclBody, Array, int]:
        """Return the body of an obstacle's row: its name, objects, pose, and which part of it the
        row is.
        """
        first = 0
        for name, body, matrix, count in self._obstacles:
            if other < first + count:
                return name, body, matrix, other - first
            first += count
        raise IndexError(f"no obstacle has row {other}")

    def _place(self, poses: Mapping[str, Array], conf: Array, part: int):
        name, k = self._parts.owners[part]
        if name in self._links:
            return self._links[name].place(k, poses[name])
        if self._held is None:
            raise ValueError(f"no body is attached, but part {part} belongs to {name}")
        body, T_tool_body = self._held
        return body.place(k, self._kinematics.tool(conf) @ T_tool_body)
