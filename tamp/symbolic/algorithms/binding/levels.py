"""The levels of a backjumping search that keeps, across jumps back, what a jump leaves unchanged.

A jump back resets all levels after its target: each begins anew with the value it had last. Most of
them see the same inputs as before, so going down through them again changes nothing; they are
skipped, and reset only when a later jump ends at one of them (cf. Ginsberg, Dynamic backtracking,
1993, which keeps such assignments too, but reorders the levels).
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, field
from heapq import heappop, heappush


@dataclass
class Level:
    """One node on the way down: its candidates, and the levels that its failure depends on."""

    candidates: Iterator[tuple[str, ...]]
    conflict: set[int]
    culprits: set[int] = field(default_factory=set[int])


class Levels:
    """The levels: those to be entered, those that stand as they were, those of them that are reset.

    Args:
        users: For each level the later ones that depend on its outputs.
        fresh: The levels that take a new value after each jump across them.
    """

    def __init__(self, users: Sequence[Sequence[int]], fresh: Set[int]) -> None:
        self._users = users
        self._fresh = fresh
        self._levels: list[Level | None] = [None] * len(users)
        self._entered = [0] * len(users)
        self._outputs: list[tuple[str, ...] | None] = [None] * len(users)
        self._waits = [True] * len(users)
        self._waiting = list(range(len(users)))
        self._jumps: list[int] = []
        self._targets: list[int] = []
        self._clock = 0

    def next(self) -> int | None:
        """Return the first level that is to be entered; None where all have a value."""
        return self._waiting[0] if self._waiting else None

    def enter(self, index: int, level: Level) -> None:
        """Put a level, new or begun anew, in its place."""
        self._levels[index] = level
        self._entered[index] = self._clock

    def valid_level(self, index: int) -> Level | None:
        """Return a level; None where a jump has reset it, so that it has to begin anew."""
        place = bisect_left(self._targets, index) - 1
        reset = self._jumps[place] if place >= 0 else 0
        return None if reset > self._entered[index] else self._levels[index]

    def take(self, index: int, outputs: tuple[str, ...]) -> None:
        """Note a level's value; those that depend on it wait to be entered where it is another."""
        if self._waits[index]:
            heappop(self._waiting)  # levels are entered in their order: it is the first
            self._waits[index] = False
        if self._outputs[index] != outputs:
            self._outputs[index] = outputs
            self._wait(self._users[index])

    def jump(self, failed: int, target: int) -> None:
        """Jump back from a level without further candidates: what lies between is reset."""
        self._clock += 1
        while self._targets and self._targets[-1] >= target:
            self._targets.pop()
            self._jumps.pop()
        self._targets.append(target)
        self._jumps.append(self._clock)

        self._wait((failed,))
        self._wait(index for index in self._fresh if index > target)

    def _wait(self, indices: Iterable[int]) -> None:
        for index in indices:
            if not self._waits[index]:
                self._waits[index] = True
                heappush(self._waiting, index)
