"""The cupboard's optimistic task: scale, symmetry, prices on guards."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from benchmarks.search import cupboard, effort
from tamp.symbolic.pddl.structs import And, Atom, Fact
from tamp.symbolic.search.heuristics.registry import HEURISTICS
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.packed import selection
from tamp.symbolic.search.plan_trace import trace
from tamp.symbolic.search.search import SEARCHES, Reason, search
from tests.symbolic.search.interpreter import Interpreter

INFORMED = ("wastar", "greedy")


@pytest.fixture(scope="module")
def eight() -> InstantiatedTask:
    return instantiate(*cupboard(8))


@pytest.mark.parametrize("name", INFORMED)
@pytest.mark.parametrize("priced", [True, False])
def test_eight_interchangeable_bodies_need_no_search(
    eight: InstantiatedTask, name: str, priced: bool
) -> None:
    result = search(eight, search=name, price=effort if priced else lambda fact: 0.0)
    assert result.plan is not None
    assert len(result.plan.operators) == 32
    assert result.expanded <= 40


def test_the_trace_names_every_static_fact_used(eight: InstantiatedTask) -> None:
    result = search(eight)
    assert result.plan is not None
    steps = trace(eight, result.plan.operators)
    assert {fact[:2] for fact in steps.end.static} == {("supported", f"o{i}") for i in range(8)}
    places = [step for step in steps.steps if step.operator.name == "place"]
    assert len(places) == 8
    for step in places:
        standing = {fact for fact in step.state if fact[0] == "at-pose"}
        clear = {fact[3:] for fact in step.static if fact[0] == "pose-clear"}
        assert {fact[1:] for fact in standing} == clear
        assert {fact[0] for fact in step.static} >= {"place-motion", "reach-clear", "pose-clear"}


@pytest.mark.parametrize("name", SEARCHES)
@pytest.mark.parametrize("heuristic", HEURISTICS)
def test_every_search_and_heuristic_by_the_book(name: str, heuristic: str) -> None:
    task, facts, objects = cupboard(1, 2)
    result = search(instantiate(task, facts, objects), search=name, heuristic=heuristic)
    assert result.plan is not None
    assert (
        Interpreter(task, facts, objects, on_demand=True).run(
            (o.name, o.arguments) for o in result.plan.operators
        )
        == 4
    )
    assert result.plan.cost == 4


def blocked(price: float, name: str, heuristic: str = "ff") -> tuple[list[str], float, int]:
    """Body o0 shall leave the table, but o1 at its start pose is in the way of every reach for it."""
    task, facts, objects = cupboard(2, 3)
    goal = And((Atom("on", ("o0", "shelf")),))
    instantiated = instantiate(
        type(task)(task.name, task.domain, task.objects, task.initial, goal, {}), facts, objects
    )

    def prices(fact: Fact) -> float:
        return (
            price
            if fact[0] == "reach-clear" and fact[1:3] == ("o0", "o0_start") and fact[6] == "o1"
            else 0.0
        )

    result = search(
        instantiated,
        search=name,
        heuristic=heuristic,
        price=lambda f: prices(f) if f[-1] == "o1_start" else 0.0,
    )
    assert result.plan is not None
    return (
        [f"{o.name} {o.arguments[0]}" for o in result.plan.operators],
        result.plan.cost,
        result.expanded,
    )


@pytest.mark.parametrize("name", INFORMED)
@pytest.mark.parametrize("price", [100.0, float("inf")])
def test_a_dear_guard_makes_the_search_move_the_blocker_first(name: str, price: float) -> None:
    steps, cost, expanded = blocked(price, name)
    assert steps.index("pick o1") < steps.index("place o1") < steps.index("pick o0")
    assert cost <= 8
    assert expanded <= 30


def test_a_cheap_guard_is_paid() -> None:
    steps, cost, _ = blocked(0.5, "wastar")
    assert "pick o1" not in steps
    assert cost == 4.5


@pytest.mark.parametrize("heuristic", ["hmax", "blind"])
def test_astar_weighs_guards_against_detours(heuristic: str) -> None:
    assert blocked(2.5, "astar", heuristic)[1] == 6.5
    assert blocked(100.0, "astar", heuristic)[1] == 8


@pytest.mark.parametrize("name", INFORMED)
def test_bodies_that_swap_places_need_a_third_place(name: str) -> None:
    """Each goal pose is free only once the other body has left its start."""
    task, facts, objects = cupboard(2, 2)
    goal = And((Atom("at-pose", ("o0", "#p0_1")), Atom("at-pose", ("o1", "#p1_1"))))
    facts = {
        f
        for f in facts
        if f
        not in {
            ("pose-clear", "o0", "#p0_1", "o1", "o1_start"),
            ("pose-clear", "o1", "#p1_1", "o0", "o0_start"),
        }
    }
    task = type(task)(task.name, task.domain, task.objects, task.initial, goal, {})
    result = search(instantiate(task, facts, objects), search=name)
    assert result.plan is not None
    steps = [f"{o.name} {o.arguments[0]}" for o in result.plan.operators]
    assert steps.count("place o0") + steps.count("place o1") == 3
    assert (
        Interpreter(task, facts, objects, on_demand=True).run(
            (o.name, o.arguments) for o in result.plan.operators
        )
        == result.plan.cost
    )
    assert result.plan.cost == 12
    assert result.expanded <= 60


def test_limits_are_reported(eight: InstantiatedTask) -> None:
    result = search(eight, limit=3)
    assert result.plan is None
    assert result.reason is Reason.LIMIT
    assert result.expanded == 3


@pytest.mark.parametrize("packed", [False, True])
def test_infinite_prices_take_operators_away(packed: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(selection, "pays", lambda entries: packed)
    instantiated = instantiate(*cupboard(1, 2))
    assert (
        search(instantiated, price=lambda f: float("inf") if f[0] == "nothing" else 0.0).plan
        is not None
    )
    for name in (
        "pick-motion",
        "supported",
    ):  # an operator rests on the one, the goal's derivation on the other
        result = search(
            instantiated, price=lambda f, name=name: float("inf") if f[0] == name else 0.0
        )
        assert result.reason is Reason.UNSOLVABLE


SCRIPT = """
import json
from benchmarks.search import cupboard, effort
from tamp.symbolic.search.search import search
from tamp.symbolic.search.instantiation.instantiator import instantiate
plans = []
for name in ("wastar", "greedy"):
    result = search(instantiate(*cupboard(3, 4)), search=name, price=effort)
    plans.append([[str(o) for o in result.plan.operators], result.plan.cost, result.expanded])
print(json.dumps(plans))
"""


def test_the_same_plan_whatever_the_hash_seed() -> None:
    outputs: list[object] = []
    for seed in ("0", "1", "77"):
        environment = {
            **os.environ,
            "PYTHONHASHSEED": seed,
            "PYTHONPATH": os.pathsep.join(sys.path),
        }
        run = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        outputs.append(json.loads(run.stdout))
    assert outputs[0] == outputs[1] == outputs[2]


@pytest.mark.parametrize("name", INFORMED)
def test_a_price_that_the_estimate_contains_is_not_counted_again(name: str) -> None:
    """The last body's places are all priced: counted twice, every move elsewhere would be tried before them."""
    task = instantiate(*cupboard(8))

    def price(fact: Fact) -> float:
        return 2.0 if fact[:2] == ("pose-clear", "o7") else 0.0

    result = search(task, search=name, price=price, limit=200)
    assert result.plan is not None
    assert len(result.plan.operators) == 32
    assert result.plan.cost == 32 + 7 * 2.0
