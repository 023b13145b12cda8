"""The inner loop of the landmark-cut heuristic, in Python that numba can compile; see `selection`.

Operators and facts are those of `heuristics.lmcut`: the last operator has the goals as
preconditions and the goal fact as effect. Compiled, all lists are arrays.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tamp.symbolic.search.heuristics.loops.landmark_queue import (
    Buckets,
    are_few,
    bucket_of_nearest,
    put,
    put_far,
)
from tamp.symbolic.search.heuristics.loops.rows import CsrRows, Integers, Reals, full

ZERO = 1e-9
"""Costs below are nothing: what rounding leaves of a cost that cuts have used up."""


class CheaperThanGoal(NamedTuple):
    """All that is reached for less than the goal costs, by hmax.

    Attributes:
        reached: Each fact's cost; of those that cost as much as the goal, or more, some number
            that is not less than the goal's cost.
        waiting: How many preconditions each operator lacks.
        fired: The operators that lack none, and behind them room for all others.
        settled: Facts in the order of cost.
    """

    reached: list[float]
    waiting: list[int]
    fired: list[int]
    settled: list[int]


def _dearest(goals: Integers, reached: Reals) -> float:
    most = 0.0
    for goal in goals:
        most = max(most, reached[goal])
    return most


def _explore(
    before: CsrRows, effects: CsrRows, needs: CsrRows, costs: Reals, here: Integers,
    goals: Integers, few: bool, queue: Buckets, found: CheaperThanGoal,
) -> tuple[float, int]:  # fmt: skip
    """Compute hmax from the facts that hold, up to the goal's cost; return that, and how many
    operators are fired for less.
    """
    reached, waiting, fired, settled = found.reached, found.waiting, found.fired, found.settled
    for i in range(len(costs)):
        waiting[i] = before.starts[i + 1] - before.starts[i]
    for fact in range(len(reached)):
        reached[fact] = math.inf
    queue.costs[0], queue.tops[0], queue.later[0] = 0.0, -1, -1
    queue.sizes[0], queue.sizes[1], queue.sizes[2] = 1, 0, 0
    for fact in here:
        reached[fact] = 0.0
        put(fact, 0.0, 0, queue)

    bucket = count = many = earlier = cheaper = 0
    while bucket >= 0:
        cost, entry = queue.costs[bucket], queue.tops[bucket]
        if entry < 0:  # all facts of this cost are settled: can the goal cost more than the next?
            bucket = queue.later[bucket] if few else bucket_of_nearest(queue)
            if bucket < 0 or _dearest(goals, reached) <= queue.costs[bucket]:
                break
            earlier, cheaper = count, many
            continue
        queue.tops[bucket] = queue.below[entry]
        fact = queue.facts[entry]
        if reached[fact] < cost:  # settled before
            continue
        settled[count] = fact
        count += 1
        for n in range(needs.starts[fact], needs.starts[fact + 1]):
            i = needs.values[n]
            waiting[i] -= 1
            if waiting[i]:
                continue
            fired[many] = i
            many += 1
            for k in range(effects.starts[i], effects.starts[i + 1]):
                effect, dear = effects.values[k], cost + costs[i]
                if dear < reached[effect]:
                    reached[effect] = dear
                    if few or dear == cost:
                        put(effect, dear, bucket, queue)
                    else:
                        put_far(effect, dear, queue.far_costs, queue.far_facts, queue.sizes)

    least = _dearest(goals, reached)
    if count and least < math.inf and least <= reached[settled[count - 1]]:
        for n in range(earlier, count):  # facts that cost as much as the goal are taken back
            fact = settled[n]
            for k in range(needs.starts[fact], needs.starts[fact + 1]):
                waiting[needs.values[k]] += 1
        many = cheaper
    return least, many


def _fill_zone(
    before: CsrRows, adders: CsrRows, costs: Reals, goal: int, reached: Reals, zone: list[bool],
    listed: list[int],
) -> int:  # fmt: skip
    """List the goal zone, from which the goal costs nothing more; return how many facts it has.

    An operator without costs into it needs one of its preconditions in it: the dearest, which
    costs no less than the goal, among equals that with the fewest operators that add it. Cuts are
    small so, which makes the estimate higher; any choice among equals is admissible.
    """
    zone[goal] = True
    listed[0] = goal
    count, done = 1, 0
    while done < count:
        fact = listed[done]
        done += 1
        for n in range(adders.starts[fact], adders.starts[fact + 1]):
            i = adders.values[n]
            if costs[i] > 0.0:
                continue
            chosen, fewest = -1, 0
            for k in range(before.starts[i], before.starts[i + 1]):
                other = before.values[k]
                if zone[other]:
                    chosen = -1
                    break
                ways = adders.starts[other + 1] - adders.starts[other]
                if (
                    chosen < 0
                    or reached[other] > reached[chosen]
                    or (reached[other] == reached[chosen] and ways < fewest)
                ):
                    chosen, fewest = other, ways
            if chosen >= 0:
                zone[chosen] = True
                listed[count] = chosen
                count += 1
    return count


def _find_cut(
    effects: CsrRows, needs: CsrRows, least: float, many: int, found: CheaperThanGoal,
    zone: list[bool], seen: list[bool], stack: list[int], cut: list[int],
) -> int:  # fmt: skip
    """Fill `cut` with the operators that enter the goal zone and can be reached without it; return
    how many. `many` operators are fired.
    """
    reached, waiting, fired = found.reached, found.waiting, found.fired
    for fact in range(len(seen)):
        seen[fact] = False
    done = size = count = 0
    while done < many or size:
        if done == many:
            size -= 1
            fact = stack[size]
            for n in range(needs.starts[fact], needs.starts[fact + 1]):
                i = needs.values[n]
                waiting[i] -= 1
                if not waiting[i]:
                    fired[many] = i
                    many += 1
            continue
        i = fired[done]
        done += 1
        first, last = effects.starts[i], effects.starts[i + 1]
        enters = False
        for k in range(first, last):
            enters = enters or zone[effects.values[k]]
        if enters:
            cut[count] = i
            count += 1
            continue
        for k in range(first, last):
            fact = effects.values[k]
            if reached[fact] >= least and not seen[fact]:
                seen[fact] = True
                stack[size] = fact
                size += 1
    return count


def _make_cheaper(
    costs: list[float], cut: Integers, count: int, owners: Integers, groups: CsrRows, turn: int,
    marks: list[int],
) -> float:  # fmt: skip
    """Take the cost of the cheapest operator in a cut off all of it, and off those that belong to
    the same owners; return it.
    """
    least = math.inf
    for k in range(count):
        least = min(least, costs[cut[k]])
    for k in range(count):
        owner = owners[cut[k]] if cut[k] < len(owners) else -1
        first, last = (groups.starts[owner], groups.starts[owner + 1]) if owner >= 0 else (0, 1)
        for n in range(first, last):
            i = groups.values[n] if owner >= 0 else cut[k]
            if marks[i] != turn:
                marks[i] = turn
                costs[i] = costs[i] - least if costs[i] - least > ZERO else 0.0
    return least


def landmark_cut(
    before: CsrRows, effects: CsrRows, needs: CsrRows, adders: CsrRows, prices: Reals,
    here: Integers, owners: Integers, groups: CsrRows, goal: int,
) -> float:  # fmt: skip
    """Compute `LandmarkCut.value`. Row i of `groups`: operators of owner i, cheaper together."""
    facts, operators = len(needs.starts) - 1, len(prices)
    costs, marks = full(operators, 0.0), full(operators, -1)
    for i in range(operators):
        costs[i] = prices[i]
    room = facts + len(effects.values)
    queue = Buckets(
        full(room, 0.0),
        full(room, 0),
        full(room, 0),
        full(room, 0),
        full(room, 0),
        full(room, 0.0),
        full(room, 0),
        full(3, 0),
    )
    found = CheaperThanGoal(
        full(facts, math.inf), full(operators, 0), full(operators, 0), full(facts, 0)
    )
    zone, seen = full(facts, False), full(facts, False)
    listed, stack, cut = full(facts, 0), full(facts, 0), full(operators, 0)
    goals = before.values[before.starts[operators - 1] : before.starts[operators]]
    total, turn, few = 0.0, 0, are_few(prices)

    least, many = _explore(before, effects, needs, costs, here, goals, few, queue, found)
    while ZERO < least < math.inf:
        size = _fill_zone(before, adders, costs, goal, found.reached, zone, listed)
        count = _find_cut(effects, needs, least, many, found, zone, seen, stack, cut)
        for n in range(size):
            zone[listed[n]] = False

        total += _make_cheaper(costs, cut, count, owners, groups, turn, marks)
        turn += 1
        least, many = _explore(before, effects, needs, costs, here, goals, few, queue, found)
    return total if least < math.inf else math.inf
