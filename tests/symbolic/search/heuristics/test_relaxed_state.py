"""What an exploration of a relaxed task says: its goal's cost, dead ends, guards that are paid."""

from __future__ import annotations

import math

import pytest

from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.heuristics.relaxed_state import RelaxedExploration
from tamp.symbolic.search.operators import Guard, InstantiatedTask
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import axiom, facts, operator, task


def explored(
    instantiated: InstantiatedTask, state: str, price: dict[str, float] | None = None
) -> RelaxedExploration:
    prices = {(name,): value for name, value in (price or {}).items()}
    s = Successors(instantiated, prices)
    closed = s.closure(s.mask(facts(state)))
    return Relaxation(s, steps=True).explore(closed, additive=True)


def test_each_fact_of_the_goal_has_its_cost() -> None:
    ways = [operator("near", "a", "b", cost=2.0), operator("far", "b", "c", cost=3.0)]
    found = explored(task(ways, "a b c", "a"), "a")
    assert sorted(found.goal_costs) == [0.0, 2.0, 5.0]
    assert not found.dead


@pytest.mark.parametrize(("state", "dead"), [("a", False), ("b", False), ("d", True), ("", True)])
def test_a_state_is_dead_where_no_way_leads_to_a_fact_of_the_goal(state: str, dead: bool) -> None:
    ways = [operator("near", "a", "b"), operator("far", "b", "g"), operator("side", "d", "e")]
    assert explored(task(ways, "g", "a"), state).dead is dead


def test_one_fact_out_of_reach_is_enough() -> None:
    assert explored(task([operator("near", "a", "g")], "g h", "a"), "a").dead


def guarded(removal: float) -> InstantiatedTask:
    """Reaching waits for c to be gone, or pays; removing c costs so much."""
    guard = Guard(facts("c"), ("clear",))
    return task(
        [
            operator("remove", "c", "", deleted="c", cost=removal),
            operator("reach", "a", "g", guards=(guard,)),
        ],
        "g", "a c",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("price", "removal", "paid", "cost"),
    [(2.0, 5.0, 2.0, 3.0), (5.0, 2.0, 0.0, 3.0), (2.0, 2.0, 2.0, 3.0), (math.inf, 4.0, 0.0, 5.0)],
)
def test_a_guard_is_paid_where_removing_its_facts_is_dearer(
    price: float, removal: float, paid: float, cost: float
) -> None:
    """The goal costs the reach, 1, and the lesser of the two; what is paid is the price or nothing."""
    found = explored(guarded(removal), "a c", {"clear": price})
    assert found.goal_costs == [cost]
    assert found.paid(1) == paid
    assert found.paid(0) == 0.0


def test_a_guard_is_paid_where_what_removes_its_facts_is_itself_out_of_reach() -> None:
    """Removing costs 1 < 5, but asks for a key that nobody has: the operator waits, and then pays."""
    guard = Guard(facts("c"), ("clear",))
    ways = [
        operator("remove", "c key", "", deleted="c"), operator("reach", "a", "g", guards=(guard,)),
    ]  # fmt: skip
    for price, dead in ((5.0, False), (math.inf, True)):
        found = explored(task(ways, "g", "a c"), "a c", {"clear": price})
        assert found.dead is dead
        assert found.goal_costs == [1.0 + price]
        assert dead or found.paid(1) == price


def test_several_guards_of_one_operator_add_up() -> None:
    """Two are cheap and paid at once (1 + 2); the third waits for d to go, which costs 3 < 7."""
    guards = [Guard(facts(on), (by,)) for on, by in (("c", "x"), ("e", "y"), ("d", "z"))]
    ways = [
        operator("remove", "", "", deleted="d", cost=3.0),
        operator("reach", "a", "g", guards=guards),
    ]
    prices = {"x": 1.0, "y": 2.0, "z": 7.0}
    found = explored(task(ways, "g", "a c d e"), "a c d e", prices)
    assert found.paid(1) == 3.0
    assert found.goal_costs == [1.0 + 3.0 + 3.0]
    assert explored(task(ways, "g", "a c"), "a c", prices).paid(1) == 1.0
    assert explored(task(ways, "g", "a"), "a", prices).paid(1) == 0.0


def test_counts_of_what_a_relaxed_task_has() -> None:
    """Facts and their complements; a row for each operator, conditional effect and axiom; each guard that
    is waited for is one fact more, and each of its facts one row more, which removes it."""
    ways = [operator("near", "a", "b", when=[("b", "", "d", "")]), operator("far", "f", "e")]
    plain = explored(task(ways, "e", "a", [axiom("f", "d")]), "a").relaxed_state
    assert (plain.operators, plain.facts) == (4, 2 * 5)  # a b d e f

    waiting = explored(guarded(1.0), "a c", {"clear": 5.0}).relaxed_state
    assert (waiting.operators, waiting.facts) == (3, 2 * 3 + 1)
    triggered_none = explored(guarded(1.0), "a", {"clear": 5.0}).relaxed_state
    assert (triggered_none.operators, triggered_none.facts) == (2, 2 * 3)
