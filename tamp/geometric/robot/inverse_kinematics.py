"""Inverse kinematics of an arm: in closed form where that is known, else numerical."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot import arm_kernels
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


class ArmIK:
    """All joint positions that put the tool at a pose.

    Args:
        robot: Its arm; what it says of a locked joint decides how it is solved.
        coarse, fine: Values of the locked joint that are gone through at first, and in all
            (`closed_form`).
    """

    def __init__(self, robot: Robot, coarse: int = 24, fine: int = 192) -> None:
        self._chain = Chain.of(robot)
        self.lower, self.upper = self._chain.lower, self._chain.upper
        # What is not needed is neither imported nor compiled.
        if robot.locked is not None and robot.locked == len(robot.joints) - 1 == 6:
            from tamp.geometric.robot.closed_form import ClosedForm

            self._solver = ClosedForm(self._chain, coarse, fine)
        else:
            from tamp.geometric.robot.numerical import Numerical

            self._solver = Numerical(self._chain)

    def solve(
        self,
        T_base_tool: Float[Array, "4 4"],
        enough: int | None = None,
        rng: np.random.Generator | None = None,
    ) -> Float[Array, "k joints"]:
        """Solve inverse kinematics: joint positions (k, n) within the limits that put the tool at
        T_base_tool (4, 4), in a deterministic order.

        Each solution's FK was checked to 1e-6. No solution gives shape (0, n).

        Args:
            enough: Stop once so many are found.
            rng: Begin elsewhere, so that another call on the same pose finds others.
        """
        return self._solver.solve(T_base_tool, enough, rng)

    def follow(
        self,
        T_base_tools: Sequence[Float[Array, "4 4"]],
        q_start: Float[Array, " joints"],
        jump: float = 0.3,
    ) -> Float[Array, "k joints"] | None:
        """Return joint positions (k, n) along tool poses (4, 4) that lie close together, continuing
        from q_start.

        Each pose is met to 1e-6 within the limits; None when one cannot be, or when a joint would
        have to move more than `jump` radians (metres) from one pose to the next.
        """
        targets = np.ascontiguousarray(T_base_tools, dtype=float).reshape(-1, 4, 4)
        start = np.ascontiguousarray(q_start, dtype=float)
        path, reached = arm_kernels.follow(*self._chain.arrays, targets, start, jump)
        return path if reached == len(targets) else None
