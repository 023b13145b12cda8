"""The price of deriving the goal: the prices of the static facts that axioms rest on."""

from __future__ import annotations

import math

from tamp.symbolic.search.successors import State, Successors, bits


class GoalPrice:
    """The price of the goal's cheapest derivation in a state; axioms with a negation count as free.

    No step pays for it, so a search that takes the first goal state takes the dearest derivation as
    gladly as any.
    """

    def __init__(self, successors: Successors) -> None:
        s = successors
        self._goal = list(bits(s.goal))
        self._axioms: list[tuple[list[int], int, float]] = []
        if any(s.axiom_cost):
            for axiom, cost in zip(s.instantiated.axioms, s.axiom_cost, strict=True):
                price = 0.0 if axiom.negative else cost
                self._axioms.append(
                    ([s.number[fact] for fact in axiom.positive], s.number[axiom.head], price)
                )

    @property
    def is_free(self) -> bool:
        """Check that no derivation costs anything."""
        return not self._axioms

    def __call__(self, state: State) -> float:
        """Price the goal in a state without its derived facts, in which the goal holds.

        Infinite where all its derivations rest on a fact that is.
        """
        if not self._axioms:
            return 0.0
        costs = dict.fromkeys(bits(state), 0.0)
        changed = True
        while changed:
            changed = False
            for positive, head, price in self._axioms:
                if all(fact in costs for fact in positive):
                    cost = price + sum(costs[fact] for fact in positive)
                    if cost < costs.get(head, math.inf):
                        costs[head] = cost
                        changed = True
        return sum(costs.get(fact, math.inf) for fact in self._goal)
