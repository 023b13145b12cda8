"""Collision of bodies with each other and, through arrangements, with the robot."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.collision.fcl_pairs import FLOOR_PART, ExactPairs
from tamp.geometric.collision.robot_tables import RobotParts, RobotTables
from tamp.geometric.collision.tables import (
    HIGH,
    LOW,
    PART_COLUMNS,
    TableRows,
    Tables,
    pose_rows,
    world_box,
)
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene

Corner = Sequence[float]

_MAX_REMEMBERED = 4096
"""How many placed bodies and robots are remembered before the memory is emptied."""


@dataclass(frozen=True)
class Attachment:
    """A body held by the hand.

    Attributes:
        T_tool_body: Where it is held.
        opening: Of the fingers while holding, metres.
    """

    body: str
    T_tool_body: Pose
    opening: float


@dataclass(frozen=True, eq=False)
class _Placed:
    """A body at a pose: rows (k, PART_COLUMNS) and poses (k, 12) of its parts, their world boxes,
    the box of all.
    """

    rows: Array
    poses: Array
    lows: list[Corner]
    highs: list[Corner]
    low: Corner
    high: Corner
    matrix: Array


class Collisions:
    """All that can collide in a scene, prepared once.

    Args:
        scene: Its fixed bodies stand still; movable ones are where the callers say.
        robot: The robot.
        kinematics: Of the same robot; used for the pairs that FCL decides.
    """

    def __init__(self, scene: Scene, robot: Robot, kinematics: Kinematics) -> None:
        self.scene = scene
        self._kinematics = kinematics
        collected = TableRows()
        self._robot = RobotTables(robot, collected)
        self._rows = {
            name: np.array([collected.row(p) for p in body.parts])
            for name, body in scene.bodies.items()
        }
        self._part_matrices = {
            name: np.array([part.pose.matrix for part in body.parts])
            for name, body in scene.bodies.items()
        }

        self._vertices, self._leaves = collected.vertices(), collected.leaves()
        self._room = np.array([*scene.room.x, *scene.room.y], dtype=np.float64)
        self._fcl = {name: FclBody(body.parts) for name, body in scene.bodies.items()}
        self._held = {name: FclBody(scene.bodies[name].parts) for name in scene.movable}
        self._links = {link.name: FclBody(link.parts) for link in robot.links}
        self._floor = FclBody((FLOOR_PART,))

        self._placed: dict[tuple[str, Pose], _Placed] = {}
        self._completed: dict[tuple[float, Attachment | None], RobotParts] = {}
        self._fixed = [(name, self._place(name, scene.bodies[name].pose)) for name in scene.fixed]

    def pair(
        self, body: str, pose: Pose, other: str, other_pose: Pose, padding: float = 0.0
    ) -> bool:
        """Check whether two bodies at these poses are nearer than `padding` metres (with 0:
        intersect); exact.
        """
        return self._touch(
            body, self._place(body, pose), other, self._place(other, other_pose), padding
        )

    def between(self, body: str, pose: Pose, others: Mapping[str, Pose]) -> str | None:
        """Return the first of `others` at their poses, or of the fixed bodies, that the body at
        `pose` intersects; exact.
        """
        placed = self._place(body, pose)
        for other, other_pose in others.items():
            if other != body and self._touch(body, placed, other, self._place(other, other_pose)):
                return other
        for other, fixed in self._fixed:
            if other != body and self._touch(body, placed, other, fixed):
                return other
        return None

    def arrangement(
        self,
        poses: Mapping[str, Pose],
        attachment: Attachment | None = None,
        opening: float | None = None,
        fixed: bool = True,
        without: Container[str] = (),
    ) -> Arrangement:
        """Set up the robot among the fixed bodies (if `fixed`) and the movable ones at `poses`.

        Args:
            poses: T_world_body by name; the attached body is left out.
            attachment: What the hand holds.
            opening: Of the fingers, metres; by default the attachment's, or fully open.
            without: Fixed bodies that are left out.
        """
        held = attachment.body if attachment else None
        around = [(name, self._place(name, pose)) for name, pose in poses.items() if name != held]
        if fixed:
            around = [one for one in self._fixed if one[0] not in without] + around
        if opening is None:
            opening = attachment.opening if attachment else self._robot.robot.opening

        parts = self._complete(opening, attachment)
        tables = Tables(
            self._room,
            self._robot.joints,
            self._vertices,
            self._leaves,
            parts.rows,
            parts.poses,
            parts.pairs,
            np.concatenate([_NO_ROWS, *(placed.rows for _, placed in around)]),
            np.concatenate([_NO_POSES, *(placed.poses for _, placed in around)]),
        )

        exact = ExactPairs(
            self._kinematics,
            parts,
            opening,
            self._links,
            self._floor,
            (self._held[attachment.body], attachment.T_tool_body.matrix) if attachment else None,
            [(name, self._fcl[name], placed.matrix, len(placed.rows)) for name, placed in around],
        )

        return Arrangement(tables, exact)

    def _complete(self, opening: float, attachment: Attachment | None) -> RobotParts:
        key = (opening, attachment)
        parts = self._completed.get(key)
        if parts is None:
            if len(self._completed) >= _MAX_REMEMBERED:
                self._completed.clear()
            if attachment is None:
                parts = self._robot.complete(opening, None, np.zeros((0, 4, 4)), _NO_ROWS)
            else:
                T_tool_parts = attachment.T_tool_body.matrix @ self._part_matrices[attachment.body]
                parts = self._robot.complete(
                    opening, attachment.body, T_tool_parts, self._rows[attachment.body]
                )
            self._completed[key] = parts
        return parts

    def _place(self, name: str, pose: Pose) -> _Placed:
        key = (name, pose)
        placed = self._placed.get(key)
        if placed is None:
            if len(self._placed) >= _MAX_REMEMBERED:
                self._placed.clear()
            poses = pose_rows(pose.matrix @ self._part_matrices[name])
            rows = self._rows[name].copy()
            low, high = world_box(rows, poses)
            rows[:, LOW : LOW + 3], rows[:, HIGH : HIGH + 3] = low, high
            corners = tuple(low.min(axis=0).tolist()), tuple(high.max(axis=0).tolist())
            placed = self._placed[key] = _Placed(
                rows, poses, low.tolist(), high.tolist(), *corners, pose.matrix
            )
        return placed

    def _touch(self, first: str, a: _Placed, second: str, b: _Placed, padding: float = 0.0) -> bool:
        if not _overlap(a.low, a.high, b.low, b.high, padding):
            return False
        for i, (a_low, a_high) in enumerate(zip(a.lows, a.highs, strict=True)):
            if not _overlap(a_low, a_high, b.low, b.high, padding):
                continue
            for j, (b_low, b_high) in enumerate(zip(b.lows, b.highs, strict=True)):
                if _overlap(a_low, a_high, b_low, b_high, padding) and touch(
                    self._fcl[first].place(i, a.matrix),
                    self._fcl[second].place(j, b.matrix),
                    padding,
                ):
                    return True
        return False


_NO_ROWS, _NO_POSES = np.zeros((0, PART_COLUMNS)), np.zeros((0, 12))


def _overlap(a_low: Corner, a_high: Corner, b_low: Corner, b_high: Corner, padding: float) -> bool:
    return all(
        a_low[i] <= b_high[i] + padding and b_low[i] <= a_high[i] + padding for i in range(3)
    )
