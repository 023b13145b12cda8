"""The heuristics' inner loops on rows written by hand: costs and supporters of facts, relaxed plans, the heap."""

from __future__ import annotations

import math
from random import Random

import pytest

from tamp.symbolic.search.heuristics.loops import kernels
from tamp.symbolic.search.heuristics.loops import selection as tiers
from tamp.symbolic.search.heuristics.loops.compiled import COMPILED
from tamp.symbolic.search.heuristics.loops.interface import Kernels

BOTH = pytest.mark.parametrize("loops", [tiers.PLAIN, COMPILED], ids=["plain", "compiled"])

BEFORE = [[0], [1], [1, 2], [0], [0], [4]]
"""What each operator needs: facts 0 to 5."""

EFFECTS = [[1], [2], [3], [3], [4, 1], [5]]
COSTS = [2.0, 1.0, 1.0, 9.0, 7.0, 1.0]


def explored(
    loops: Kernels, additive: bool, here: list[int], prices: list[float], goals: list[int]
) -> tuple[list[float], list[int]]:
    before, effects = loops.rows(BEFORE), loops.rows(EFFECTS)
    reached, supporters = loops.explore(
        before, effects, loops.transposed(before, 6), loops.reals(COSTS), loops.integers(here),
        loops.reals(prices), loops.integers(goals), additive,
    )  # fmt: skip
    return list(map(float, reached)), list(map(int, supporters))


@BOTH
@pytest.mark.parametrize(("additive", "cost"), [(True, 2 + 3 + 1), (False, 3 + 1)])
def test_a_fact_costs_its_supporter_and_the_sum_or_the_dearest_of_what_that_needs(
    loops: Kernels, additive: bool, cost: float
) -> None:
    reached, supporters = explored(loops, additive, [0], [0.0], [3])
    assert reached[:4] == [0.0, 2.0, 3.0, cost] and supporters[:4] == [-1, 0, 1, 2]


@BOTH
def test_exploring_ends_when_the_goals_are_the_cheapest_that_is_left(loops: Kernels) -> None:
    """Fact 4 costs 7, more than the goal: what needs it is not looked at, unless it is a goal too."""
    assert explored(loops, True, [0], [0.0], [3])[0][4:] == [7.0, math.inf]
    assert explored(loops, True, [0], [0.0], [3, 5])[0][4:] == [7.0, 8.0]


@BOTH
def test_what_a_fact_of_the_beginning_costs_counts(loops: Kernels) -> None:
    reached, supporters = explored(loops, True, [1, 2], [5.0, 0.5], [3])
    assert reached[:4] == [math.inf, 5.0, 0.5, 6.5] and supporters[:4] == [-1, -1, -1, 2]


def planned(
    loops: Kernels,
    reached: list[float],
    supporters: list[int],
    goals: list[int],
    owners: list[int] | None = None,
    guards: int = 6,
) -> tuple[float, list[int]]:
    cost, plan = loops.relaxed_plan(
        loops.reals(reached), loops.integers(supporters), loops.rows(BEFORE), loops.rows(EFFECTS),
        loops.reals(COSTS), loops.integers(owners or [0, 1, 2, 3, 4, 5]), 6, loops.integers(goals),
        guards,
    )  # fmt: skip
    return float(cost), list(map(int, plan))


@BOTH
def test_a_relaxed_plan_takes_each_supporter_once(loops: Kernels) -> None:
    """Fact 1 is needed by two of them and paid for once: 2 + 1 + 1, where hadd said 6."""
    found = planned(loops, [0.0, 2.0, 3.0, 6.0, 7.0, 8.0], [-1, 0, 1, 2, 4, 5], [3])
    assert found == (4.0, [0, 1, 2])


@BOTH
def test_relaxed_operators_of_one_operator_cost_the_dearest_of_them(loops: Kernels) -> None:
    """Relaxed operators 0 and 1 are one operator's, 2 belongs to no one (an axiom) and is free.

    They are met by falling cost of what they give: the dear one comes last, and in the end first.
    """
    reached, supporters = [0.0, 2.0, 3.0, 6.0, 7.0, 8.0], [-1, 0, 1, 2, 4, 5]
    assert planned(loops, reached, supporters, [3], [0, 0, -1, 3, 4, 5]) == (2.0, [0])
    assert planned(loops, reached, supporters, [5], [0, 1, 2, 3, 0, 0]) == (7.0, [0])
    assert planned(loops, reached, supporters, [2, 4], [2, 0, -1, 3, 0, 5]) == (7.0 + 2.0, [0, 2])


@BOTH
def test_what_a_chosen_operator_gives_in_time_needs_no_other(loops: Kernels) -> None:
    """Operator 4 gives fact 1 at 7: soon enough for the goal, too late for operator 1 at 3 - 1."""
    reached, supporters = [0.0, 2.0, 3.0, 6.0, 7.0, 8.0], [-1, 0, 1, 2, 4, 5]
    assert planned(loops, reached, supporters, [5, 1]) == (8.0, [4, 5])
    assert planned(loops, reached, supporters, [4, 2]) == (7.0 + 1.0 + 2.0, [0, 1, 4])


@BOTH
def test_a_guard_that_is_paid_costs_its_price(loops: Kernels) -> None:
    """Facts from 2 on are guards here: what needs 2 pays what it cost in the beginning."""
    found = planned(
        loops, [math.inf, 5.0, 0.5, 6.5, math.inf, math.inf], [-1, -1, -1, 2, -1, -1], [3], guards=2
    )
    assert found == (1.5, [2])


def test_the_heap_gives_the_lowest_key_and_among_equals_the_lowest_rank() -> None:
    for seed in range(30):
        rng = Random(seed)
        count = rng.randint(1, 12)
        keys, ranks = [float(rng.randint(0, 4)) for _ in range(count)], rng.sample(range(50), count)
        heap, places, size = [0] * count, [-1] * count, 0
        for fact in range(count):
            size = kernels._push(fact, heap, places, size, keys, ranks)
        cheaper = rng.randrange(count)
        keys[cheaper] -= 2.0  # moved up where it stands
        assert kernels._push(cheaper, heap, places, size, keys, ranks) == size
        taken: list[int] = []
        while size:
            taken.append(kernels._pop(heap, places, size, keys, ranks))
            size -= 1
        assert taken == sorted(range(count), key=lambda fact: (keys[fact], ranks[fact]))
        assert places == [-1] * count
