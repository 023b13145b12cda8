"""Fact landmarks: facts that every plan makes true at some time, and those of them that are still
to come.

All fact landmarks of the delete relaxation, found by one fixpoint over sets of facts (Zhu and
Givan, Landmark extraction via planning graph propagation, 2003; Keyder, Richter, Helmert, Sound and
complete landmarks for and/or graphs, 2010).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.successors import State, Successors, bits

Mask = int
"""A set of relaxed facts: bit `fact` for a fact, bit `size + fact` for its complement."""


class Landmarks:
    """The landmarks of a task, and those reached on the way to each state that was asked for.

    A landmark counts as long as it was not true on the way; again when it is false now and is a
    goal, or is needed by all that first achieves a landmark that was not true yet (Richter and
    Westphal, LAMA, 2010).

    Args:
        successors: The task.
        relaxation: Its delete relaxation, where that is at hand; it counts steps.
    """

    def __init__(self, successors: Successors, relaxation: Relaxation | None = None) -> None:
        if relaxation is None:
            relaxation = Relaxation(successors, steps=True)
        self._relaxation = relaxation
        self._size = len(successors.facts)
        initial = successors.closure(successors.initial)
        relaxed_state = relaxation.relaxed_state(initial)
        before, effects, needed = (
            relaxed_state.before.lists(),
            relaxed_state.effects.lists(),
            relaxed_state.needed.lists(),
        )
        here = relaxation.holding(initial)
        sets: list[Mask] = [0] * len(
            needed
        )  # 0: not reached yet; every reached set contains the fact itself
        for fact in (*here, *relaxed_state.paid):
            sets[fact] = 1 << fact
        start = set(here)
        waiting = dict.fromkeys(range(len(before)))
        while waiting:
            i = next(iter(waiting))
            del waiting[i]
            union = 0
            for fact in before[i]:
                if not sets[fact]:
                    break
                union |= sets[fact]
            else:
                for effect in effects[i]:
                    if effect in start:
                        continue
                    found = sets[effect]
                    new = (union & found if found else union) | 1 << effect
                    if new != found:
                        sets[effect] = new
                        waiting.update(dict.fromkeys(needed[effect]))
        self.possible = all(sets[goal] for goal in relaxation.goals)
        wanted = 0
        for goal in relaxation.goals:
            wanted |= sets[goal]
        goals = sum(1 << goal for goal in relaxation.goals)
        useful = (1 << 2 * self._size) - 1
        self.landmarks = list(bits(wanted & useful))
        self._all = wanted & useful
        self.goals = goals & useful
        self._reached: dict[State, Mask] = {}
        self._complements = self._all >> self._size
        self.weights = self._weigh(effects, relaxed_state.costs)
        self.needs = self._first_needs(sets, before, effects)

    def remaining(self, closed: State, parent: State | None) -> Mask:
        """Return the landmarks that are still to come, or to come again.

        Args:
            closed: The state with its derived facts.
            parent: The state before it, likewise; None for the initial one.
        """
        now = self._holding(closed)
        reached = (self._reached.get(parent, 0) if parent is not None else 0) | now
        before = self._reached.get(closed)
        if before is not None:
            reached &= before | now
        self._reached[closed] = reached
        missing = self._all & ~reached
        again = self.goals
        for fact in bits(missing):
            again |= self.needs.get(fact, 0)
        return missing | (again & ~now & self._all)

    def cost(self, remaining: Mask) -> float:
        """Sum the costs of the landmarks' cheapest achievers."""
        weights = self.weights
        return sum(weights[fact] for fact in bits(remaining))

    def _holding(self, closed: State) -> Mask:
        return (closed & self._all) | (~closed & self._complements) << self._size

    def _weigh(self, effects: list[list[int]], costs: Sequence[float]) -> dict[int, float]:
        weights: dict[int, float] = {}
        for i, facts in enumerate(effects):
            for fact in facts:
                if self._all >> fact & 1:
                    weights[fact] = min(weights.get(fact, math.inf), float(costs[i]))
        return {fact: weights.get(fact, 0.0) for fact in self.landmarks}

    def _first_needs(
        self, sets: list[Mask], before: list[list[int]], effects: list[list[int]]
    ) -> dict[int, Mask]:
        """Return for each landmark what all its first achievers need: those that do not need
        itself.
        """
        needs: dict[int, Mask] = {}
        for i, facts in enumerate(effects):
            if not all(sets[fact] for fact in before[i]):
                continue
            union = own = 0
            for fact in before[i]:
                union |= sets[fact]
                own |= 1 << fact
            for fact in facts:
                if self._all >> fact & 1 and not union >> fact & 1:
                    needs[fact] = needs[fact] & own if fact in needs else own
        return {fact: need & self._all for fact, need in needs.items() if need & self._all}
