"""The compiled loop of lazy search finds what the plain one finds, states counted, ties included."""

from __future__ import annotations

from random import Random

import pytest

import tamp.symbolic.search.search as search_module
from benchmarks.classical_domains import GENERATORS
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.packed import restarts, selection
from tamp.symbolic.search.packed import search as packed_search
from tamp.symbolic.search.search import Reason, SearchResult, search
from tests.symbolic.search.interpreter import Interpreter
from tests.symbolic.search.test_prices import instances, random_prices
from tests.symbolic.search.test_random_tasks import random_task

WAYS = (
    ("greedy", "ff"),
    ("greedy", "ff+landmarks"),
    ("greedy", "landmarks"),
    ("wastar", "ff"),
    ("wastar", "landmarks+ff"),
)


STALL = 10**9
"""No restarts: those are the compiled loop's alone."""


def told(result: SearchResult) -> tuple[object, ...]:
    plan = (
        None if result.plan is None else (tuple(map(str, result.plan.operators)), result.plan.cost)
    )
    return plan, result.reason, result.expanded, result.evaluated, result.estimate


def compare(
    monkeypatch: pytest.MonkeyPatch, instantiated: InstantiatedTask, price: dict, **options: object
) -> SearchResult:
    """Search in both loops, and once from the one into the other."""
    monkeypatch.setattr(restarts, "STALLED_STATES", STALL)
    monkeypatch.setattr(search_module, "STALLED_STATES", STALL)
    results: list[SearchResult] = []
    for pays in (lambda entries: False, lambda entries: True, lambda entries: entries > 0):
        monkeypatch.setattr(selection, "pays", pays)
        results.append(search(instantiated, price=price, **options))  # pyright: ignore[reportArgumentType]
    assert told(results[0]) == told(results[1]) == told(results[2])
    return results[0]


@pytest.mark.parametrize("block", range(10))
def test_random_tasks_with_random_prices(block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Negation, derived predicates, conditional effects, prices of operators, guards and goals."""
    plans = 0
    for seed in range(40 * block, 40 * block + 40):
        rng = Random(seed)
        instantiated = instantiate(random_task(rng))
        static = frozenset().union(
            *(o.static for o in instantiated.operators), *(a.static for a in instantiated.axioms)
        )
        price = random_prices(rng, static) if seed % 2 else {}
        name, heuristic = WAYS[seed % len(WAYS)]
        limit = rng.choice((None, None, 3, 20))
        weight = rng.choice((1.0, 2.5, 5.0))
        endurance = rng.choice((None, 1, 4)) if name == "wastar" else None
        found = compare(
            monkeypatch,
            instantiated,
            price,
            search=name,
            heuristic=heuristic,
            limit=limit,
            weight=weight,
            endurance=endurance,
        )
        plans += found.plan is not None
    assert plans >= 10


@pytest.mark.parametrize("seed", [83, 87, 98, 136, 204, 222, 247, 259, 318, 378])
def test_a_search_without_progress_may_come_to_the_goal_before_it_expands_another_state(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is given up where it would expand one more: what is in its lists may be a goal."""
    rng = Random(seed)
    instantiated = instantiate(random_task(rng))
    endurance, heuristic = rng.choice((1, 2, 3, 4, 6)), WAYS[seed % len(WAYS)][1]
    found = compare(
        monkeypatch, instantiated, {}, search="wastar", heuristic=heuristic, weight=1.0,
        endurance=endurance,
    )  # fmt: skip
    assert found.expanded


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("name", ["greedy", "wastar"])
def test_guards_of_all_kinds(seed: int, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Guards with prices and without, listed and lazy; a limit of the cost."""
    _, prices, listed, assumed = instances(seed)
    for instantiated in (listed, assumed):
        found = compare(monkeypatch, instantiated, prices, search=name)
        if name == "wastar" and found.plan is not None:
            compare(
                monkeypatch,
                instantiated,
                prices,
                search=name,
                below=float(len(found.plan.operators)),
            )


SIZES = {
    "blocks": 9,
    "logistics": 6,
    "gripper": 8,
    "rovers": 4,
    "satellite": 5,
    "depot": 4,
    "miconic": 6,
    "network": 6,
}


@pytest.mark.parametrize("name", SIZES)
def test_classical_tasks(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whole and broken costs; arrays that have to grow on the way."""
    monkeypatch.setattr(packed_search, "FIRST_NODES", 3)
    monkeypatch.setattr(packed_search, "FIRST_ENTRIES", 5)
    domain, problem = GENERATORS[name](SIZES[name], Random(3))
    instantiated = instantiate(parse_task(problem, parse_domain(domain)))
    for way in (("greedy", "ff+landmarks"), ("wastar", "ff")):
        found = compare(monkeypatch, instantiated, {}, search=way[0], heuristic=way[1], limit=3000)
        assert found.expanded > 5


def test_broken_costs_and_dear_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    """What no bucket is for: a cost that is no whole number, and one above all buckets."""
    domain, problem = GENERATORS["rovers"](3, Random(1))
    for length in ("0.5", "9000"):
        changed = problem.replace("(= (length w0 w1) ", f"(= (length w0 w1) {length} ; ", 1)
        assert changed != problem
        lines = [
            line if length not in line else line.replace(" ; ", ")\n;", 1)
            for line in changed.split("\n")
        ]
        instantiated = instantiate(parse_task("\n".join(lines), parse_domain(domain)))
        compare(monkeypatch, instantiated, {}, search="greedy", heuristic="ff+landmarks")


def test_audits_and_limits_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    domain, problem = GENERATORS["depot"](8, Random(1))
    instantiated = instantiate(parse_task(problem, parse_domain(domain)))
    found = compare(
        monkeypatch, instantiated, {}, search="wastar", heuristic="landmarks", limit=700
    )
    assert found.expanded == 700 and found.plan is None
    asked: list[int] = []

    def audit() -> bool:
        asked.append(1)
        return True

    found = compare(
        monkeypatch, instantiated, {}, search="wastar", heuristic="landmarks", audit=audit
    )
    assert found.expanded == 500 and found.plan is None and asked


@pytest.mark.parametrize("heuristic", ["ff+landmarks", "ff"])
def test_a_search_that_stalls_begins_anew_and_finds_a_plan(
    heuristic: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same seed gives the same plan, whichever loop it begins in; it holds by the book."""
    for module in (restarts, search_module):
        monkeypatch.setattr(module, "STALLED_STATES", 50)
    monkeypatch.setattr(restarts, "SHORTEST_RESTART_STATES", 200)
    domain, problem = GENERATORS["depot"](8, Random(1))
    task = parse_task(problem, parse_domain(domain))
    instantiated = instantiate(task)
    found: dict[tuple[int, bool], SearchResult] = {}
    for seed, packed in ((0, False), (0, True), (1, True), (2, True)):
        monkeypatch.setattr(selection, "pays", lambda entries, packed=packed: packed)
        found[seed, packed] = result = search(
            instantiated, search="greedy", heuristic=heuristic, seed=seed
        )
        assert result.plan is not None
        steps = [(operator.name, operator.arguments) for operator in result.plan.operators]
        assert Interpreter(task).run(steps) == result.plan.cost
    assert found[0, False].plan == found[0, True].plan
    assert found[0, True].expanded > 50


EITHER = """(define (domain either) (:predicates (p) (q) (switch ?s) (up ?s))
 (:action there :parameters () :precondition (p) :effect (and (q) (not (p))))
 (:action back :parameters () :precondition (q) :effect (and (p) (not (q))))
 (:action flip :parameters (?s) :precondition (and (switch ?s) (not (up ?s))) :effect (up ?s))
 (:action drop :parameters (?s) :precondition (up ?s) :effect (not (up ?s))))"""
EITHER_TASK = """(define (problem either) (:domain either) (:objects a b c d)
 (:init (p) (switch a) (switch b) (switch c) (switch d))
 (:goal (and (p) (q) (up a) (up b) (up c) (up d))))"""


def test_restarts_prove_that_there_is_no_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two facts of which one holds at a time, which the relaxation does not see."""
    for module in (restarts, search_module):
        monkeypatch.setattr(module, "STALLED_STATES", 2)
    monkeypatch.setattr(restarts, "SHORTEST_RESTART_STATES", 3)
    monkeypatch.setattr(selection, "pays", lambda entries: True)
    instantiated = instantiate(parse_task(EITHER_TASK, parse_domain(EITHER)))
    packed = search(instantiated, search="greedy", heuristic="ff+landmarks")
    plain = search(instantiated, search="greedy", heuristic="ff+landmarks", limit=10**6)
    assert packed.plan is None and plain.plan is None
    assert packed.reason is plain.reason is Reason.UNSOLVABLE
    assert packed.expanded > plain.expanded == 32
