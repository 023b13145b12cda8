"""Lazy search by the compiled loop: the same states in the same order as `lazy`, the same plan."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tamp.symbolic.search.expansion import (
    AUDIT_AFTER_STATES,
    Plan,
    Reason,
    SearchLimitReached,
    SearchSpace,
)
from tamp.symbolic.search.heuristics.goal_price import GoalPrice
from tamp.symbolic.search.heuristics.landmarks import Landmarks
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.open_lists import PREFERRED_BOOST
from tamp.symbolic.search.packed import basics, loops
from tamp.symbolic.search.packed.packing import pack_relaxation, pack_task
from tamp.symbolic.search.plan_shortening import eliminate_actions
from tamp.symbolic.search.successors import State, Successors

KINDS = {"ff": 0, "landmarks": 1}
"""The heuristics that the compiled loop knows, by their numbers."""

LOOK_AROUND, MOST_ENTRIES = 100, 2_000_000
"""States, and numbers that describe the task for each of them, after which it is asked whether the
time is up: some hundredths of a second."""

UNLIMITED = 1 << 62

FIRST_NODES, FIRST_ENTRIES = 2_000, 40_000
"""Room for states, and for groups and members of them, to begin with; doubled as needed."""


def fits(names: Sequence[str], successors: Successors) -> bool:
    """Check that the compiled loop knows the heuristics, and has all guards at hand; that no goal
    state is none because its derivation is forbidden.
    """
    if math.inf in successors.axiom_cost:
        return False
    return all(name in KINDS for name in names) and successors.lists_guards


def packed_lazy(search: SearchSpace, names: Sequence[str], weight: float) -> Plan | None:
    """Search as `lazy.lazy` does."""
    return PackedSearch(search, names, weight).plan()


class Stalled(Exception):
    """Says that a search has made no progress for as many states as it was to wait."""


class PackedSearch:
    """A search under way: its arrays, and what stops the loop now and then.

    Args:
        search: The task, the limits, and the counts, which this one adds to.
        names: The heuristics.
        weight: Of the estimates; infinite is greedy search.
        random: Shuffles operators that look alike; 0 keeps to their order. The older of equal
            states then comes first, the younger otherwise.
        achievers: Whether operators that reach a landmark for the first time are preferred too.
        successors: Another beginning and another goal with the same operators; by default the
            search's own.
        forgiving: Whether estimates leave out the price of a guard whose facts the relaxed plan
            removes for another reason.
    """

    def __init__(
        self,
        search: SearchSpace,
        names: Sequence[str],
        weight: float,
        random: int = 0,
        achievers: bool = False,
        successors: Successors | None = None,
        forgiving: bool = False,
    ) -> None:
        from tamp.symbolic.search.packed import compiled

        self._compiled = compiled
        self._search, self._weight = search, weight
        self._is_whole = successors is None
        self._s = s = search.successors if successors is None else successors
        kinds = len(names)
        relaxation = Relaxation(s, steps=True)
        marks = Landmarks(s, relaxation) if "landmarks" in names else None
        self._possible = marks is None or marks.possible

        self._arena = arena = compiled.Arena(basics.SIZES + 4 * kinds, kinds)
        numbers = [KINDS[name] for name in names]
        self._t = t = pack_task(s, numbers, arena.integers, arena.reals)
        self._r = r = pack_relaxation(s, relaxation, marks, arena.integers, arena.reals)
        self._x = arena.scratch(t, r)

        entries = max(FIRST_ENTRIES, 4 * (kinds + 1) * (2 + len(s.operators)))
        rooms = FIRST_NODES, entries, entries
        self._space, self._ints, self._reals = arena.begin(t, r, rooms)
        self._goal_price = GoalPrice(s)
        self._goal_cost = math.inf
        self._seen = 0, 0
        self._pace = max(1, min(LOOK_AROUND, MOST_ENTRIES // (1 + s.entries)))
        self._begin(kinds)
        self._ints[basics.RANDOM], self._ints[basics.ACHIEVERS] = random, achievers
        self._ints[basics.FORGIVING] = forgiving

    def _begin(self, kinds: int) -> None:
        """Set the counters, and put the initial state into the usual list of each heuristic."""
        space, ints, reals = self._space, self._ints, self._reals
        limit, endurance = self._search.limit, self._search.endurance
        ints[basics.GOAL_NODE], ints[basics.BOOST] = -1, PREFERRED_BOOST
        ints[basics.LIMIT] = UNLIMITED if limit is None else limit
        ints[basics.ENDURANCE] = UNLIMITED if endurance is None else endurance
        reals[:kinds] = math.inf

        ints[space.members], reals[space.member_cost] = -1 - basics.GOAL_ENTRY, 0.0
        ints[basics.MEMBERS], ints[basics.GROUPS] = 1, kinds
        for k in range(kinds):
            ints[space.group_parent + k], ints[space.group_base + k] = -1, 0
            ints[space.group_next + k], ints[space.group_end + k] = 0, 1
            place = k * space.groups
            reals[space.keys + place] = ints[space.ties + place] = 0
            ints[space.items + place], ints[basics.SIZES + k] = k, 1

    @property
    def expanded(self) -> int:
        """Return how many states this search itself has expanded."""
        return int(self._ints[basics.EXPANDED])

    def plan(self, patience: int = UNLIMITED) -> Plan | None:
        """Run the loop until there is a plan, or nothing is left, or a limit is reached.

        Args:
            patience: Expanded states without a new low of an estimate, from now on or from the
                last one, after which the search pauses; it can go on later.

        Raises:
            Stalled: So many were.
        """
        search = self._search
        if not self._possible:
            search.evaluated, search.first = 1, math.inf if self._is_whole else search.first
            s = self._s
            return Plan((), 0.0) if s.holds_goal(s.closure(s.initial)) else None
        began = self.expanded
        while True:
            n = self._ints
            n[basics.UNTIL] = self._until(max(began, int(n[basics.PROGRESS])) + patience)
            why = self._compiled.RUN(
                n, self._reals, self._t, self._r, self._x, self._space, self._weight, search.below
            )
            self._count()

            if why == loops.EXHAUSTED:
                return None
            if why == loops.FOUND:
                return self._extract(int(n[basics.GOAL_NODE]))
            if why == loops.GOAL:
                if self._take_goal(int(n[basics.AT])):
                    return self._extract(int(n[basics.AT]))
            elif why == loops.LIMITED:
                raise SearchLimitReached(Reason.LIMIT)
            elif why == loops.GROW:
                self._grow()
            else:
                self._look_around()
                if self.expanded >= max(began, int(n[basics.PROGRESS])) + patience:
                    raise Stalled

    def _count(self) -> None:
        """Add to the counts of all searches what this one has done since."""
        expanded, evaluated = self.expanded, int(self._ints[basics.EVALUATED])
        if self._is_whole and self._seen[1] == 0 and evaluated > 0:
            self._search.first = float(self._reals[self._space.values])
        self._search.expanded += expanded - self._seen[0]
        self._search.evaluated += evaluated - self._seen[1]
        self._seen = expanded, evaluated

    def _until(self, most: int) -> int:
        """Return after how many expanded states the loop is to stop."""
        until = min(most, self.expanded + self._pace)
        if self.expanded < AUDIT_AFTER_STATES:
            until = min(until, AUDIT_AFTER_STATES)
        return until

    def _look_around(self) -> None:
        search = self._search
        if search.expanded == AUDIT_AFTER_STATES and search.audit is not None and search.audit():
            raise SearchLimitReached(Reason.UNSOLVABLE)
        if search.deadline is not None and search.deadline.passed:
            raise SearchLimitReached(Reason.TIME)

    def _grow(self) -> None:
        """Double the room for all that has filled half of its own."""
        n, operators = self._ints, 2 + len(self._s.operators)
        kinds = self._t.heuristics
        needs = (
            int(n[basics.NODES]) + 1,
            int(n[basics.GROUPS]) + kinds * operators,
            int(n[basics.MEMBERS]) + (kinds + 1) * operators,
        )
        rooms = [
            room * 2 if need >= room // 2 else room
            for need, room in zip(needs, self._space[:3], strict=True)
        ]
        arrays = [n, self._reals]
        del n, self._ints, self._reals
        self._space = self._arena.grow(
            self._t, self._r, self._space, arrays, (rooms[0], rooms[1], rooms[2])
        )
        self._ints, self._reals = arrays

    def _take_goal(self, node: int) -> bool:
        """Take a goal state at once where its goal is free; else have it wait for a cheaper one."""
        cost, price = (
            float(self._reals[self._space.cost + node]),
            self._goal_price(self._state(node)),
        )
        if price == 0.0:
            return True
        if cost + price < self._goal_cost:
            self._goal_cost = cost + price
            key = price if self._weight == math.inf else self._goal_cost
            greedy = self._weight == math.inf
            self._compiled.PUSH_GOAL(
                self._ints, self._reals, self._t, self._space, node, self._goal_cost, key, greedy
            )
        return False

    def _state(self, node: int) -> State:
        words = self._t.words
        state, place = 0, self._space.states + node * words
        for w, word in enumerate(self._ints[place : place + words].tolist()):
            state |= (word & (1 << 64) - 1) << 64 * w
        return state

    def _extract(self, node: int) -> Plan:
        """Extract the plan to a state, without the actions that it does not need."""
        space, ints, t, x = self._space, self._ints, self._t, self._x
        numbers: list[int] = []
        while ints[space.parent + node] >= 0:
            numbers.append(int(ints[space.operator + node]))
            node = int(ints[space.parent + node])

        operators = self._s.operators
        if not self._goal_price.is_free:  # what the goal costs is known to Python only
            kept, cost = eliminate_actions(self._s, numbers[::-1], self._goal_price)
            return Plan(tuple(operators[i] for i in kept), cost)

        # the open lists are needed no longer: there is room in them
        plan, kept = space.ties, space.items
        ints[plan : plan + len(numbers)] = numbers[::-1]
        ints[x.rooms : x.rooms + t.words] = ints[t.initial : t.initial + t.words]
        count, cost = self._compiled.ELIMINATE(
            ints, self._reals, t, x, x.rooms, plan, kept, len(numbers)
        )
        steps: list[int] = ints[kept : kept + count].tolist()
        return Plan(tuple(operators[i] for i in steps), float(cost))
