"""The inner loops of the heuristics, in Python that numba can compile; see `selection`.

All in one file, since numba's cache watches one file only. Operators and facts are those of
`heuristics.relaxation`. Compiled, all lists are arrays.
"""

from __future__ import annotations

import math

from tamp.symbolic.search.heuristics.loops.rows import CsrRows, Integers, Reals, count_up, full

ZERO = 1e-9
"""Costs below are nothing: what rounding leaves of a cost that cuts have used up."""


def _before(fact: int, other: int, keys: Reals, ranks: Integers) -> bool:
    return keys[fact] < keys[other] or (keys[fact] == keys[other] and ranks[fact] < ranks[other])


def _push(
    fact: int, heap: list[int], places: list[int], size: int, keys: Reals, ranks: Integers
) -> int:
    """Push a fact, or move it up after its key fell; return the size. places[fact] < 0: outside."""
    k = places[fact]
    if k < 0:
        k = size
        size += 1
    while k > 0:
        parent = (k - 1) >> 1
        other = heap[parent]
        if not _before(fact, other, keys, ranks):
            break
        heap[k], places[other] = other, k
        k = parent
    heap[k], places[fact] = fact, k
    return size


def _pop(heap: list[int], places: list[int], size: int, keys: Reals, ranks: Integers) -> int:
    """Pop the fact with the lowest key, among equals that with the lowest rank."""
    top = heap[0]
    places[top] = -1
    size -= 1
    if size:
        fact, k = heap[size], 0
        while True:
            child = 2 * k + 1
            if child >= size:
                break
            if child + 1 < size and _before(heap[child + 1], heap[child], keys, ranks):
                child += 1
            other = heap[child]
            if not _before(other, fact, keys, ranks):
                break
            heap[k], places[other] = other, k
            k = child
        heap[k], places[fact] = fact, k
    return top


def explore(
    before: CsrRows, effects: CsrRows, needs: CsrRows, costs: Reals, here: Integers, prices: Reals,
    goals: Integers, additive: bool,
) -> tuple[list[float], list[int]]:  # fmt: skip
    """Compute the facts' costs and best supporters (`Relaxation.explore`); the first found wins.

    `here`: the facts to begin with, and what each costs.
    """
    facts, operators = len(needs.starts) - 1, len(costs)
    reached, supporters = full(facts, math.inf), full(facts, -1)
    heap, places, ranks = full(facts, 0), full(facts, -1), full(facts, 0)
    left, totals = full(operators, 0), full(operators, 0.0)
    for i in range(operators):
        left[i], totals[i] = before.starts[i + 1] - before.starts[i], costs[i]
    size = rank = 0
    for k in range(len(here)):
        fact = here[k]
        reached[fact], ranks[fact] = prices[k], rank
        rank += 1
        size = _push(fact, heap, places, size, reached, ranks)
    for i in range(operators):
        if not left[i]:
            for k in range(effects.starts[i], effects.starts[i + 1]):
                effect = effects.values[k]
                if totals[i] < reached[effect]:
                    reached[effect], supporters[effect], ranks[effect] = totals[i], i, rank
                    rank += 1
                    size = _push(effect, heap, places, size, reached, ranks)
    now = 0.0
    while size:
        cost = reached[heap[0]]
        if cost > now:  # all facts that cost less are done: is the goal among them?
            dearest = 0.0
            for goal in goals:
                dearest = max(dearest, reached[goal])
            if dearest <= now:
                break
            now = cost
        fact = _pop(heap, places, size, reached, ranks)
        size -= 1
        for n in range(needs.starts[fact], needs.starts[fact + 1]):
            i = needs.values[n]
            left[i] -= 1
            if additive:
                totals[i] += cost
            if not left[i]:
                total = totals[i] if additive else totals[i] + cost
                for k in range(effects.starts[i], effects.starts[i + 1]):
                    effect = effects.values[k]
                    if total < reached[effect]:
                        reached[effect], supporters[effect], ranks[effect] = total, i, rank
                        rank += 1
                        size = _push(effect, heap, places, size, reached, ranks)
    return reached, supporters


def relaxed_plan(
    reached: Reals, supporters: Integers, before: CsrRows, effects: CsrRows, costs: Reals,
    owners: Integers, operators: int, goals: Integers, guards: int,
) -> tuple[float, list[int]]:  # fmt: skip
    """Extract a relaxed plan (`Relaxation.plan`): cost and operators; guards from `guards`."""
    facts = len(reached)
    keys, ranks = full(facts, 0.0), count_up(facts)
    for fact in range(facts):
        keys[fact] = -reached[fact]
    heap, places, seen = full(facts, 0), full(facts, -1), full(facts, False)
    bounds, provided = full(facts, math.inf), full(facts, math.inf)
    chosen = full(operators, -1.0)
    size, total = 0, 0.0
    for goal in goals:
        if not seen[goal]:
            seen[goal] = True
            size = _push(goal, heap, places, size, keys, ranks)
    while size:
        fact = _pop(heap, places, size, keys, ranks)
        size -= 1
        i = supporters[fact]
        if i < 0:
            if fact >= guards:
                total += reached[fact]
            continue
        if provided[fact] < math.inf and provided[fact] <= bounds[fact]:  # by one already chosen
            continue
        if i < len(owners) and owners[i] >= 0:
            chosen[owners[i]] = max(chosen[owners[i]], costs[i])
            for k in range(effects.starts[i], effects.starts[i + 1]):
                provided[effects.values[k]] = min(provided[effects.values[k]], reached[fact])
        bound = reached[fact] - costs[i]
        for k in range(before.starts[i], before.starts[i + 1]):
            other = before.values[k]
            bounds[other] = min(bounds[other], bound)
            if not seen[other]:
                seen[other] = True
                size = _push(other, heap, places, size, keys, ranks)
    price, count = 0.0, 0
    plan = full(operators, 0)
    for i in range(operators):
        if chosen[i] >= 0.0:
            price += chosen[i]
            plan[count] = i
            count += 1
    return total + price, plan[:count]


def _levels(
    before: CsrRows, effects: CsrRows, needs: CsrRows, costs: Reals, here: Integers,
    heap: list[int], places: list[int], ranks: Integers,
) -> tuple[list[float], list[int], list[float]]:  # fmt: skip
    """Compute all facts' costs by hmax, and each operator's dearest precondition with its cost."""
    reached = full(len(needs.starts) - 1, math.inf)
    dearest, levels = full(len(costs), -1), full(len(costs), math.inf)
    left = full(len(costs), 0)
    for i in range(len(costs)):
        left[i] = before.starts[i + 1] - before.starts[i]
    size = 0
    for fact in here:
        reached[fact] = 0.0
        size = _push(fact, heap, places, size, reached, ranks)
    while size:
        fact = _pop(heap, places, size, reached, ranks)
        size -= 1
        cost = reached[fact]
        for n in range(needs.starts[fact], needs.starts[fact + 1]):
            i = needs.values[n]
            left[i] -= 1
            if not left[i]:  # facts come in the order of cost: the last one is the dearest
                dearest[i], levels[i] = fact, cost
                for k in range(effects.starts[i], effects.starts[i + 1]):
                    if cost + costs[i] < reached[effects.values[k]]:
                        reached[effects.values[k]] = cost + costs[i]
                        size = _push(effects.values[k], heap, places, size, reached, ranks)
    return reached, dearest, levels


def _find_cut(
    effects: CsrRows, needs: CsrRows, adders: CsrRows, costs: Reals, here: Integers,
    dearest: Integers, goal: int, stack: list[int], cut: list[int],
) -> int:  # fmt: skip
    """Fill `cut` with the operators that enter the zone where the goal is free; return how many."""
    zone, seen = full(len(stack), False), full(len(stack), False)
    zone[goal] = True  # backward over operators that cost nothing
    stack[0] = goal
    size, count = 1, 0
    while size:
        size -= 1
        fact = stack[size]
        for n in range(adders.starts[fact], adders.starts[fact + 1]):
            other = dearest[adders.values[n]]
            if costs[adders.values[n]] <= 0.0 and other >= 0 and not zone[other]:
                zone[other] = True
                stack[size] = other
                size += 1
    for fact in here:  # forward from the state, up to the zone
        if not zone[fact] and not seen[fact]:
            seen[fact] = True
            stack[size] = fact
            size += 1
    while size:
        size -= 1
        fact = stack[size]
        for n in range(needs.starts[fact], needs.starts[fact + 1]):
            i = needs.values[n]
            if dearest[i] != fact:
                continue
            leads = False
            for k in range(effects.starts[i], effects.starts[i + 1]):
                leads = leads or zone[effects.values[k]]
            if leads:
                cut[count] = i
                count += 1
                continue
            for k in range(effects.starts[i], effects.starts[i + 1]):
                if not seen[effects.values[k]]:
                    seen[effects.values[k]] = True
                    stack[size] = effects.values[k]
                    size += 1
    return count


def landmark_cut(
    before: CsrRows, effects: CsrRows, needs: CsrRows, adders: CsrRows, prices: Reals,
    here: Integers, owners: Integers, groups: CsrRows, goal: int,
) -> float:  # fmt: skip
    """Compute `LandmarkCut.value`. Row i of `groups`: operators of owner i, cheaper together."""
    facts, operators = len(needs.starts) - 1, len(prices)
    costs = full(operators, 0.0)
    for i in range(operators):
        costs[i] = prices[i]
    heap, places, ranks = full(facts, 0), full(facts, -1), count_up(facts)
    stack, cut = full(facts, 0), full(operators, 0)
    changed, marks = full(operators, 0), full(operators, -1)
    reached, dearest, levels = _levels(before, effects, needs, costs, here, heap, places, ranks)
    total, turn = 0.0, 0
    while reached[goal] > ZERO and reached[goal] < math.inf:
        count = _find_cut(effects, needs, adders, costs, here, dearest, goal, stack, cut)
        least = math.inf
        for k in range(count):
            least = min(least, costs[cut[k]])
        total += least
        many = 0
        for k in range(count):
            owner = owners[cut[k]] if cut[k] < len(owners) else -1
            first, last = (groups.starts[owner], groups.starts[owner + 1]) if owner >= 0 else (0, 1)
            for n in range(first, last):
                i = groups.values[n] if owner >= 0 else cut[k]
                if marks[i] != turn:
                    marks[i], changed[many] = turn, i
                    many += 1
        turn += 1
        size = 0
        for n in range(many):
            i = changed[n]
            costs[i] = costs[i] - least if costs[i] - least > ZERO else 0.0
        for n in range(many):
            i = changed[n]
            for k in range(effects.starts[i], effects.starts[i + 1]):
                if levels[i] + costs[i] < reached[effects.values[k]]:
                    reached[effects.values[k]] = levels[i] + costs[i]
                    size = _push(effects.values[k], heap, places, size, reached, ranks)
        while size:  # hmax again, only where costs fell
            fact = _pop(heap, places, size, reached, ranks)
            size -= 1
            for n in range(needs.starts[fact], needs.starts[fact + 1]):
                i = needs.values[n]
                if dearest[i] != fact or levels[i] <= reached[fact]:
                    continue
                most = before.values[before.starts[i]]
                for k in range(before.starts[i], before.starts[i + 1]):
                    if reached[before.values[k]] > reached[most]:
                        most = before.values[k]
                dearest[i] = most
                if reached[most] < levels[i]:
                    levels[i] = reached[most]
                    for k in range(effects.starts[i], effects.starts[i + 1]):
                        if levels[i] + costs[i] < reached[effects.values[k]]:
                            reached[effects.values[k]] = levels[i] + costs[i]
                            size = _push(effects.values[k], heap, places, size, reached, ranks)
    return total if reached[goal] < math.inf else math.inf
