"""The interfaces by which a motion planner asks the collision layer and the robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from tamp.geometric.scene.pose import Array

EdgeTest = Callable[[Array, Array], bool]
"""Whether the straight edge between two configurations is free."""


class Checker(Protocol):
    """Decides configurations and straight edges between them;
    `tamp.geometric.collision.collisions.Arrangement` is one.

    A configuration has shape (3 + n,): base x, y in metres, base yaw, then the arm's joints,
    radians.
    """

    def free(self, conf: Array, /) -> bool:
        """Check whether nothing touches at `conf`."""
        ...

    def edge_free(self, start: Array, end: Array, /) -> bool:
        """Check whether nothing touches anywhere on the straight line of stored numbers from
        `start` to `end`.
        """
        ...


class Limits(Protocol):
    """The limits of the arm's joints; `tamp.geometric.robot.robot.Robot` has them."""

    @property
    def lower(self) -> Sequence[float]:
        """Smallest angles, shape (n,), radians."""
        ...

    @property
    def upper(self) -> Sequence[float]:
        """Largest angles."""
        ...
