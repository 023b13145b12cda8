"""The execution state: the point that a plan has come to."""

from __future__ import annotations

from dataclasses import dataclass

from tamp.geometric.scene.pose import Array


@dataclass(frozen=True, eq=False)
class Held:
    """A body in the hand: T_tool_body, shape (4, 4); and its load, what is carried on it."""

    body: str
    T_tool_body: Array
    load: tuple[Held, ...] = ()

    @property
    def all(self) -> tuple[Held, ...]:
        """Return the body and its load."""
        return (self, *self.load)


@dataclass(eq=False)
class ExecutionState:
    """The robot's row [x, y, yaw, q1..qn, opening] in m and rad, what it holds, the time in s."""

    row: Array
    held: Held | None
    time: float

    @property
    def in_hand(self) -> str | None:
        """Return the held body's name."""
        return None if self.held is None else self.held.body
