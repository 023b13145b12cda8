"""A bucket queue (Dial, Shortest-Path Forest with Topological Ordering, 1969) of facts for the
landmark-cut heuristic's inner loop, with a binary heap where costs are many.

In Python that numba can compile; see `selection`. Compiled, all lists are arrays.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tamp.symbolic.search.heuristics.loops.rows import Reals

MOST_OF_FEW = 32
"""The largest cost of operators, all of whole numbers, whose facts are put into linked buckets: no
more than so many costs wait at a time.
"""


class Buckets(NamedTuple):
    """A priority queue of facts: buckets of one cost each, linked in the order of cost, where few
    costs wait at a time; else one bucket of those that are next, and a heap of all others.

    Attributes:
        costs: Of the facts in each bucket.
        tops: The entry on top of each bucket, -1 where it is empty.
        later: The bucket after each, -1 at the end.
        facts: Of each entry.
        below: The entry below each in its bucket, -1 at the bottom.
        far_costs: A binary heap of costs, the least first.
        far_facts: The facts that have them.
        sizes: How many buckets there are, how many entries, and how many facts in the heap.
    """

    costs: list[float]
    tops: list[int]
    later: list[int]
    facts: list[int]
    below: list[int]
    far_costs: list[float]
    far_facts: list[int]
    sizes: list[int]


def put(fact: int, cost: float, first: int, queue: Buckets) -> None:
    """Put a fact into the bucket of its cost, from bucket `first` on, whose cost is not more.

    Short and without calls, so that it is compiled into its caller: to pass so many arrays on takes
    longer than what is done here.
    """
    bucket, last, sizes = first, first, queue.sizes
    while bucket >= 0 and queue.costs[bucket] < cost:
        last, bucket = bucket, queue.later[bucket]
    if bucket < 0 or queue.costs[bucket] != cost:
        new = sizes[0]
        sizes[0] += 1
        queue.costs[new], queue.tops[new], queue.later[new] = cost, -1, bucket
        queue.later[last] = new
        bucket = new

    entry = sizes[1]
    sizes[1] += 1
    queue.facts[entry], queue.below[entry] = fact, queue.tops[bucket]
    queue.tops[bucket] = entry


def put_far(fact: int, cost: float, costs: list[float], facts: list[int], sizes: list[int]) -> None:
    """Put a fact onto the heap."""
    place = sizes[2]
    sizes[2] += 1
    while place > 0:
        parent = (place - 1) >> 1
        if costs[parent] <= cost:
            break
        costs[place], facts[place] = costs[parent], facts[parent]
        place = parent
    costs[place], facts[place] = cost, fact


def take_far(costs: list[float], facts: list[int], sizes: list[int]) -> int:
    """Take the cheapest fact from the heap."""
    taken, place = facts[0], 0
    sizes[2] -= 1
    size = sizes[2]
    cost, fact = costs[size], facts[size]
    while 2 * place + 1 < size:
        child = 2 * place + 1
        if child + 1 < size and costs[child + 1] < costs[child]:
            child += 1
        if cost <= costs[child]:
            break
        costs[place], facts[place] = costs[child], facts[child]
        place = child
    costs[place], facts[place] = cost, fact
    return taken


def bucket_of_nearest(queue: Buckets) -> int:
    """Empty the heap of its cheapest facts into the only bucket; return it, -1 where there are
    none.
    """
    sizes = queue.sizes
    if not sizes[2]:
        return -1
    sizes[1] = 0
    queue.costs[0], queue.tops[0], queue.later[0] = queue.far_costs[0], -1, -1
    while sizes[2] and queue.far_costs[0] == queue.costs[0]:
        put(take_far(queue.far_costs, queue.far_facts, sizes), queue.costs[0], 0, queue)
    return 0


def are_few(costs: Reals) -> bool:
    """Check that few costs wait at a time: all are small whole numbers."""
    few = True
    for cost in costs:
        few = few and cost <= MOST_OF_FEW and cost == math.floor(cost)
    return few
