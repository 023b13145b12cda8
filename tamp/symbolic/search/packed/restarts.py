"""Greedy search that begins anew where it stalls, in another order, by another heuristic, or for
the parts of the goal one after the other.

The first search goes on in turn with the others, so what it would find by itself is found, with a
constant factor more states; so is a proof that there is no plan.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass
from itertools import count
from random import Random

from tamp.symbolic.search.expansion import Plan, SearchSpace
from tamp.symbolic.search.goal_agenda import goal_agenda, guard_agenda, one_by_one
from tamp.symbolic.search.heuristics.goal_price import GoalPrice
from tamp.symbolic.search.packed.search import PackedSearch, Stalled
from tamp.symbolic.search.plan_shortening import eliminate_actions
from tamp.symbolic.search.successors import State

STALLED_STATES = 3000
"""Expanded states without progress after which the first search counts as stalled: one that goes
down steadily, if slowly, is not disturbed."""

SHORTEST_RESTART_STATES = 3000
"""Such states of the shortest restart."""


def luby(number: int) -> int:
    """Return an element, from 1 on, of 1, 1, 2, 1, 1, 2, 4, ... (Luby et al. 1993)."""
    k = number.bit_length()
    return 1 << k - 1 if number == (1 << k) - 1 else luby(number - (1 << k - 1) + 1)


@dataclass(frozen=True)
class Way:
    """A way to begin anew.

    Attributes:
        heuristics: Their names.
        achievers: Whether operators that reach a landmark are preferred.
        agenda: The parts of the goal, each with all before it; empty for the goal at once.
        singly: Whether the goals of a part are planned for one after the other, in random order.
    """

    heuristics: tuple[str, ...]
    achievers: bool = False
    agenda: tuple[State, ...] = ()
    singly: bool = False


def ways(names: Sequence[str], agenda: Sequence[State] = ()) -> list[Way]:
    """List what restarts take in turn: goals by their order first, where they have one."""
    found: list[Way] = []
    if len(agenda) > 1:
        found += [Way(tuple(names), agenda=tuple(agenda), singly=some) for some in (False, True)]
    found.append(Way(tuple(names)))
    if "landmarks" in names:
        found.append(Way(tuple(names), achievers=True))
    if len(names) > 1:
        found.append(Way(("ff",)))
    return found


def _turns(ways: Sequence[Way]) -> Iterator[Way | None]:
    """Yield the restarts' ways in turn, and None where the first search is to go on."""
    while True:
        yield from ways
        yield None


def greedy_with_restarts(search: SearchSpace, names: Sequence[str], seed: int = 0) -> Plan | None:
    """Search greedily, by parts of the goal where guards order them; where that stalls, begin anew
    in random order, with growing limits.

    Args:
        search: The task, its limits and counts.
        names: The heuristics of the first search.
        seed: Of the random orders.
    """
    first = PackedSearch(search, names, math.inf)
    by_guards = guard_agenda(search.successors)
    if len(by_guards) > 1:
        try:
            return first.plan(1)  # what the whole goal is estimated at is told, too
        except Stalled:
            pass
        try:
            return by_agenda(search, Way(tuple(names), agenda=tuple(by_guards)), 0, STALLED_STATES)
        except Stalled:
            pass
    try:
        return first.plan(STALLED_STATES)
    except Stalled:
        pass

    rng = Random(seed)
    turns = _turns(ways(names, goal_agenda(search.successors, search.deadline)))
    for number, way in zip(count(1), turns, strict=False):
        states = SHORTEST_RESTART_STATES * luby(number)
        try:
            if way is None:
                return first.plan(states)
            random = rng.getrandbits(60) | 1
            if way.agenda:
                return by_agenda(search, way, random, states)
            return PackedSearch(search, way.heuristics, math.inf, random, way.achievers).plan(
                states
            )
        except Stalled:
            continue
    return None


def by_agenda(search: SearchSpace, way: Way, random: int, states: int) -> Plan:
    """Plan for each part of the goal from where the part before it has ended.

    Args:
        search: The task, its limits and counts.
        way: With an agenda.
        random: Shuffles operators that look alike.
        states: Expanded states without progress, for each part.

    Raises:
        Stalled: So many were for one, or it cannot be reached from there.
    """
    s = search.successors
    numbers = {id(operator): number for number, operator in enumerate(s.operators)}
    state, steps = s.initial, list[int]()
    parts = one_by_one(way.agenda, Random(random)) if way.singly else way.agenda
    for goal in parts:
        part = copy(s)
        part.initial, part.goal = state, goal
        if goal != s.goal:
            part.goal_absent = 0
        found = PackedSearch(
            search, way.heuristics, math.inf, random, successors=part, forgiving=True
        ).plan(states)
        if found is None:
            raise Stalled
        for operator in found.operators:
            number = numbers[id(operator)]
            state = s.apply(number, state, s.closure(state))
            steps.append(number)

    kept, cost = eliminate_actions(s, steps, GoalPrice(s))
    return Plan(tuple(s.operators[number] for number in kept), cost)
