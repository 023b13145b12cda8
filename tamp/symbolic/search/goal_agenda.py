"""The goal agenda: parts of the goal in the order in which they are better reached.

A reasonable order between two goals says that whoever reaches the later one first has to give it
up again: in a tower the lower block comes first. Goals are ordered so, and planned for level by
level, each level with all before it (Koehler and Hoffmann, On reasonable and forced goal orderings
and their use in an agenda-driven planning algorithm, 2000). An order is advice: it may lead into a
dead end, never to a plan that is none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from random import Random

from tamp.symbolic.search.mutex import Mutexes, MutexUndecided
from tamp.symbolic.search.successors import State, Successors, bits
from tamp.system.deadline import Deadline

MOST_AGENDA_ENTRIES = 20_000_000
"""Facts times operators of the largest task whose goals are ordered: the mutexes of one take a
second or two of CPU time."""


def goal_agenda(successors: Successors, deadline: Deadline | None = None) -> list[State]:
    """Return growing sets of goal facts, the last of them all; just that one without orders.

    Args:
        successors: The task, in which goal facts that are derived count as unordered.
        deadline: When to give up; then there are no orders.
    """
    s = successors
    goals = list(bits(s.goal))
    if len(goals) < 2 or len(s.facts) * len(s.operators) > MOST_AGENDA_ENTRIES:
        return [s.goal]
    try:
        mutexes = Mutexes(s.instantiated, [], Deadline() if deadline is None else deadline)
    except MutexUndecided:
        return [s.goal]

    achievers = _achievers(s)
    traces = {goal: _trace(s, achievers.get(goal, ())) for goal in goals}
    earlier: dict[int, set[int]] = {goal: set() for goal in goals}
    for late, apart in zip(goals, mutexes.exclusive(s.facts, s.goal), strict=True):
        for early in goals:
            company, undone = traces[early]
            if early != late and (apart & company or undone >> late & 1):
                earlier[late].add(early)
    return levels(earlier)


def levels(earlier: Mapping[int, set[int]]) -> list[State]:
    """Return growing sets of goals, each with all whose earlier goals are in the one before.

    Goals that wait for each other in a cycle, and those behind them, come together at the end.

    Args:
        earlier: For each goal those that are to be reached before it.
    """
    found: list[State] = []
    reached: set[int] = set()
    while len(reached) < len(earlier):
        ready = {goal for goal, before in earlier.items() if before <= reached}
        reached = ready if ready - reached else set(earlier)
        found.append(sum(1 << goal for goal in reached))
    return found


def one_by_one(agenda: Sequence[State], rng: Random) -> list[State]:
    """Return sets that grow by one goal each, in a random order within each level.

    Args:
        agenda: The levels.
        rng: Decides.
    """
    found: list[State] = []
    reached = 0
    for level in agenda:
        new = list(bits(level & ~reached))
        rng.shuffle(new)
        for goal in new:
            reached |= 1 << goal
            found.append(reached)
    return found


def _achievers(s: Successors) -> dict[int, list[int]]:
    """List for each goal fact the operators that add it, conditional effects aside."""
    found: dict[int, list[int]] = {}
    for i in s.alive:
        for goal in bits(s.added[i] & s.goal & ~s.before[i]):
            found.setdefault(goal, []).append(i)
        for _, _, added, _ in s.conditional[i]:
            for goal in bits(added & s.goal & ~s.added[i]):
                found.setdefault(goal, []).append(-1)
    return {goal: some for goal, some in found.items() if -1 not in some}


def _trace(s: Successors, achievers: Sequence[int]) -> tuple[State, State]:
    """Return what holds whenever a goal has just been reached, and what does not hold any more."""
    if not achievers:
        return 0, 0
    company = undone = -1
    for i in achievers:
        company &= s.before[i] & s.kept[i] | s.added[i]
        undone &= ~s.kept[i] & ~s.added[i]
    return company, undone
