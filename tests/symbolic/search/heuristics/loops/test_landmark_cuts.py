"""The inner loop of landmark cuts, step by step: exploration up to the goal, goal zone, cut."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

import pytest

from tamp.symbolic.search.heuristics.lmcut import LandmarkCuts
from tamp.symbolic.search.heuristics.loops.landmark_cuts import (
    CheaperThanGoal,
    _explore,
    _fill_zone,
    _find_cut,
)
from tamp.symbolic.search.heuristics.loops.rows import csr_rows, transposed
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.heuristics.loops.queues import empty
from tests.symbolic.search.heuristics.test_lmcut import random_relaxed, relaxed_optimum


@pytest.mark.parametrize("seed", range(30))
def test_buckets_and_heap_explore_alike(seed: int) -> None:
    rng = Random(seed)
    ways = [
        (rng.sample(range(12), rng.randint(1, 2)), rng.sample(range(12), 2), float(rng.randint(0, 5)))
        for _ in range(30)
    ]  # fmt: skip
    ways.append((rng.sample(range(12), 2), [12], 0.0))
    made = [Task(ways, facts=13, few=few) for few in (True, False)]
    first, other = made
    assert (first.least, first.many) == (other.least, other.many)
    assert first.found.waiting == other.found.waiting
    assert sorted(first.found.fired[: first.many]) == sorted(other.found.fired[: other.many])
    assert [min(cost, first.least) for cost in first.found.reached] == [
        min(cost, first.least) for cost in other.found.reached
    ]


# Facts 0 to 5 and the goal fact 6; operators: (before, effects, cost), the last one stands for the goal.
CHAIN = [([0], [1], 1.0), ([1], [2], 1.0), ([2], [3], 5.0), ([1, 2], [6], 0.0)]
"""Fact 1 costs 1, fact 2 costs 2, which is the goal; fact 3 is beyond it."""

FREE = [([0], [1], 1.0), ([1], [2], 0.0), ([2], [3], 0.0), ([2], [6], 0.0)]
"""Fact 2, the goal, is reached for what fact 1 costs, and so is fact 3 behind it."""


class Task:
    """Operators as rows, explored from fact 0."""

    def __init__(
        self, operators: list[tuple[list[int], list[int], float]], facts: int = 7, few: bool = True
    ) -> None:
        self.before = csr_rows([before for before, _, _ in operators])
        self.effects = csr_rows([effects for _, effects, _ in operators])
        self.costs = [cost for _, _, cost in operators]
        self.needs, self.adders = transposed(self.before, facts), transposed(self.effects, facts)
        self.goals, self.facts, self.goal = operators[-1][0], facts, facts - 1
        count = len(operators)
        self.found = CheaperThanGoal([0.0] * facts, [0] * count, [0] * count, [0] * facts)
        room = facts + len(self.effects.values)
        self.least, self.many = _explore(
            self.before, self.effects, self.needs, self.costs, [0], self.goals, few, empty(room), self.found
        )  # fmt: skip

    def zone(self) -> list[int]:
        """The facts of the goal zone."""
        inside, listed = [False] * self.facts, [0] * self.facts
        size = _fill_zone(
            self.before, self.adders, self.costs, self.goal, self.found.reached, inside, listed
        )  # fmt: skip
        assert sorted(listed[:size]) == [fact for fact in range(self.facts) if inside[fact]]
        return sorted(listed[:size])

    def cut(self, zone: list[int]) -> list[int]:
        """The operators that enter a zone."""
        inside, cut = [fact in zone for fact in range(self.facts)], [0] * len(self.costs)
        size = _find_cut(
            self.effects, self.needs, self.least, self.many, self.found, inside,
            [False] * self.facts, [0] * self.facts, cut,
        )  # fmt: skip
        return sorted(cut[:size])


def test_exploration_ends_before_what_costs_as_much_as_the_goal() -> None:
    task = Task(CHAIN)
    assert task.least == 2.0
    assert task.found.fired[: task.many] == [0, 1]
    assert task.found.waiting == [0, 0, 1, 1]  # fact 2 is not settled: neither is what needs it
    assert task.found.reached[3] == math.inf


def test_facts_that_turn_out_to_cost_as_much_as_the_goal_are_taken_back() -> None:
    task = Task(FREE)
    assert task.least == 1.0
    assert task.found.fired[: task.many] == [0]
    assert task.found.waiting == [0, 1, 1, 1]


def test_a_goal_out_of_reach_costs_infinitely_much() -> None:
    assert Task([([0], [1], 1.0), ([5], [6], 0.0)]).least == math.inf


def test_the_zone_follows_operators_that_cost_nothing_back_to_the_dearest_precondition() -> None:
    assert Task(FREE).zone() == [1, 2, 6]
    assert Task(CHAIN).zone() == [2, 6]  # fact 1 costs less than the goal


@pytest.mark.parametrize("crowded", [1, 2])
def test_of_two_preconditions_as_dear_that_with_the_fewest_operators_that_add_it_is_in_the_zone(
    crowded: int,
) -> None:
    ways = [([0], [1], 1.0), ([0], [2], 1.0), ([0], [crowded], 1.0), ([1, 2], [6], 0.0)]
    assert Task(ways).zone() == [3 - crowded, 6]


def test_an_operator_that_needs_a_fact_of_the_zone_enters_it_no_more() -> None:
    # operators 0 and 3 add fact 1; 3 can be reached only through the zone
    ways = [([0], [1], 1.0), ([1], [2], 1.0), ([2], [3], 1.0), ([3], [1], 1.0), ([1], [6], 0.0)]
    task = Task(ways)
    assert task.zone() == [1, 6]
    assert task.cut([1, 6]) == [0]


def test_a_dear_way_into_the_zone_is_cut_as_well() -> None:
    # fact 2 costs 9, more than the goal, and leads to fact 1 without the zone
    ways = [([0], [1], 1.0), ([0], [2], 9.0), ([2], [1], 1.0), ([1], [6], 0.0)]
    assert Task(ways).cut([1, 6]) == [0, 2]


def test_costs_that_no_binary_fraction_holds_are_never_overestimated() -> None:
    finite = 0
    for seed in range(80):
        rng = Random(1000 + seed)
        made = random_relaxed(rng)
        tenths = [replace(one, cost=rng.choice((0.1, 0.2, 0.3, 0.7))) for one in made.operators]
        made = replace(made, operators=type(made.operators)(tenths))
        best, s = relaxed_optimum(made), Successors(made, {})
        value = LandmarkCuts(Relaxation(s, steps=False)).value(s.initial)
        assert value <= best + 1e-9
        assert (value == math.inf) is (best == math.inf)
        finite += 0.0 < best < math.inf
    assert finite > 20
