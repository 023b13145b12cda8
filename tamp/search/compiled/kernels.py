"""The inner loops of the heuristics, compiled by numba: all in one file, since numba's cache watches one file only.

Lists of lists are two arrays, `rows.Rows`. Operators and facts are those of `tamp.search.relaxation`.
"""

# pyright: basic, reportCallIssue=false
# Calls of compiled functions, whose arguments it does not know.

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numba import njit, types

from tamp.search.compiled.rows import Integers, Reals

ZERO = 1e-9
"""Costs below are nothing: what rounding leaves of a cost that cuts have used up."""

_inner = njit(nogil=True, no_cpython_wrapper=True, no_cfunc_wrapper=True)
_I, _F, _N = types.int64[::1], types.float64[::1], types.float64


@_inner
def _before(fact, other, keys, ranks):
    return keys[fact] < keys[other] or (keys[fact] == keys[other] and ranks[fact] < ranks[other])


@_inner
def _push(fact, heap, places, size, keys, ranks):
    """Put a fact into the heap, or move it up after its key fell; the new size. `places` is -1 for those not inside."""
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


@_inner
def _pop(heap, places, size, keys, ranks):
    """Take out the fact with the lowest key, among equals that with the lowest rank."""
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


@njit(types.Tuple((_F, _I))(_I, _I, _I, _I, _I, _F, _I, _F, _I, types.boolean), cache=True, nogil=True)
def _explore(before_starts, effect_starts, effects, need_starts, needs, costs, here, prices, goals, additive):
    """What `Relaxation.explore` promises: the facts' costs and supporters. Among equals the first found goes first.

    `here`: the facts to begin with, and what each costs.
    """
    facts, operators = need_starts.size - 1, costs.size
    reached, supporters = np.full(facts, math.inf), np.full(facts, -1)
    heap, places, ranks = np.empty(facts, dtype=np.int64), np.full(facts, -1), np.zeros(facts, dtype=np.int64)
    left, totals = before_starts[1:] - before_starts[:-1], costs.copy()
    size = rank = 0
    for k in range(here.size):
        fact = here[k]
        reached[fact], ranks[fact] = prices[k], rank
        rank += 1
        size = _push(fact, heap, places, size, reached, ranks)
    for i in range(operators):
        if not left[i]:
            for k in range(effect_starts[i], effect_starts[i + 1]):
                effect = effects[k]
                if totals[i] < reached[effect]:
                    reached[effect], supporters[effect], ranks[effect] = totals[i], i, rank
                    rank += 1
                    size = _push(effect, heap, places, size, reached, ranks)
    now = 0.0
    while size:
        cost = reached[heap[0]]
        if cost > now:
            if np.all(reached[goals] <= now):
                break
            now = cost
        fact = _pop(heap, places, size, reached, ranks)
        size -= 1
        for n in range(need_starts[fact], need_starts[fact + 1]):
            i = needs[n]
            left[i] -= 1
            if additive:
                totals[i] += cost
            if not left[i]:
                total = totals[i] if additive else totals[i] + cost
                for k in range(effect_starts[i], effect_starts[i + 1]):
                    effect = effects[k]
                    if total < reached[effect]:
                        reached[effect], supporters[effect], ranks[effect] = total, i, rank
                        rank += 1
                        size = _push(effect, heap, places, size, reached, ranks)
    return reached, supporters


@njit(types.Tuple((_N, _I))(_F, _I, _I, _I, _I, _I, _F, _I, types.int64, _I, types.int64), cache=True, nogil=True)
def _relaxed_plan(
    reached, supporters, before_starts, before, effect_starts, effects, costs, owners, operators, goals, guards
):  # fmt: skip
    """What `Relaxation.plan` promises: the cost and the operators, ascending. Facts from `guards` on are guards."""
    facts = reached.size
    keys, ranks = -reached, np.arange(facts)
    heap, places, seen = np.empty(facts, dtype=np.int64), np.full(facts, -1), np.zeros(facts, dtype=np.bool_)
    bounds, provided = np.full(facts, math.inf), np.full(facts, math.inf)
    chosen = np.full(operators, -1.0)
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
        if provided[fact] < math.inf and provided[fact] <= bounds[fact]:
            continue
        if i < owners.size and owners[i] >= 0:
            chosen[owners[i]] = max(chosen[owners[i]], costs[i])
            for k in range(effect_starts[i], effect_starts[i + 1]):
                provided[effects[k]] = min(provided[effects[k]], reached[fact])
        bound = reached[fact] - costs[i]
        for k in range(before_starts[i], before_starts[i + 1]):
            other = before[k]
            bounds[other] = min(bounds[other], bound)
            if not seen[other]:
                seen[other] = True
                size = _push(other, heap, places, size, keys, ranks)
    plan = np.flatnonzero(chosen >= 0.0)
    price = 0.0
    for i in plan:
        price += chosen[i]
    return total + price, plan


@_inner
def _levels(before_starts, effect_starts, effects, need_starts, needs, costs, here, heap, places, ranks):
    """The cost of all facts by hmax, and for each operator its dearest precondition and what that costs."""
    reached = np.full(need_starts.size - 1, math.inf)
    dearest, levels = np.full(costs.size, -1), np.full(costs.size, math.inf)
    left = before_starts[1:] - before_starts[:-1]
    size = 0
    for fact in here:
        reached[fact] = 0.0
        size = _push(fact, heap, places, size, reached, ranks)
    while size:
        fact = _pop(heap, places, size, reached, ranks)
        size -= 1
        cost = reached[fact]
        for n in range(need_starts[fact], need_starts[fact + 1]):
            i = needs[n]
            left[i] -= 1
            if not left[i]:
                dearest[i], levels[i] = fact, cost
                for k in range(effect_starts[i], effect_starts[i + 1]):
                    if cost + costs[i] < reached[effects[k]]:
                        reached[effects[k]] = cost + costs[i]
                        size = _push(effects[k], heap, places, size, reached, ranks)
    return reached, dearest, levels


@_inner
def _find_cut(effect_starts, effects, need_starts, needs, add_starts, adders, costs, here, dearest, goal, stack, cut):
    """Fill `cut` with the operators that lead into the facts from which the goal costs nothing more; how many."""
    zone, seen = np.zeros(stack.size, dtype=np.bool_), np.zeros(stack.size, dtype=np.bool_)
    zone[goal] = True
    stack[0] = goal
    size, count = 1, 0
    while size:
        size -= 1
        fact = stack[size]
        for n in range(add_starts[fact], add_starts[fact + 1]):
            other = dearest[adders[n]]
            if costs[adders[n]] <= 0.0 and other >= 0 and not zone[other]:
                zone[other] = True
                stack[size] = other
                size += 1
    for fact in here:
        if not zone[fact] and not seen[fact]:
            seen[fact] = True
            stack[size] = fact
            size += 1
    while size:
        size -= 1
        fact = stack[size]
        for n in range(need_starts[fact], need_starts[fact + 1]):
            i = needs[n]
            if dearest[i] != fact:
                continue
            leads = False
            for k in range(effect_starts[i], effect_starts[i + 1]):
                leads = leads or zone[effects[k]]
            if leads:
                cut[count] = i
                count += 1
                continue
            for k in range(effect_starts[i], effect_starts[i + 1]):
                if not seen[effects[k]]:
                    seen[effects[k]] = True
                    stack[size] = effects[k]
                    size += 1
    return count


@njit(_N(_I, _I, _I, _I, _I, _I, _I, _I, _F, _I, _I, _I, _I, types.int64), cache=True, nogil=True)
def _landmark_cut(
    before_starts, before, effect_starts, effects, need_starts, needs, add_starts, adders, costs, here, owners,
    group_starts, groups, goal,
):  # fmt: skip
    """What `LandmarkCut.value` promises. The row of an owner in `groups`: its operators, which get cheaper together."""
    facts, operators = need_starts.size - 1, costs.size
    costs = costs.copy()
    heap, places, ranks = np.empty(facts, dtype=np.int64), np.full(facts, -1), np.arange(facts)
    stack, cut = np.empty(facts, dtype=np.int64), np.empty(operators, dtype=np.int64)
    changed, marks = np.empty(operators, dtype=np.int64), np.full(operators, -1)
    reached, dearest, levels = _levels(
        before_starts, effect_starts, effects, need_starts, needs, costs, here, heap, places, ranks
    )
    total, turn = 0.0, 0
    while reached[goal] > ZERO and reached[goal] < math.inf:
        count = _find_cut(
            effect_starts, effects, need_starts, needs, add_starts, adders, costs, here, dearest, goal, stack, cut
        )
        least = math.inf
        for k in range(count):
            least = min(least, costs[cut[k]])
        total += least
        many = 0
        for k in range(count):
            owner = owners[cut[k]] if cut[k] < owners.size else -1
            first, last = (group_starts[owner], group_starts[owner + 1]) if owner >= 0 else (0, 1)
            for n in range(first, last):
                i = groups[n] if owner >= 0 else cut[k]
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
            for k in range(effect_starts[i], effect_starts[i + 1]):
                if levels[i] + costs[i] < reached[effects[k]]:
                    reached[effects[k]] = levels[i] + costs[i]
                    size = _push(effects[k], heap, places, size, reached, ranks)
        while size:
            fact = _pop(heap, places, size, reached, ranks)
            size -= 1
            for n in range(need_starts[fact], need_starts[fact + 1]):
                i = needs[n]
                if dearest[i] != fact or levels[i] <= reached[fact]:
                    continue
                most = before[before_starts[i]]
                for k in range(before_starts[i], before_starts[i + 1]):
                    if reached[before[k]] > reached[most]:
                        most = before[k]
                dearest[i] = most
                if reached[most] < levels[i]:
                    levels[i] = reached[most]
                    for k in range(effect_starts[i], effect_starts[i + 1]):
                        if levels[i] + costs[i] < reached[effects[k]]:
                            reached[effects[k]] = levels[i] + costs[i]
                            size = _push(effects[k], heap, places, size, reached, ranks)
    return total if reached[goal] < math.inf else math.inf


explore: Callable[..., tuple[Reals, Integers]] = _explore
relaxed_plan: Callable[..., tuple[float, Integers]] = _relaxed_plan
landmark_cut: Callable[..., float] = _landmark_cut
