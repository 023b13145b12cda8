"""The result of a motion planner: a path, or why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from tamp.geometric.scene.pose import Array


class Failure(Enum):
    """The reason why no path came out; the value is the phrase that a user reads."""

    START = "the start is in collision"
    GOAL = "the goal is in collision"
    LIMITS = "the start or the goal is outside the limits"
    EXHAUSTED = "no way was found within the effort"
    TIME = "the time ran out"


@dataclass(frozen=True, eq=False)
class MotionResult:
    """The outcome of one motion query.

    Attributes:
        path: The polyline, shape (n, d), every edge of it certified; None when there is none.
        failure: Why there is none; None when there is one. Only START, GOAL and LIMITS are final.
        checks: Edges asked of the checker, the deterministic measure of the work done.
    """

    path: Array | None
    failure: Failure | None
    checks: int

    def __bool__(self) -> bool:
        return self.path is not None
