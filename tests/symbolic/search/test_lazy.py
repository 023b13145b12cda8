"""Lazy search in plain Python: deferred evaluation, preferred operators, goals that cost something."""

from __future__ import annotations

import math
from random import Random

import pytest

from tamp.symbolic.search.eager import astar
from tamp.symbolic.search.expansion import SearchSpace
from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.lazy import lazy
from tamp.symbolic.search.operators import Axiom, Goal, InstantiatedTask, Operator
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.test_eager import TRAP, Edges, Table, graph, names, space


def test_a_state_is_evaluated_when_it_is_expanded_and_not_when_it_is_found() -> None:
    """Both neighbours of s are found at once; the one that is taken is the only one asked about."""
    edges: Edges = {("s", "a"): 1, ("s", "b"): 1, ("a", "g"): 1}
    run = space(edges, {"s": 2, "a": 1, "b": 1})
    assert names(lazy(run, math.inf)) == ["s-a", "a-g"]
    (table,) = run.heuristics
    assert isinstance(table, Table)
    assert table.asked == ["s", "a"]


def test_costs_count_with_a_weight_and_not_in_greedy_search() -> None:
    assert names(lazy(space(TRAP, {"s": 2, "a": 1, "b": 1}), 1.0)) == ["s-b", "b-g"]
    assert names(lazy(space(TRAP, {"s": 2, "a": 1, "b": 1}), math.inf)) == ["s-a", "a-g"]


def test_a_weight_of_one_and_no_estimate_finds_the_cheapest() -> None:
    rng, solved = Random(1), 0
    for _ in range(40):
        places = ["s", "g", *"abcde"]
        edges = {
            (a, b): float(rng.randint(1, 9))
            for a in places
            for b in places
            if a != b and rng.random() < 0.35
        }
        edges |= {("s", "a"): 9.0, ("b", "g"): 9.0}
        found, cheapest = lazy(space(edges), 1.0), astar(space(edges))
        solved += found is not None
        assert (found and found.cost) == (cheapest and cheapest.cost)
    assert solved > 20


def test_greedy_search_reopens_nothing_and_weighted_search_does() -> None:
    edges: Edges = {("s", "c"): 9, ("s", "b"): 1, ("b", "c"): 1, ("c", "d"): 1, ("d", "g"): 20}
    values = {"s": 3, "b": 20, "c": 2, "d": 8}
    assert names(lazy(space(edges, values), math.inf)) == ["s-c", "c-d", "d-g"]
    assert names(lazy(space(edges, values), 1.0)) == ["s-b", "b-c", "c-d", "d-g"]


def test_what_costs_as_much_as_the_limit_is_left() -> None:
    assert lazy(space(TRAP, below=8.0), 1.0) is None
    found = lazy(space(TRAP, below=8.5), 1.0)
    assert found is not None and found.cost == 8.0


def test_a_dead_end_is_not_expanded() -> None:
    edges: Edges = {("s", "d"): 1, ("d", "g"): 1}
    run = space(edges, {"d": math.inf})
    assert lazy(run, math.inf) is None
    assert run.expanded == 1 and run.evaluated == 2


class Advice(Table):
    """A table that holds some operators to be a relaxed plan everywhere."""

    def __init__(self, successors: Successors, plan: tuple[int, ...]) -> None:
        super().__init__(successors, {})
        self._plan = plan

    def __call__(self, closed: int, parent: int | None) -> Estimate:
        return Estimate(super().__call__(closed, parent).value, self._plan)


@pytest.mark.parametrize("way", [0, 2])
def test_preferred_operators_go_first(way: int) -> None:
    """Two ways of two steps, alike in all but the advice."""
    edges: Edges = {("s", "a"): 1, ("a", "g"): 1, ("s", "b"): 1, ("b", "g"): 1}
    successors = graph(edges)
    run = SearchSpace(successors, [Advice(successors, (way, way + 1))], None, None)
    assert names(lazy(run, math.inf)) == [["s-a", "a-g"], ["s-b", "b-g"]][way // 2]
    assert run.expanded == 2


def priced_goal(price: float) -> SearchSpace:
    """The goal follows from a at a price, or from c, two steps away, for nothing."""
    ways = (("s", "a"), ("s", "b"), ("b", "c"))
    operators = tuple(
        Operator(
            f"{x}-{y}", (), frozenset({(x,)}), frozenset(), frozenset({(y,)}), frozenset({(x,)})
        )
        for x, y in ways
    )
    axioms = (
        Axiom(("g",), frozenset({("a",)}), frozenset(), frozenset({("dear",)})),
        Axiom(("g",), frozenset({("c",)}), frozenset()),
    )
    reachable = frozenset((name,) for name in "sabcg")
    task = InstantiatedTask(
        frozenset({("s",)}), Goal(frozenset({("g",)})), operators, axioms, reachable, {}
    )
    return SearchSpace(Successors(task, {("dear",): price}), [lambda *_: Estimate(1.0)], None, None)


def test_a_goal_that_costs_something_waits_for_a_cheaper_one() -> None:
    assert names(lazy(priced_goal(0.5), 1.0)) == ["s-a"]
    assert names(lazy(priced_goal(10.0), 1.0)) == ["s-b", "b-c"]
    assert names(lazy(priced_goal(0.0), math.inf)) == ["s-a"]
