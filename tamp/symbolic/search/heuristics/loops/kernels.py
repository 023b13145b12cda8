"""The inner loops of the heuristics, in Python that numba can compile; see `selection`.

Operators and facts are those of `heuristics.relaxation`. Compiled, all lists are arrays.
"""

from __future__ import annotations

import math

from tamp.symbolic.search.heuristics.loops.rows import CsrRows, Integers, Reals, count_up, full


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
