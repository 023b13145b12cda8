"""The robot's part of the kernels' tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.tables import FRAME, ON_FLOOR, TableRows, pose_rows
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.spheres import link_covers
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class RobotParts:
    """The robot's convex parts with the fingers at some opening and perhaps a body attached.

    Attributes:
        rows, poses, pairs: As in `Tables`.
        owners: For each row the name of its link, or of the attached body, and which part of that
            it is.
    """

    rows: Array
    poses: Array
    pairs: Array
    owners: tuple[tuple[str, int], ...]


class RobotTables:
    """Prepares a robot's rows once and completes them for an opening and an attached body.

    Args:
        robot: The robot.
        collected: Where its vertices and leaves go.
    """

    def __init__(self, robot: Robot, collected: TableRows) -> None:
        self.robot = robot
        origins = [joint.origin for joint in robot.joints]
        origins[0] = robot.T_base_arm @ origins[0]
        poses = pose_rows(np.array([origin.matrix for origin in origins]))
        self.joints = np.column_stack([poses, np.array(robot.prismatic, dtype=np.float64)])

        hand = robot.grippers
        covers = link_covers(robot)
        owners, rows, matrices = [], [], []
        for link in robot.links:
            frame, offset = robot.frame_of(link.name)
            for k, part in enumerate(link.parts):
                row = collected.row(part, covers.get((link.name, k)))
                row[FRAME], row[ON_FLOOR] = frame, float(frame == 0)
                owners.append((link.name, k))
                rows.append(row)
                matrices.append((offset @ part.pose).matrix)

        self._owners, self._rows = tuple(owners), np.array(rows)
        self._poses, self._slides = self._fingers(np.array(matrices))

        pairs = [
            (a, b)
            for b in range(len(rows))
            for a in range(b)
            if _checked(owners[a][0], owners[b][0], robot)
        ]
        self._pairs = np.array(pairs, dtype=np.float64).reshape(-1, 2)

        self._beside_hand = [a for a, (name, _) in enumerate(owners) if name not in hand]
        self._T_flange_tool = (robot.T_flange_hand @ robot.T_hand_tool).matrix

    def complete(
        self,
        opening: float,
        held: str | None,
        T_tool_parts: Float[Array, "k 4 4"],
        held_rows: Float[Array, "k width"],
    ) -> RobotParts:
        """Complete the rows with the fingers at `opening` metres and a body in the hand.

        The hand, the fingers and the body that they hold are one group, not checked within itself.

        Args:
            opening: Metres.
            held: The body's name, or None.
            T_tool_parts: (k, 4, 4) its parts in the tool's frame; k = 0 for none.
            held_rows: (k, WIDTH) its parts.
        """
        first = len(self._rows)
        rows = np.concatenate([self._rows, held_rows])
        rows[first:, FRAME] = len(self.robot.joints)
        poses = np.concatenate([self._poses, pose_rows(self._T_flange_tool @ T_tool_parts)])
        poses[:first, 9:] += self._slides * (opening / 2)
        count = len(held_rows)
        pairs = np.array(
            [(a, first + k) for k in range(count) for a in self._beside_hand], dtype=np.float64
        )
        owners = (
            self._owners if held is None else (*self._owners, *((held, k) for k in range(count)))
        )
        return RobotParts(rows, poses, np.concatenate([self._pairs, pairs.reshape(-1, 2)]), owners)

    def _fingers(self, matrices: Array) -> tuple[Array, Array]:
        """Compute poses (n, 12) with the fingers closed, and how far (n, 3) each part slides per
        metre of half the opening.
        """
        slides = np.zeros((len(matrices), 3))
        hand = self.robot.T_flange_hand.matrix
        for link, joint in zip(self.robot.finger_links, self.robot.fingers, strict=True):
            T_flange_finger = hand @ joint.origin.matrix
            for i, (name, k) in enumerate(self._owners):
                if name == link.name:
                    matrices[i] = T_flange_finger @ link.parts[k].pose.matrix
                    slides[i] = T_flange_finger[:3, :3] @ np.array(joint.axis)
        return pose_rows(matrices), slides


def _checked(first: str, second: str, robot: Robot) -> bool:
    if first == second or (min(first, second), max(first, second)) in robot.allowed:
        return False
    stand = (first in robot.still_links, second in robot.still_links)
    return not all(stand) and not (any(stand) and {first, second} & {robot.base, robot.foot})
