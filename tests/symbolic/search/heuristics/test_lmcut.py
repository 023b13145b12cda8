"""Landmark cuts: by hand, never above the cheapest plan of the delete relaxation, never below hmax."""

from __future__ import annotations

import heapq
import math
from itertools import count
from random import Random

import pytest

from tamp.symbolic.search.heuristics import registry
from tamp.symbolic.search.heuristics.lmcut import LandmarkCuts
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import facts, operator, task


def lmcut(instantiated: InstantiatedTask, state: str) -> float:
    s = Successors(instantiated, {})
    cuts = LandmarkCuts(Relaxation(s, steps=False))
    value = cuts.value(s.mask(facts(state)))
    assert cuts.value(s.mask(facts(state))) == value  # from what is kept it is the same
    return value


def test_a_chain_costs_the_sum_of_its_links() -> None:
    chain = [operator("ab", "a", "b", cost=2.0), operator("bg", "b", "g", cost=3.0)]
    made = task(chain, "g", "a")
    assert [lmcut(made, state) for state in ("a", "b", "g", "")] == [5.0, 3.0, 0.0, math.inf]


def test_of_two_ways_the_cheaper_counts() -> None:
    ways = [operator("dear", "a", "g", cost=7.0), operator("cheap", "a", "g", cost=4.0)]
    assert lmcut(task(ways, "g", "a"), "a") == 4.0


def test_goals_that_share_nothing_add_up_where_hmax_takes_the_dearest() -> None:
    ways = [operator("one", "a", "g", cost=2.0), operator("two", "a", "h", cost=3.0)]
    made = task(ways, "g h", "a")
    s = Successors(made, {})
    assert lmcut(made, "a") == 5.0
    assert registry.hmax(s)(s.initial).value == 3.0


def test_an_operator_in_two_cuts_is_paid_once() -> None:
    ways = [
        operator("both", "a", "b c", cost=3.0), operator("g", "b", "g", cost=0.0),
        operator("h", "c", "h", cost=0.0),
    ]  # fmt: skip
    assert lmcut(task(ways, "g h", "a"), "a") == 3.0


def relaxed_optimum(instantiated: InstantiatedTask) -> float:
    """The cheapest plan when nothing is deleted, by Dijkstra over sets of facts."""
    order = count()
    queue = [(0.0, next(order), instantiated.initial)]
    closed: set[frozenset] = set()
    while queue:
        cost, _, state = heapq.heappop(queue)
        if state in closed:
            continue
        closed.add(state)
        if instantiated.goal.positive <= state:
            return cost
        for one in instantiated.operators:
            if one.positive <= state and not one.added <= state:
                heapq.heappush(queue, (cost + one.cost, next(order), state | one.added))
    return math.inf


def random_relaxed(rng: Random) -> InstantiatedTask:
    names = "abcdefg"
    operators = [
        operator(
            f"o{i}", " ".join(rng.sample(names, rng.randint(0, 2))),
            " ".join(rng.sample(names, rng.randint(1, 2))), cost=float(rng.randint(0, 4)),
        )
        for i in range(8)
    ]  # fmt: skip
    return task(operators, " ".join(rng.sample(names, 3)), rng.choice(names))


@pytest.mark.parametrize("block", range(4))
def test_random_tasks_are_never_overestimated_and_hmax_is_never_above(block: int) -> None:
    exact = finite = 0
    for seed in range(40 * block, 40 * block + 40):
        made = random_relaxed(Random(seed))
        best, s = relaxed_optimum(made), Successors(made, {})
        value = LandmarkCuts(Relaxation(s, steps=False)).value(s.initial)
        assert registry.hmax(s)(s.initial).value <= value + 1e-9
        assert value <= best + 1e-9
        assert (value == math.inf) is (best == math.inf)
        finite += 0.0 < best < math.inf
        exact += value == best and 0.0 < best < math.inf
    assert finite > 10 and exact > 0.6 * finite
