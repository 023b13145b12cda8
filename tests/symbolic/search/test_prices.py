"""Prices of guards and static facts, against a plain Dijkstra over the operators; listed tests against assumed ones."""

from __future__ import annotations

import heapq
import itertools
import math
from random import Random

import pytest

from benchmarks.search import Instance, cupboard
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.axioms import derive
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import Facts, InstantiatedTask, Operator
from tamp.symbolic.search.search import search

TESTS = ("pose-clear", "reach-clear")


def random_prices(rng: Random, facts: frozenset[Fact]) -> dict[Fact, float]:
    prices = {
        f: rng.choice((0.3, 2.5, 100.0, math.inf))
        for f in sorted(facts)
        if f[0] in TESTS and rng.random() < 0.4
    }
    return prices | {
        f: rng.choice((0.5, 3.0)) for f in sorted(facts) if f[0] not in TESTS and rng.random() < 0.2
    }


def step_cost(operator: Operator, state: Facts, prices: dict[Fact, float]) -> float:
    cost = operator.cost + sum(prices.get(fact, 0.0) for fact in operator.static)
    for guard in operator.guards:
        if guard.facts <= state:
            cost += math.inf if guard.waived_by is None else prices.get(guard.waived_by, 0.0)
    return cost


def dijkstra(instantiated: InstantiatedTask, prices: dict[Fact, float]) -> float:
    order = itertools.count()
    queue = [(0.0, next(order), instantiated.initial)]
    done: set[Facts] = set()
    while queue:
        cost, _, state = heapq.heappop(queue)
        if state in done:
            continue
        done.add(state)
        if instantiated.goal.positive <= state | derive(instantiated.axioms, state).keys():
            return cost
        for operator in instantiated.operators:
            if operator.positive <= state and operator.negative.isdisjoint(state):
                reached = cost + step_cost(operator, state, prices)
                if reached < math.inf:
                    heapq.heappush(
                        queue, (reached, next(order), (state - operator.deleted) | operator.added)
                    )
    return math.inf


def instances(seed: int) -> tuple[Instance, dict[Fact, float], InstantiatedTask, InstantiatedTask]:
    """A task with some tests refused, priced at random; its grounding with tests listed and with tests assumed."""
    rng = Random(seed)
    task, facts, objects = cupboard(2, 2)
    refused = frozenset(f for f in sorted(facts) if f[0] in TESTS and rng.random() < 0.15)
    prices = random_prices(rng, facts)
    listed = instantiate(task, facts - refused, objects)
    bare = [fact for fact in facts if fact[0] not in TESTS]
    assumed = instantiate(task, bare, objects, assumed=dict.fromkeys(TESTS, ()), refused=refused)
    return (task, facts - refused, objects), prices, listed, assumed


@pytest.mark.parametrize("seed", range(6))
def test_astar_is_optimal_with_prices(seed: int) -> None:
    _, prices, listed, assumed = instances(seed)
    best = dijkstra(listed, prices)
    assert best == pytest.approx(dijkstra(assumed, prices))
    for instantiated, heuristic in itertools.product((listed, assumed), ("hmax", "blind")):
        for price in (prices, lambda fact: prices.get(fact, 0.0)):
            result = search(instantiated, search="astar", heuristic=heuristic, price=price)
            assert (result.plan.cost if result.plan else math.inf) == pytest.approx(best)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", ["wastar", "greedy"])
def test_informed_searches_pay_what_they_say(seed: int, name: str) -> None:
    _, prices, listed, assumed = instances(seed)
    best = dijkstra(listed, prices)
    found: list[list[str]] = []
    for instantiated, price in itertools.product(
        (listed, assumed), (prices, lambda fact: prices.get(fact, 0.0))
    ):
        result = search(instantiated, search=name, price=price)
        if best == math.inf:
            assert result.plan is None
            continue
        assert result.plan is not None
        found.append(list(map(str, result.plan.operators)))
        state, cost = instantiated.initial, 0.0
        for operator in result.plan.operators:
            assert operator.positive <= state
            assert operator.negative.isdisjoint(state)
            cost += step_cost(operator, state, prices)
            state = (state - operator.deleted) | operator.added
        assert result.plan.cost == pytest.approx(cost)
        assert best - 1e-9 <= cost <= 3 * best
    assert all(plan == found[0] for plan in found)


@pytest.mark.parametrize("method", ["greedy", "wastar"])
@pytest.mark.parametrize("cheap", ["p1", "p2"])
def test_what_the_goal_is_derived_from_has_a_price(method: str, cheap: str) -> None:
    """Two places make the goal true at the same cost; what says so of one of them is dear."""
    domain = parse_domain("""(define (domain d) (:predicates (place ?p) (at ?p) (within ?p) (done))
      (:action put :parameters (?p) :precondition (place ?p) :effect (at ?p))
      (:derived (done) (exists (?p) (and (at ?p) (within ?p)))))""")
    problem = "(define (problem p) (:domain d) (:objects p1 p2) (:init (place p1) (place p2)) (:goal (done)))"
    instantiated = instantiate(parse_task(problem, domain), [("within", "p1"), ("within", "p2")])
    dear = "p2" if cheap == "p1" else "p1"
    for blind in (None, "blind"):
        result = search(
            instantiated, search=method, price={("within", dear): 5.0}, heuristic=blind or "ff"
        )
        assert result.plan is not None
        assert [operator.arguments for operator in result.plan.operators] == [(cheap,)]
    only = search(
        instantiated,
        search=method,
        price={("within", "p1"): 5.0, ("within", "p2"): 7.0},
        heuristic="blind",
    )
    assert only.plan is not None
    assert only.plan.cost == 1.0
