"""An arm as the arrays that compiled kinematics take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class Chain:
    """An arm of n joints, from the robot's base to the tool.

    Attributes:
        origins: Shape (n, 4, 4): each joint's frame at 0 in the one before, the first in the base.
        slides: Shape (n,): 1 for a joint that slides along its z, 0 for one that turns about it.
        T_flange_tool: The tool in the last joint's frame, shape (4, 4).
        lower, upper: Shape (n,), metres and radians.
        home: Shape (n,).
    """

    origins: Array
    slides: Array
    T_flange_tool: Array
    lower: Array
    upper: Array
    home: Array

    @classmethod
    def of(cls, robot: Robot) -> Chain:
        """Take the arm of a robot."""
        origins = np.array([joint.origin.matrix for joint in robot.joints])
        origins[0] = robot.T_base_arm.matrix @ origins[0]
        return cls(
            origins=origins,
            slides=np.array(robot.prismatic, dtype=np.float64),
            T_flange_tool=robot.T_flange_hand.matrix @ robot.T_hand_tool.matrix,
            lower=np.array(robot.lower),
            upper=np.array(robot.upper),
            home=np.array(robot.home),
        )

    @property
    def arrays(
        self,
    ) -> tuple[
        Float[Array, "n 4 4"],
        Float[Array, " n"],
        Float[Array, "4 4"],
        Float[Array, " n"],
        Float[Array, " n"],
    ]:
        """Return what every kernel takes first."""
        return (self.origins, self.slides, self.T_flange_tool, self.lower, self.upper)
