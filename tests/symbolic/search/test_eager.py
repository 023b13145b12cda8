"""A* and greedy best-first search on graphs written by hand, against Dijkstra and by their order."""

from __future__ import annotations

import heapq
import math
from collections.abc import Mapping
from random import Random

import pytest

from tamp.symbolic.search.eager import astar, best_first
from tamp.symbolic.search.expansion import Reason, SearchLimitReached, SearchSpace
from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.operators import Goal, InstantiatedTask, Operator
from tamp.symbolic.search.successors import State, Successors

Edges = Mapping[tuple[str, str], float]


def graph(edges: Edges, start: str = "s", goal: str = "g") -> Successors:
    """One fact is true at a time: where one is; an operator a way."""
    operators = tuple(
        Operator(
            f"{a}-{b}",
            (),
            frozenset({(a,)}),
            frozenset(),
            frozenset({(b,)}),
            frozenset({(a,)}),
            cost,
        )
        for (a, b), cost in edges.items()
    )
    places = frozenset((place,) for edge in edges for place in edge)
    task = InstantiatedTask(
        frozenset({(start,)}), Goal(frozenset({(goal,)})), operators, (), places, {}
    )
    return Successors(task, {})


class Table:
    """A heuristic by place; it notes of what it was asked."""

    def __init__(self, successors: Successors, values: Mapping[str, float]) -> None:
        self._places = {1 << i: fact[0] for i, fact in enumerate(successors.facts)}
        self._values = values
        self.asked: list[str] = []

    def __call__(self, closed: State, parent: State | None) -> Estimate:
        place = self._places.get(closed, "")  # nothing leads on from there
        self.asked.append(place)
        return Estimate(self._values.get(place, 0.0))


def space(
    edges: Edges, *values: Mapping[str, float], limit: int | None = None, below: float = math.inf
) -> SearchSpace:
    successors = graph(edges)
    tables = [Table(successors, one) for one in values or ({},)]
    return SearchSpace(successors, tables, limit, None, below)


def names(plan: object) -> list[str]:
    assert plan is not None
    return [operator.name for operator in plan.operators]  # type: ignore[attr-defined]


def dijkstra(edges: Edges) -> float:
    best, queue = {"s": 0.0}, [(0.0, "s")]
    while queue:
        cost, place = heapq.heappop(queue)
        if place == "g":
            return cost
        for (a, b), step in edges.items():
            if a == place and cost + step < best.get(b, math.inf):
                best[b] = cost + step
                heapq.heappush(queue, (cost + step, b))
    return math.inf


TRAP: Edges = {("s", "a"): 1, ("a", "g"): 9, ("s", "b"): 4, ("b", "g"): 4}


def test_astar_takes_the_cheapest_way_and_best_first_the_nearest_looking() -> None:
    assert names(astar(space(TRAP))) == ["s-b", "b-g"]
    near = {"s": 2, "a": 1, "b": 2}
    assert names(best_first(space(TRAP, near))) == ["s-a", "a-g"]


def test_astar_reopens_a_state_that_it_reached_too_dearly() -> None:
    """The estimate is admissible and inconsistent: c is closed at 4 before it is reached at 2."""
    edges: Edges = {("s", "c"): 4, ("s", "b"): 1, ("b", "c"): 1, ("c", "g"): 10}
    run = space(edges, {"b": 11, "c": 0})
    assert names(astar(run)) == ["s-b", "b-c", "c-g"]
    assert run.expanded == 4  # s, c, b, c
    run = space(edges)
    assert names(astar(run)) == ["s-b", "b-c", "c-g"]
    assert run.expanded == 3  # s, b, c: the way to c at 4 still waits, and is left


def test_astar_costs_what_dijkstra_finds_on_random_graphs() -> None:
    rng, solved = Random(0), 0
    for _ in range(60):
        places = ["s", "g", *"abcdef"]
        edges = {
            (a, b): float(rng.randint(1, 9))
            for a in places
            for b in places
            if a != b and rng.random() < 0.3
        }
        if not any(a == "s" for a, _ in edges) or not any(b == "g" for _, b in edges):
            continue
        found, expected = astar(space(edges)), dijkstra(edges)
        solved += found is not None
        assert (math.inf if found is None else found.cost) == expected
    assert solved > 30


def test_the_bound_rises_to_the_cost_of_the_plan_and_beyond_when_there_is_none() -> None:
    run = space(TRAP)
    assert astar(run) is not None
    assert run.bound == 8
    run = space(TRAP, below=8.0)
    assert astar(run) is None
    assert run.bound == 8.0


def test_several_estimates_count_by_their_maximum_or_by_their_sum() -> None:
    low, high = {"a": 1, "b": 2}, {"a": 9, "b": 4}
    run = space(TRAP, low, high)
    assert names(astar(run)) == ["s-b", "b-g"]
    assert run.expanded == 2  # a, at 1 + 9, waits for more than the plan costs
    turned = space(TRAP, {"a": 3, "b": 4}, {"a": 3, "b": 1})
    assert names(best_first(turned)) == ["s-b", "b-g"]  # 6 at a, 5 at b


def test_a_dead_end_is_not_gone_into() -> None:
    edges = {**TRAP, ("s", "d"): 1, ("d", "g"): 1}
    assert names(best_first(space(edges, {"d": math.inf, "a": 2, "b": 1}))) == ["s-b", "b-g"]
    assert names(astar(space(edges, {"d": math.inf}))) == ["s-b", "b-g"]
    only = {("s", "d"): 1.0, ("d", "g"): 1.0}
    assert best_first(space(only, {"d": math.inf})) is None


@pytest.mark.parametrize("search", [astar, best_first])
def test_nothing_leads_there_and_the_limit_holds(search: object) -> None:
    assert search(space({("s", "a"): 1, ("b", "g"): 1})) is None  # type: ignore[operator]
    with pytest.raises(SearchLimitReached) as stop:
        search(space(TRAP, limit=1))  # type: ignore[operator]
    assert stop.value.reason is Reason.LIMIT


def test_among_equals_the_younger_state_is_next() -> None:
    edges: Edges = {("s", "a"): 1, ("s", "b"): 1, ("a", "g"): 1, ("b", "g"): 1}
    run = space(edges)
    best_first(run)
    (table,) = run.heuristics
    assert table.asked == ["s", "a", "b", "g"]  # type: ignore[attr-defined]
    assert names(run.plan(run.successors.goal)) == ["s-b", "b-g"]
