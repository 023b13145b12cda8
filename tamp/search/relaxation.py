"""The delete relaxation of a state: the cheapest way to each fact when nothing is ever deleted.

Three things go beyond STRIPS. A negative condition violated in the evaluated state waits for the complement of its
fact, which the operators that delete the fact achieve. A triggered guard waits likewise, or is paid for: its operator
gets a precondition that costs the lesser of the guard's price and of removing its facts. Conditional effects and axioms
are operators of their own. Negated derived facts are taken for free (only recursive ones are left at this stage).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from tamp.search.successors import State, Successors, bits


@dataclass(slots=True)
class Situation:
    """The relaxed task for the states in which the same guards are triggered and negative conditions violated.

    Attributes:
        before: Preconditions of each relaxed operator.
        counts: Their number.
        costs: Their costs.
        effects: Their effects: facts, complements of facts, paid guards.
        needed: For each fact, complement or guard, the relaxed operators that wait for it.
        seeds: Guards that can be paid for, with the price.
    """

    before: list[list[int]]
    counts: list[int]
    costs: list[float]
    effects: list[list[int]]
    needed: list[list[int]]
    seeds: list[tuple[float, int]]


@dataclass(slots=True)
class Exploration:
    """The result: costs of facts, and for each the relaxed operator that reaches it best (-1: it holds, or is paid)."""

    costs: list[float]
    supporters: list[int]
    situation: Situation
    goals: list[int]

    @property
    def dead(self) -> bool:
        """Whether the goal is out of reach even in the relaxation, so that the state is a dead end."""
        return any(self.costs[goal] == math.inf for goal in self.goals)


class Relaxation:
    """The delete relaxation of a task.

    Args:
        successors: The task.
        steps: Count steps too where some operator costs nothing, so that estimates tell such steps from none at all.
            Not admissible.

    Attributes:
        owner: The operator that each relaxed operator belongs to, -1 for axioms.
        before: The preconditions of each relaxed operator.
        of_operator: The relaxed operators of each operator.
    """

    def __init__(self, successors: Successors, *, steps: bool) -> None:
        self._successors = s = successors
        self._size = size = len(s.facts)
        step = 1.0 if steps and any(s.cost[i] == 0.0 for i in s.alive) else 0.0
        self.owner: list[int] = []
        self.before: list[list[int]] = []
        self._costs: list[float] = []
        self._effects: list[list[int]] = []
        self._negative: dict[int, list[int]] = {}
        self.of_operator: dict[int, list[int]] = {}
        derived = s.mask(axiom.head for axiom in s.grounded.axioms)
        negated = s.guard_mask | s.goal_absent
        for i in s.alive:
            negated |= s.absent[i]
            for _, negative, _, _ in s.conditional[i]:
                negated |= negative
        for axiom in s.grounded.axioms:
            negated |= s.mask(axiom.negative)
        self._negated = negated = negated & ~derived
        every = (1 << size) - 1
        for i in s.alive:
            deleted = every & ~s.kept[i] & ~s.added[i] & negated
            effects = [*bits(s.added[i]), *(size + b for b in bits(deleted))]
            if effects or not s.conditional[i]:
                self._add(i, s.before[i], s.absent[i], s.cost[i] + step, effects)
            for positive, negative, added, removed in s.conditional[i]:
                effects = [*bits(added), *(size + b for b in bits(removed & ~added & ~s.added[i] & negated))]
                if effects:
                    self._add(i, s.before[i] | positive, s.absent[i] | negative, s.cost[i] + step, effects)
        for axiom, price in zip(s.grounded.axioms, s.axiom_cost, strict=True):
            cost = price if steps else 0.0
            self._add(-1, s.mask(axiom.positive), s.mask(axiom.negative), cost, [s.number[axiom.head]])
        self._counts = list(map(len, self.before))
        self._needed: list[list[int]] = [[] for _ in range(2 * size)]
        for i, facts in enumerate(self.before):
            for fact in facts:
                self._needed[fact].append(i)
        self._free = [i for i, count in enumerate(self._counts) if not count]
        self._removal = self._removal_costs()
        self._goals = list(bits(s.goal))
        self._negative_goals = list(bits(s.goal_absent & ~derived))
        self._situations: dict[int, Situation] = {}

    def _add(self, owner: int, before: int, absent: int, cost: float, effects: list[int]) -> None:
        number = len(self.owner)
        self.owner.append(owner)
        self.before.append(list(bits(before)))
        self._costs.append(cost)
        self._effects.append(effects)
        if owner >= 0:
            self.of_operator.setdefault(owner, []).append(number)
        for fact in bits(absent & self._negated):
            self._negative.setdefault(fact, []).append(number)

    def _removal_costs(self) -> list[float]:
        """For each fact the cost of the cheapest operator that deletes it."""
        costs = [math.inf] * self._size
        for i, effects in enumerate(self._effects):
            for effect in effects:
                if effect >= self._size:
                    costs[effect - self._size] = min(costs[effect - self._size], self._costs[i])
        return costs

    @property
    def goals(self) -> list[int]:
        """The relaxed facts that the goal asks for."""
        return self._goals + [self._size + fact for fact in self._negative_goals]

    def holding(self, closed: State) -> list[int]:
        """The relaxed facts that hold in a state with its derived facts: facts, and complements that the goal names."""
        return [*bits(closed), *(self._size + fact for fact in self._negative_goals if not closed >> fact & 1)]

    def key(self, state: State) -> State:
        """What states with the same situation have in common."""
        return state & self._negated

    def situation(self, state: State) -> Situation:
        """The relaxed task as seen from a state."""
        key = self.key(state)
        known = self._situations.get(key)
        if known is None:
            if len(self._situations) > 10_000:
                self._situations.clear()
            known = self._situations[key] = self._situation(key)
        return known

    def _situation(self, state: State) -> Situation:
        s, size = self._successors, self._size
        costs = self._costs[:]
        waiting: dict[tuple[int, float], list[int]] = {}
        for fact in bits(state):
            if fact in self._negative:
                waiting[1 << fact, math.inf] = list(self._negative[fact])
        for facts in s.triggered(state):
            removal = min(self._removal[fact] for fact in bits(facts))
            for operator, price in s.penalties(facts).items():
                for i in self.of_operator.get(operator, ()):
                    if price <= removal and price < math.inf:
                        costs[i] += price
                    else:
                        waiting.setdefault((facts, price), []).append(i)
        if not waiting:
            return Situation(self.before, self._counts, costs, self._effects, self._needed, [])
        before, counts, effects, needed = self.before[:], self._counts[:], self._effects[:], self._needed[:]
        seeds: list[tuple[float, int]] = []
        for (facts, price), operators in waiting.items():
            number = len(needed)
            needed.append(operators)
            for i in operators:
                counts[i] += 1
                before[i] = [*before[i], number]
            if price < math.inf:
                seeds.append((price, number))
            for fact in bits(facts):
                needed[size + fact] = [*needed[size + fact], len(counts)]
                before.append([size + fact])
                counts.append(1)
                costs.append(0.0)
                effects.append([number])
        return Situation(before, counts, costs, effects, needed, seeds)

    def explore(self, closed: State, *, additive: bool) -> Exploration:
        """Costs of all facts from a state: sums of the preconditions' costs (hadd) or their maximum (hmax).

        Args:
            closed: The state with its derived facts.
            additive: Sum, or maximum.
        """
        situation = self.situation(closed)
        size = self._size
        costs = [math.inf] * len(situation.needed)
        supporters = [-1] * len(costs)
        counts, totals = situation.counts[:], situation.costs[:]
        effects, needed = situation.effects, situation.needed
        # Many facts cost the same: a bucket a cost, and a heap of the different costs.
        here = list(bits(closed))
        for fact in here:
            costs[fact] = 0.0
        for fact in self._negative_goals:
            if not closed >> fact & 1:
                costs[size + fact] = 0.0
        buckets: dict[float, list[int]] = {0.0: here}
        heap = [0.0]
        goals = self._goals + [size + fact for fact in self._negative_goals]
        for price, number in situation.seeds:
            costs[number] = price
            _push(buckets, heap, price, number)
        for i in self._free:
            if not counts[i]:
                total = totals[i]
                for effect in effects[i]:
                    if total < costs[effect]:
                        costs[effect] = total
                        supporters[effect] = i
                        _push(buckets, heap, total, effect)
        while heap:
            cost = heap[0]
            bucket = buckets[cost]
            for fact in bucket:  # it may grow meanwhile, by effects of operators without cost
                if cost > costs[fact]:
                    continue
                for i in needed[fact]:
                    counts[i] -= 1
                    if additive:
                        totals[i] += cost
                    if not counts[i]:
                        total = totals[i] if additive else totals[i] + cost
                        for effect in effects[i]:
                            if total < costs[effect]:
                                costs[effect] = total
                                supporters[effect] = i
                                into = buckets.get(total)
                                if into is None:
                                    buckets[total] = [effect]
                                    heappush(heap, total)
                                else:
                                    into.append(effect)
            heappop(heap)
            del buckets[cost]
            for goal in goals:
                if costs[goal] > cost:
                    break
            else:
                break
        return Exploration(costs, supporters, situation, goals)

    def plan(self, exploration: Exploration) -> tuple[float, list[int]]:
        """The cost of a relaxed plan made of best supporters, guards' prices included, and its operators.

        Facts are taken in the order of falling cost. One that an operator chosen already adds needs no supporter of
        its own, if that operator is cheaper than what the fact is needed for: the hand is free for the next body once
        this one is placed where it shall be, it need not be put back first.
        """
        costs, supporters, situation = exploration.costs, exploration.supporters, exploration.situation
        before, effects, owners = situation.before, situation.effects, self.owner
        total = 0.0
        chosen: dict[int, float] = {}
        needed = dict.fromkeys(exploration.goals, math.inf)
        provided: dict[int, float] = {}
        queue = [(-costs[fact], fact) for fact in needed]
        heapify(queue)
        while queue:
            cost, fact = heappop(queue)
            i = supporters[fact]
            if i < 0:
                if fact >= 2 * self._size:
                    total -= cost
                continue
            if fact in provided and provided[fact] <= needed[fact]:
                continue
            if i < len(owners) and owners[i] >= 0:
                owner = owners[i]
                chosen[owner] = max(chosen.get(owner, 0.0), situation.costs[i])
                for effect in effects[i]:
                    provided[effect] = min(provided.get(effect, math.inf), -cost)
            bound = -cost - situation.costs[i]
            for other in before[i]:
                known = needed.get(other)
                if known is None:
                    needed[other] = bound
                    heappush(queue, (-costs[other], other))
                elif bound < known:
                    needed[other] = bound
        return total + sum(chosen[i] for i in sorted(chosen)), sorted(chosen)


def _push(buckets: dict[float, list[int]], heap: list[float], cost: float, fact: int) -> None:
    if cost in buckets:
        buckets[cost].append(fact)
    else:
        buckets[cost] = [fact]
        heappush(heap, cost)
