"""The queue of landmark cuts: buckets in the order of cost, a heap where many costs wait at a time."""

from __future__ import annotations

from random import Random

import pytest

from tamp.symbolic.search.heuristics.loops.landmark_queue import (
    Buckets,
    are_few,
    bucket_of_nearest,
    put,
    put_far,
)
from tests.symbolic.search.heuristics.loops.queues import empty


def in_order(queue: Buckets) -> list[tuple[float, int]]:
    """All entries, bucket by bucket, from the top down; then those of the heap."""
    found, bucket = [], 0
    while bucket >= 0:
        entry = queue.tops[bucket]
        while entry >= 0:
            found.append((queue.costs[bucket], queue.facts[entry]))
            entry = queue.below[entry]
        bucket = bucket_of_nearest(queue) if queue.sizes[2] else queue.later[bucket]
    return found


def test_buckets_stand_in_the_order_of_cost_whatever_was_put_first() -> None:
    queue = empty(10)
    for fact, cost in [(7, 2.0), (3, 0.5), (4, 2.0), (1, 9.0), (2, 1.0)]:
        put(fact, cost, 0, queue)
    assert in_order(queue) == [(0.5, 3), (1.0, 2), (2.0, 4), (2.0, 7), (9.0, 1)]


def test_the_heap_gives_its_facts_in_the_order_of_cost_those_of_one_cost_together() -> None:
    rng = Random(0)
    costs = [rng.choice((rng.random(), float(rng.randint(1, 3)))) for _ in range(300)]
    queue = empty(300)
    for fact, cost in enumerate(costs):
        put_far(fact, cost, queue.far_costs, queue.far_facts, queue.sizes)
    found = in_order(queue)
    assert [cost for cost, _ in found] == sorted(costs)
    assert sorted(fact for _, fact in found) == list(range(300))
    assert all(costs[fact] == cost for cost, fact in found)
    assert bucket_of_nearest(queue) == -1


@pytest.mark.parametrize(
    ("costs", "few"),
    [([0.0, 1.0, 32.0], True), ([1.0, 33.0], False), ([1.0, 0.5], False), ([], True)],
)
def test_few_costs_wait_where_all_are_small_whole_numbers(costs: list[float], few: bool) -> None:
    assert are_few(costs) is few
