"""The open lists of lazy search: states that wait to be evaluated, for each heuristic by its own.

Each heuristic has two lists, the second for successors by preferred operators; all take turns,
after progress those of the preferred get more (Richter and Helmert, Preferred Operators and
Deferred Evaluation in Satisficing Planning, 2009).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from heapq import heappop, heappush
from typing import NamedTuple

from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.successors import State

PREFERRED_BOOST = 1000
"""Turns that the lists of preferred operators get ahead after progress (Richter and Helmert)."""

GOAL_ENTRY = -2
"""Stands for an operator where a goal state waits for its price to be the lowest."""

Entry = tuple[float, int, float, State, State | None, int]
"""Priority, number among equals, cost, state, the state before, the operator."""


DETOUR, ROOT = 21, 41
"""Where the detour and the root stand in a number among equals, which the state itself
ends: bits."""


class Plateau(NamedTuple):
    """A place of greedy search: how far a state is from the last progress on the way to it.

    Among equal estimates those go first whose detour from the newest progress is the shortest: a
    step counts one, and one more for each operator that would have gone before. So the best
    operators are followed a few steps deep, and others in their turn, where going down without
    turning would end in orders of steps that do not matter (cf. Harvey and Ginsberg, Limited
    discrepancy search, 1995).

    Attributes:
        number: Of the state, in the order of closing.
        root: The number of the state that made progress: an estimate is below that of its root.
        detour: From there to here.
        values: The estimates there.
    """

    number: int
    root: int
    detour: int
    values: tuple[float, ...]

    def order(self, rank: int) -> int:
        """Return the number among equals of a successor; the newest first where all else is."""
        return (self.detour + 2 + rank << DETOUR) - (self.root << ROOT) - self.number

    def after(self, number: int, order: int, values: tuple[float, ...]) -> Plateau:
        """Return where the successor of such an order is, given its number and estimates."""
        if any(value < before for value, before in zip(values, self.values, strict=True)):
            return Plateau(number, number, 0, values)
        detour = (order + self.number + (self.root << ROOT) >> DETOUR) - 1
        return Plateau(number, self.root, detour, self.values)


class Expanded(NamedTuple):
    """A state under expansion.

    Attributes:
        state: Without derived facts.
        cost: Of the way to it, with prices.
        estimates: What each heuristic says of it.
        values: Their values.
    """

    state: State
    cost: float
    estimates: tuple[Estimate, ...]
    values: tuple[float, ...]


class OpenLists:
    """The open lists of all heuristics.

    Args:
        initial: The first state.
        count: How many heuristics there are.
        weight: Of the estimates; infinite is greedy search: costs do not count.
    """

    def __init__(self, initial: State, count: int, weight: float) -> None:
        self._kinds = range(count)
        self._weight = weight
        self._greedy = weight == math.inf
        self._usual: list[list[Entry]] = [[(0.0, 0, 0.0, initial, None, -1)] for _ in self._kinds]
        self._preferred: list[list[Entry]] = [[] for _ in self._kinds]
        self._turns = [0] * count
        self._preferred_turns = [0] * count
        self._lowest = [math.inf] * count
        self._pushed = 0

    def pop(self) -> Entry | None:
        """Pop the first entry of the list whose turn it is; None when all are empty."""
        usual, preferred = self._usual, self._preferred
        k = min((k for k in self._kinds if usual[k]), key=self._turns.__getitem__, default=None)
        p = min(
            (k for k in self._kinds if preferred[k]),
            key=self._preferred_turns.__getitem__,
            default=None,
        )

        # Preferred, but by far too dear: a price was learned.
        if (
            p is not None
            and not self._greedy
            and usual[p]
            and preferred[p][0][0] > 2.0 * usual[p][0][0]
        ):
            p = None

        if p is not None and (k is None or self._preferred_turns[p] <= self._turns[k]):
            self._preferred_turns[p] += 1
            return heappop(preferred[p])
        if k is not None:
            self._turns[k] += 1
            return heappop(usual[k])
        return None

    def push(
        self,
        parent: Expanded,
        operator: int,
        after: State,
        reached: float,
        step: float,
        order: int | None,
        preferred: bool,
    ) -> None:
        """Push a successor onto the lists of all heuristics, under its parent's estimates.

        Args:
            parent: The state before it.
            operator: What leads to it.
            after: The successor.
            reached: The cost of the way to it, with prices.
            step: The operator's cost without those of its guards.
            order: Its number among equals, the lowest first; None: the older.
            preferred: Whether a heuristic prefers the operator.
        """
        greedy, weight = self._greedy, self._weight
        state, cost, estimates, values = parent
        self._pushed += 1
        order = self._pushed if order is None else order
        dearer = reached - cost - step

        for kind, h in enumerate(values):
            extra = dearer and dearer - _paid(estimates[kind], operator)
            key = h + extra if greedy else cost + step + extra + weight * h
            heappush(self._usual[kind], (key, order, reached, after, state, operator))
            if preferred and extra <= step:
                # Rank decides among preferred siblings, not cost. One that guards make dear waits
                # elsewhere.
                key = h if greedy else cost + weight * h
                heappush(self._preferred[kind], (key, order, reached, after, state, operator))

    def push_goal(self, state: State, cost: float, price: float) -> None:
        """Push a goal state that costs something to derive: it waits for what is cheaper than it.

        Args:
            state: The goal state.
            cost: Of the way to it, the goal's price included.
            price: The goal's price alone.
        """
        self._pushed += 1
        key = price if self._greedy else cost
        for entries in self._usual[:1] + [one for one in self._preferred[:1] if one]:
            heappush(entries, (key, self._pushed, cost, state, None, GOAL_ENTRY))

    def boost(self, values: Sequence[float]) -> bool:
        """Boost the lists of preferred operators for each heuristic whose estimate is a new low;
        say if any is.
        """
        lower = False
        for kind, value in enumerate(values):
            if value < self._lowest[kind]:
                self._lowest[kind], lower = value, True
                for other in self._kinds:
                    self._preferred_turns[other] -= PREFERRED_BOOST
        return lower


def _paid(estimate: Estimate, operator: int) -> float:
    """Return the prices of the operator's guards that the parent's estimate contains.

    They shall not count twice.
    """
    if estimate.paid is None or operator not in estimate.plan:
        return 0.0
    return estimate.paid(operator)
