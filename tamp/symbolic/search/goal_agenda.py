"""The goal agenda: parts of the goal in the order in which they are better reached.

A reasonable order between two goals says that whoever reaches the later one first has to give it
up again: in a tower the lower block comes first. So does what costs more behind the other, by the
guards that this one triggers: the body at the back of a shelf. Goals are ordered so, and planned
for level by level, each level with all before it (Koehler and Hoffmann, On reasonable and forced
goal orderings and their use in an agenda-driven planning algorithm, 2000). An order is advice: it
may lead into a dead end, never to a plan that is none.
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
        successors: The task; guards alone order goal facts that are derived.
        deadline: When to give up; then there are no orders.
    """
    goals = list(bits(successors.goal))
    earlier: dict[int, set[int]] = {goal: set() for goal in goals}
    if len(goals) > 1:
        _order_by_exclusion(successors, earlier, Deadline() if deadline is None else deadline)
        _order_by_guards(successors, earlier)
    return levels(earlier) or [successors.goal]


def guard_agenda(successors: Successors) -> list[State]:
    """Return the agenda by guards alone, which takes milliseconds."""
    earlier: dict[int, set[int]] = {goal: set() for goal in bits(successors.goal)}
    _order_by_guards(successors, earlier)
    return levels(earlier) or [successors.goal]


def _order_by_exclusion(s: Successors, earlier: dict[int, set[int]], deadline: Deadline) -> None:
    """Order before a goal those that cannot be reached while it holds, or that undo it."""
    if len(s.facts) * len(s.operators) > MOST_AGENDA_ENTRIES:
        return
    try:
        mutexes = Mutexes(s.instantiated, [], deadline)
    except MutexUndecided:
        return

    achievers = _achievers(s, {goal: 1 << goal for goal in earlier})
    traces = {goal: _trace(s, achievers.get(goal, ())) for goal in earlier}
    for late, apart in zip(earlier, mutexes.exclusive(s.facts, s.goal), strict=True):
        for early in earlier:
            company, undone = traces[early]
            if early != late and (apart & company or undone >> late & 1):
                earlier[late].add(early)


def _order_by_guards(s: Successors, earlier: dict[int, set[int]]) -> None:
    """Order before a goal those that all ways to it make dearer."""
    if not s.guard_mask:
        return
    achievers = _achievers(s, _sources(s))
    for late, operators in achievers.items():
        dearer = s.extras(_trace(s, operators)[0])
        for early, others in achievers.items() if dearer else ():
            if early != late and all(operator in dearer for operator in others):
                earlier[late].add(early)


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


def _sources(s: Successors) -> dict[int, State]:
    """Map each goal fact to the facts any one of which is enough for it: itself, or what it is
    derived from, by axioms that ask for one fact alone.
    """
    found = {goal: 1 << goal for goal in bits(s.goal & ~s.derived_mask)}
    derived: dict[int, State] = {goal: 0 for goal in bits(s.goal & s.derived_mask)}
    for axiom in s.instantiated.axioms:
        goal, facts = s.number[axiom.head], s.mask(axiom.positive)
        if goal in derived:
            simple = facts.bit_count() == 1 and not axiom.negative and not facts & s.derived_mask
            derived[goal] |= facts if simple else -1
    return found | {goal: facts for goal, facts in derived.items() if facts > 0}


def _achievers(s: Successors, sources: Mapping[int, State]) -> dict[int, list[int]]:
    """List for each goal fact the operators that add a source of it; no goal that is reached by a
    conditional effect.
    """
    goals: dict[int, list[int]] = {}
    for goal, facts in sources.items():
        for fact in bits(facts):
            goals.setdefault(fact, []).append(goal)
    wanted = sum(1 << fact for fact in goals)
    found: dict[int, list[int]] = {}
    for i in s.alive:
        for fact in bits(s.added[i] & wanted & ~s.before[i]):
            for goal in goals[fact]:
                found.setdefault(goal, []).append(i)
        for _, _, added, _ in s.conditional[i]:
            for fact in bits(added & wanted & ~s.added[i]):
                for goal in goals[fact]:
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
