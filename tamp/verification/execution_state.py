"""The execution state: the point that a plan has come to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tamp.geometric.scene.pose import Array
from tamp.plan.read import StoredSegment


@dataclass(frozen=True, eq=False)
class Held:
    """A body in the hand of the arm of a number: T_tool_body, shape (4, 4); and its load, what is
    carried on it.
    """

    body: str
    T_tool_body: Array
    load: tuple[Held, ...] = ()
    arm: int = 0

    @property
    def all(self) -> tuple[Held, ...]:
        """Return the body and its load."""
        return (self, *self.load)


@dataclass(eq=False)
class ExecutionState:
    """The robot's row [x, y, yaw, then q1..qn, opening of each arm] in m and rad, what the arms of
    these numbers hold, the time in s.
    """

    row: Array
    hands: dict[int, Held]
    time: float

    @property
    def held(self) -> tuple[Held, ...]:
        """Return what is held, each body once."""
        return tuple({held.body: held for held in self.hands.values()}.values())

    def shares(self, arm: int) -> bool:
        """Check whether another hand holds what the arm of a number does."""
        bodies = {number: held.body for number, held in self.hands.items()}
        own = bodies.pop(arm, None)
        return own in bodies.values()

    @property
    def in_hand(self) -> frozenset[str]:
        """Return the held bodies' names."""
        return frozenset(held.body for held in self.hands.values())


def carried(held: Iterable[Held]) -> list[Held]:
    """Return all that is held, with what is carried on it."""
    return [one for hand in held for one in hand.all]


def follow(row: Array, segment: StoredSegment, where: slice) -> None:
    """Write where a segment ends into the robot's row; `where`: the columns of its arm."""
    arm = range(where.start, where.stop - 1)
    columns: dict[str, Sequence[int]] = {"base": range(3), "arm": arm, "gripper": ()}
    for column, value in zip(columns[segment.part], segment.positions[-1], strict=True):
        row[column] = value
