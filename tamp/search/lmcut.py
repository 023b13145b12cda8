"""The landmark-cut heuristic (Helmert and Domshlak, Landmarks, Critical Paths and Abstractions, 2009): admissible.

Each cut is a set of operators of which every plan of the delete relaxation needs one. It counts with the cost of the
cheapest, which is taken off the cost of all operators in it. An operator with conditional effects is several relaxed
operators: all of them get cheaper when one is in a cut, since one application may do all they do.
"""

from __future__ import annotations

import math
from heapq import heappop, heappush

from tamp.search.relaxation import Relaxation, Situation
from tamp.search.successors import State

ZERO = 1e-9
"""Costs below are nothing: what rounding leaves of a cost that cuts have used up."""


class LandmarkCut:
    """The heuristic for the states that share one relaxed task.

    Two facts are added: one that always holds, for operators without preconditions, and one that stands for the goal.

    Args:
        relaxation: Whose operators they are.
        situation: The relaxed task.
    """

    def __init__(self, relaxation: Relaxation, situation: Situation) -> None:
        self._relaxation = relaxation
        self._true = len(situation.needed)
        self._goal = self._true + 1
        self._before = [facts or [self._true] for facts in situation.before]
        self._before.append(relaxation.goals or [self._true])
        self._effects = [*situation.effects, [self._goal]]
        self._costs = [*situation.costs, 0.0]
        self._needed: list[list[int]] = [[] for _ in range(self._goal + 1)]
        self._adders: list[list[int]] = [[] for _ in range(self._goal + 1)]
        for i, facts in enumerate(self._before):
            for fact in facts:
                self._needed[fact].append(i)
            for fact in self._effects[i]:
                self._adders[fact].append(i)
        self._counts = list(map(len, self._before))
        self._paid = [number for _, number in situation.seeds]
        self._siblings: dict[int, list[int]] = {}
        for group in relaxation.of_operator.values():
            if len(group) > 1:
                self._siblings.update(dict.fromkeys(group, group))

    def value(self, closed: State) -> float:
        """The estimate for a state with its derived facts; infinite in a dead end."""
        here = [*self._relaxation.holding(closed), self._true, *self._paid]
        costs = self._costs[:]
        reached, supporters, levels = self._explore(here, costs)
        total = 0.0
        if reached[self._goal] == math.inf:
            return math.inf
        while reached[self._goal] > ZERO:
            cut = self._cut(here, costs, supporters)
            least = min(costs[i] for i in cut)
            total += least
            changed: dict[int, None] = {}
            for i in cut:
                changed.update(dict.fromkeys(self._siblings.get(i, (i,))))
            for i in changed:
                left = costs[i] - least
                costs[i] = left if left > ZERO else 0.0
            self._update(changed, costs, reached, supporters, levels)
        return total

    def _explore(self, here: list[int], costs: list[float]) -> tuple[list[float], list[int], list[float]]:
        """The cost of all facts by hmax, and for each operator its dearest precondition and what that costs."""
        reached = [math.inf] * len(self._needed)
        supporters = [-1] * len(costs)
        levels = [math.inf] * len(costs)
        counts = self._counts[:]
        needed, effects = self._needed, self._effects
        queue: list[tuple[float, int]] = []
        for fact in here:
            reached[fact] = 0.0
            queue.append((0.0, fact))
        while queue:
            cost, fact = heappop(queue)
            if cost > reached[fact]:
                continue
            for i in needed[fact]:
                counts[i] -= 1
                if not counts[i]:
                    supporters[i], levels[i] = fact, cost
                    total = cost + costs[i]
                    for effect in effects[i]:
                        if total < reached[effect]:
                            reached[effect] = total
                            heappush(queue, (total, effect))
        return reached, supporters, levels

    def _update(
        self,
        changed: dict[int, None],
        costs: list[float],
        reached: list[float],
        supporters: list[int],
        levels: list[float],
    ) -> None:
        """The same after some operators got cheaper."""
        needed, effects, before = self._needed, self._effects, self._before
        queue: list[tuple[float, int]] = []
        for i in changed:
            total = levels[i] + costs[i]
            for effect in effects[i]:
                if total < reached[effect]:
                    reached[effect] = total
                    heappush(queue, (total, effect))
        while queue:
            cost, fact = heappop(queue)
            if cost > reached[fact]:
                continue
            for i in needed[fact]:
                if supporters[i] == fact and levels[i] > cost:
                    dearest = max(before[i], key=reached.__getitem__)
                    supporters[i] = dearest
                    if reached[dearest] < levels[i]:
                        levels[i] = reached[dearest]
                        total = levels[i] + costs[i]
                        for effect in effects[i]:
                            if total < reached[effect]:
                                reached[effect] = total
                                heappush(queue, (total, effect))

    def _cut(self, here: list[int], costs: list[float], supporters: list[int]) -> list[int]:
        """The operators that lead into the facts from which the goal costs nothing more."""
        zone = bytearray(len(self._needed))
        zone[self._goal] = 1
        stack = [self._goal]
        adders, effects, needed = self._adders, self._effects, self._needed
        while stack:
            for i in adders[stack.pop()]:
                supporter = supporters[i]
                if costs[i] <= 0.0 and supporter >= 0 and not zone[supporter]:
                    zone[supporter] = 1
                    stack.append(supporter)
        cut: list[int] = []
        seen = bytearray(len(self._needed))
        stack = [fact for fact in here if not zone[fact]]
        for fact in stack:
            seen[fact] = 1
        while stack:
            fact = stack.pop()
            for i in needed[fact]:
                if supporters[i] != fact:
                    continue
                into = [effect for effect in effects[i] if zone[effect]]
                if into:
                    cut.append(i)
                    continue
                for effect in effects[i]:
                    if not seen[effect]:
                        seen[effect] = 1
                        stack.append(effect)
        return cut


class LandmarkCuts:
    """`LandmarkCut` for every relaxed task that states ask for."""

    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self._known: dict[State, LandmarkCut] = {}

    def value(self, closed: State) -> float:
        """The estimate for a state with its derived facts."""
        key = self._relaxation.key(closed)
        known = self._known.get(key)
        if known is None:
            if len(self._known) > 1000:
                self._known.clear()
            known = self._known[key] = LandmarkCut(self._relaxation, self._relaxation.situation(closed))
        return known.value(closed)
