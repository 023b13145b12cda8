"""The delete relaxation of a state: the cheapest way to each fact when nothing is ever deleted.

Three things go beyond STRIPS. A negative condition violated in the evaluated state waits for the
complement of its fact, which the operators that delete the fact achieve. A triggered guard waits
likewise, or is paid for: its operator gets a precondition that costs the lesser of the guard's
price and of removing its facts. Conditional effects and axioms are operators of their own. Negated
derived facts are taken for free (only recursive ones are left at this stage).
"""

from __future__ import annotations

import math
from functools import cache

from tamp.symbolic.search.heuristics.loops.interface import Kernels
from tamp.symbolic.search.heuristics.loops.selection import choose
from tamp.symbolic.search.heuristics.relaxed_state import (
    RelaxedExploration,
    RelaxedState,
    TriggeredGuards,
)
from tamp.symbolic.search.successors import State, Successors, bits

MAX_RELAXED_STATES = 64
"""So many relaxed states are kept; one of a large task takes a megabyte, and making it again less
time than exploring.
"""


class Relaxation:
    """The delete relaxation of a task.

    Args:
        successors: The task.
        steps: Count steps too where some operator costs nothing, so that estimates tell such steps
            from none at all. Not admissible.

    Attributes:
        owners: The operator that each relaxed operator belongs to, -1 for axioms.
        groups: The relaxed operators of each operator.
        free: The relaxed operators without preconditions.
        goals: The relaxed facts that the goal asks for.
    """

    def __init__(self, successors: Successors, *, steps: bool) -> None:
        self._successors = s = successors
        self._size = size = len(s.facts)
        step = 1.0 if steps and any(s.cost[i] == 0.0 for i in s.alive) else 0.0
        self.owner_list: list[int] = []
        self.before: list[list[int]] = []
        self.costs: list[float] = []
        self.effects: list[list[int]] = []
        self.negative: dict[int, list[int]] = {}
        self.of_operator: list[list[int]] = [[] for _ in s.operators]
        derived = s.mask(axiom.head for axiom in s.instantiated.axioms)
        negated = s.guard_mask | s.goal_absent

        for i in s.alive:
            negated |= s.absent[i]
            for _, negative, _, _ in s.conditional[i]:
                negated |= negative

        for axiom in s.instantiated.axioms:
            negated |= s.mask(axiom.negative)
        self.negated = negated = negated & ~derived
        every = (1 << size) - 1
        split = cache(_split)

        for i in s.alive:
            deleted = every & ~s.kept[i] & ~s.added[i] & negated
            effects = [*split(s.added[i]), *(size + b for b in bits(deleted))]
            if effects or not s.conditional[i]:
                self._add(i, split(s.before[i]), s.absent[i], s.cost[i] + step, effects)
            for positive, negative, added, removed in s.conditional[i]:
                effects = [
                    *bits(added),
                    *(size + b for b in bits(removed & ~added & ~s.added[i] & negated)),
                ]
                if effects:
                    self._add(
                        i,
                        split(s.before[i] | positive),
                        s.absent[i] | negative,
                        s.cost[i] + step,
                        effects,
                    )

        for axiom, price in zip(s.instantiated.axioms, s.axiom_cost, strict=True):
            cost = price if steps else 0.0
            self._add(
                -1,
                split(s.mask(axiom.positive)),
                s.mask(axiom.negative),
                cost,
                [s.number[axiom.head]],
            )

        self.free = [i for i, facts in enumerate(self.before) if not facts]
        self.removal = self._removal_costs()
        self.negative_goals = list(bits(s.goal_absent & ~derived))
        self.goals = [*bits(s.goal), *(size + fact for fact in self.negative_goals)]
        self._entries = sum(map(len, self.before)) + len(self.before) + size
        self._prepare(choose(0))

    def _prepare(self, kernels: Kernels) -> None:
        """Make the lists that the kernels take, of the states that trigger no guards and violate
        nothing.
        """
        before = kernels.rows(self.before)
        effects, needed = kernels.rows(self.effects), kernels.transposed(before, 2 * self._size)
        self._base = RelaxedState(kernels, before, kernels.reals(self.costs), effects, needed)
        self._relaxed_states: dict[int, RelaxedState] = {}
        self._ends = kernels.integers(self.goals)
        self.owners, self.groups = kernels.integers(self.owner_list), kernels.rows(self.of_operator)

    def _add(
        self, owner: int, before: list[int], absent: int, cost: float, effects: list[int]
    ) -> None:
        number = len(self.owner_list)
        self.owner_list.append(owner)
        self.before.append(before)
        self.costs.append(cost)
        self.effects.append(effects)
        if owner >= 0:
            self.of_operator[owner].append(number)
        for fact in bits(absent & self.negated):
            self.negative.setdefault(fact, []).append(number)

    def _removal_costs(self) -> list[float]:
        """Compute for each fact the cost of the cheapest operator that deletes it."""
        costs = [math.inf] * self._size
        for i, effects in enumerate(self.effects):
            for effect in effects:
                if effect >= self._size:
                    costs[effect - self._size] = min(costs[effect - self._size], self.costs[i])
        return costs

    def holding(self, closed: State) -> list[int]:
        """Return the relaxed facts that hold in a state with its derived facts: facts, and
        complements that the goal names.
        """
        return [
            *bits(closed),
            *(self._size + fact for fact in self.negative_goals if not closed >> fact & 1),
        ]

    def key(self, state: State) -> State:
        """Return what states with the same relaxed task have in common."""
        return state & self.negated

    def relaxed_state(self, state: State, effort: int = 1) -> RelaxedState:
        """Return the relaxed task as seen from a state, to be gone through about so many times."""
        kernels = choose(effort * self._entries)
        if kernels is not self._base.kernels:
            self._prepare(kernels)
        key = self.key(state)
        cached = self._relaxed_states.get(key)
        if cached is None:
            if len(self._relaxed_states) >= MAX_RELAXED_STATES:
                self._relaxed_states.clear()
            cached = self._relaxed_states[key] = self._relax(key)
        return cached

    def _relax(self, state: State) -> RelaxedState:
        """Build the relaxed task in which the state's triggered guards are paid for, or waited for.

        An operator waits until a guard's facts are removed, or until the guard is paid for.
        """
        size, base = self._size, self._base
        found = self._triggered(state)
        waiting, raised, blocked = found.waiting, found.raised, found.blocked
        if not waiting and not found.dearer:
            return base
        operators, first = base.operators, base.facts
        waiters: list[int] = []
        guards: list[int] = []
        removers: list[int] = []
        removed: list[int] = []

        for guard, ((facts, _), those) in enumerate(waiting.items(), start=first):
            waiters += those
            guards += [guard] * len(those)
            complements = [size + fact for fact in bits(facts)]
            removers += complements
            removed += [guard] * len(complements)

        numbers = {key: guard for guard, key in enumerate(waiting, start=first)}
        kernels, last = base.kernels, operators + len(removers)
        added = kernels.integers(range(operators, last))
        behind, sources = (
            kernels.integers([*waiters, *added]),
            kernels.integers([*guards, *removers]),
        )
        paid = [
            (guard, price)
            for guard, (_, price) in enumerate(waiting, start=first)
            if price < math.inf
        ]

        return RelaxedState(
            kernels,
            before=kernels.appended(base.before, behind, sources, last),
            costs=kernels.incremented(
                base.costs,
                kernels.integers(found.dearer),
                kernels.reals(found.by),
                len(removers),
            ),
            effects=kernels.appended(base.effects, added, kernels.integers(removed), last),
            needed=kernels.appended(base.needed, sources, behind, first + len(waiting)),
            paid=tuple(guard for guard, _ in paid),
            prices=tuple(price for _, price in paid),
            raised=raised,
            guarded={
                operator: [(numbers[key], key[1]) for key in keys if key in numbers]
                for operator, keys in blocked.items()
            },
        )

    def _triggered(self, state: State) -> TriggeredGuards:
        """Find what a state's violated negative conditions and triggered guards change."""
        s, found = self._successors, TriggeredGuards()
        waiting, raised, blocked = found.waiting, found.raised, found.blocked
        for fact in bits(state):
            if fact in self.negative:
                waiting[1 << fact, math.inf] = list(self.negative[fact])

        for facts in s.triggered(state):
            removal = min(self.removal[fact] for fact in bits(facts))
            for operator, price in s.penalties(facts).items():
                paid = price <= removal and price < math.inf
                if paid:
                    raised[operator] = raised.get(operator, 0.0) + price
                else:
                    blocked.setdefault(operator, []).append((facts, price))

                for i in self.of_operator[operator]:
                    if paid:
                        found.dearer.append(i)
                        found.by.append(price)
                    else:
                        waiting.setdefault((facts, price), []).append(i)
        return found

    def explore(self, closed: State, *, additive: bool) -> RelaxedExploration:
        """Compute the costs of all facts from a state: sums of the preconditions' costs (hadd) or
        their maximum (hmax).

        Facts are taken in the order of their costs, until the goal is reached at the cost of all
        that is left.

        Args:
            closed: The state with its derived facts.
            additive: Sum, or maximum.
        """
        it = self.relaxed_state(closed)
        holding, kernels = self.holding(closed), it.kernels
        here, prices = (
            kernels.integers((*it.paid, *holding)),
            kernels.reals((*it.prices, *[0.0] * len(holding))),
        )
        costs, supporters = kernels.explore(
            it.before, it.effects, it.needed, it.costs, here, prices, self._ends, additive
        )
        return RelaxedExploration(costs, supporters, it, self.goals)

    def plan(self, exploration: RelaxedExploration) -> tuple[float, list[int]]:
        """Extract a relaxed plan made of best supporters: its cost, guards' prices included, and
        its operators.

        Facts are taken in the order of falling cost. One that an operator chosen already adds needs
        no supporter of its own, if that operator is cheaper than what the fact is needed for: the
        hand is free for the next body once this one is placed where it shall be, it need not be put
        back first.
        """
        it = exploration.relaxed_state
        cost, plan = it.kernels.relaxed_plan(
            exploration.costs, exploration.supporters, it.before, it.effects, it.costs, self.owners,
            len(self.of_operator), self._ends, 2 * self._size,
        )  # fmt: skip
        return cost, list(map(int, plan))


def _split(mask: State) -> list[int]:
    return list(bits(mask))
