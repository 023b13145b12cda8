"""Inverse kinematics in closed form, swept over the last joint of an arm of seven."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from eaik.IK_HP import HPRobot

from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.closed_form_kernels import keep_valid
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

FK_TOLERANCE = 1e-6
"""Metres, and entries of the rotation matrix, by which a solution's FK may miss the pose."""


class ClosedForm:
    """All joint angles that put the tool at a pose.

    With the last joint fixed, EAIK (Ostermeier et al. 2024) solves the other six in closed form, as
    the shoulder is spherical: 6 us a value. The values of the last joint go from coarse to fine
    (van der Corput's sequence), so a search may stop early, and one that found nothing goes on with
    finer values.

    Args:
        coarse: How many values of the last joint every search goes through.
        fine: How many one that found nothing goes on to.
    """

    def __init__(self, chain: Chain, coarse: int = 24, fine: int = 192) -> None:
        self._stages = (range(coarse), range(coarse, fine))
        self._chain = chain
        self.lower, self.upper = chain.lower, chain.upper
        self._origins = origins = chain.origins
        self._T_tool_flange = np.linalg.inv(chain.T_flange_tool)
        self._axes, self._offsets, self._unturn = _screws(origins, chain.T_flange_tool)
        low, high = self.lower[6], self.upper[6]
        self._sevenths = low + (high - low) * np.array(
            [_van_der_corput(i) for i in range(1, fine + 1)]
        )
        self._solvers: list[HPRobot | None] = [None] * fine
        self._reach = _reach(origins)

    def solve(
        self,
        T_base_tool: Float[Array, "4 4"],
        enough: int | None = None,
        rng: np.random.Generator | None = None,
    ) -> Float[Array, "n 7"]:
        """Solve inverse kinematics: joint angles (n, 7) within the limits that put the tool at
        T_base_tool (4, 4), in a deterministic order.

        Each solution's FK was checked to 1e-6. No solution gives shape (0, 7).

        Args:
            enough: Stop once so many are found.
            rng: Shift the last joint's values at random, so that another call on the same pose
                finds others.
        """
        sevenths = self._sevenths
        if rng is not None:
            low, high = self.lower[6], self.upper[6]
            sevenths = low + (sevenths - low + rng.uniform(0.0, high - low)) % (high - low)

        T = T_base_tool.copy()
        T[:3, :3] = T[:3, :3] @ self._unturn
        found: list[Array] = []
        count = 0

        for stage in self._stages:
            batch: list[Array] = []
            for index in self._within_reach(T_base_tool, sevenths, stage):
                if rng is None:
                    solver = self._solvers[index] = self._solvers[index] or self._solver(
                        sevenths[index]
                    )
                else:
                    solver = self._solver(sevenths[index])
                solution = solver.IK(T)
                if len(solution.Q) and not all(solution.is_LS):
                    batch.append(solution.Q)
                    if enough is not None or stage.start > 0:
                        found.append(self._valid(T_base_tool, batch))
                        count += len(found[-1])
                        batch = []
                        if count >= (enough or 1):
                            break
            if batch:
                found.append(self._valid(T_base_tool, batch))
                count += len(found[-1])
            if count > 0:
                break

        return np.concatenate(found) if found else np.empty((0, 7))

    def _valid(self, T_base_tool: Array, batch: list[Array]) -> Array:
        candidates = np.ascontiguousarray(np.concatenate(batch))
        return keep_valid(*self._chain.arrays, T_base_tool, candidates, FK_TOLERANCE)

    def _solver(self, seventh: float) -> HPRobot:
        return HPRobot(self._axes, self._offsets, fixed_axes=[(6, float(seventh))])

    def _within_reach(self, T_base_tool: Array, sevenths: Array, stage: range) -> list[int]:
        """Return indices of the values for which the wrist, where axes 5 and 6 meet, is neither too
        far nor too near.
        """
        T_base_flange = T_base_tool @ self._T_tool_flange
        q = sevenths[stage.start : stage.stop]
        # joint 6's frame in the flange's, by inverting joint 7: Rz(-q7) applied to the origin's
        # inverse translation
        back = -self._origins[6, :3, :3].T @ self._origins[6, :3, 3]
        x, y = back[0] * np.cos(q) + back[1] * np.sin(q), back[1] * np.cos(q) - back[0] * np.sin(q)
        wrist = (
            T_base_flange[:3, 3]
            + np.column_stack([x, y, np.full_like(x, back[2])]) @ T_base_flange[:3, :3].T
        )
        distance = np.linalg.norm(wrist - self._origins[0, :3, 3], axis=1)
        near, far = self._reach
        return [
            stage.start + int(i) for i in np.flatnonzero((distance >= near) & (distance <= far))
        ]


def _screws(origins: Array, T_flange_tool: Array) -> tuple[Array, Array, Array]:
    """Return the arm at angles 0 as EAIK wants it: axes (7, 3), offsets between them (8, 3), the
    tool's inverse rotation.
    """
    T = np.eye(4)
    axes, points = [], [np.zeros(3)]
    for origin in origins:
        T = T @ origin
        axes.append(T[:3, 2])
        points.append(T[:3, 3])
    tool = T @ T_flange_tool
    points.append(tool[:3, 3])
    return np.array(axes), np.diff(np.array(points), axis=0), tool[:3, :3].T


def _reach(origins: Array) -> tuple[float, float]:
    """Return the least and the largest distance between shoulder (axes 1 to 3) and wrist (axes 5
    and 6), metres.
    """
    upper = origins[2, :3, 3]
    distances = []
    for angle in np.linspace(-math.pi, math.pi, 721):
        cos, sin = math.cos(angle), math.sin(angle)
        turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        elbow = origins[3, :3, 3] + origins[3, :3, :3] @ turn @ origins[4, :3, 3]
        distances.append(np.linalg.norm(origins[2, :3, :3].T @ upper + elbow))
    return min(distances) - 1e-4, max(distances) + 1e-4


def _van_der_corput(index: int) -> float:
    value, scale = 0.0, 0.5
    while index:
        value += scale * (index % 2)
        index, scale = index // 2, scale / 2
    return value
