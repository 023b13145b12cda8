"""Choice of one way for each goal, such that all facts of these go together pair by pair."""

from __future__ import annotations

from collections.abc import Callable, Sequence

MAX_CHOICES = 20_000
"""Choices looked at in the attempt to let all goals hold together."""

Way = tuple[int, ...]
"""The numbers of the facts by which a goal holds."""


def hold_together(
    goals: Sequence[Sequence[Way]], partners: Callable[[Way], int], look: Callable[[], None]
) -> bool:
    """Check that ways, one a goal, can go together pair by pair; true where it is undecided.

    Args:
        goals: The ways of each, whose own facts go together.
        partners: The facts that go with all of a way's, one bit for each number.
        look: Called now and then; raises when the time is up.
    """
    left = _supported(goals, partners, look)
    if left is None:
        return False

    order = sorted(left, key=len)
    steps = 0

    def choose(index: int, allowed: int) -> bool:
        nonlocal steps
        if index == len(order):
            return True
        for way in order[index]:
            steps += 1
            if steps > MAX_CHOICES:
                return True
            if all(allowed >> k & 1 for k in way) and choose(index + 1, allowed & partners(way)):
                return True
        return False

    return choose(0, -1)


def _supported(
    goals: Sequence[Sequence[Way]], partners: Callable[[Way], int], look: Callable[[], None]
) -> list[list[Way]] | None:
    """Leave out ways with which another goal has none, until each has some of every other goal
    (arc consistency, Mackworth 1977); None where a goal has none left.
    """
    left = [[(way, _bits(way), partners(way)) for way in ways] for ways in goals]
    changed = True
    while changed:
        changed = False
        for i, ways in enumerate(left):
            look()
            others = [[facts for _, facts, _ in rest] for j, rest in enumerate(left) if j != i]
            kept = [
                way
                for way in ways
                if all(any(not facts & ~way[2] for facts in rest) for rest in others)
            ]
            if not kept:
                return None
            changed |= len(kept) < len(ways)
            left[i] = kept
    return [[way for way, _, _ in ways] for ways in left]


def _bits(numbers: Way) -> int:
    mask = 0
    for k in numbers:
        mask |= 1 << k
    return mask
