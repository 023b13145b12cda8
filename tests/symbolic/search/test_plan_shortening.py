"""Action elimination: what goes, what stays, and that no plan gets dearer, its goal included."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from random import Random

import pytest

from tamp.symbolic.search.heuristics.goal_price import GoalPrice
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import Guard, InstantiatedTask
from tamp.symbolic.search.packed import selection
from tamp.symbolic.search.plan_shortening import eliminate_actions
from tamp.symbolic.search.search import search
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import axiom, facts, operator, task
from tests.symbolic.search.test_random_tasks import random_task

WAY = [
    operator("idle", "a", "z", cost=3.0), operator("there", "a", "b", deleted="a"),
    operator("back", "b", "a", deleted="b"), operator("reach", "a", "g", cost=2.0),
    operator("after", "z", "y"),
]  # fmt: skip


@pytest.mark.parametrize("plan", [[3], [0, 3], [0, 4, 3], [1, 2, 3], [0, 1, 2, 4, 3], [3, 1]])
def test_what_the_goal_does_not_need_goes(plan: list[int]) -> None:
    """What rests on an action that goes (after on idle, back on there) goes with it."""
    assert eliminate_actions(Successors(task(WAY, "g", "a"), {}), plan) == ([3], 2.0)


def test_what_the_goal_needs_stays_in_its_order() -> None:
    s = Successors(task(WAY, "g y", "a"), {})
    assert eliminate_actions(s, [0, 1, 2, 4, 3]) == ([0, 4, 3], 6.0)


def test_an_action_stays_whose_effect_alone_keeps_the_goal_from_failing() -> None:
    """The goal wants x not to be there: the action that adds g brings it, the next takes it."""
    ways = [operator("reach", "a", "g x"), operator("clear", "x", "", deleted="x")]
    s = Successors(task(ways, "g", "a", goal_absent="x"), {})
    assert eliminate_actions(s, [0, 1]) == ([0, 1], 2.0)


@pytest.mark.parametrize(("price", "kept"), [(5.0, [0, 1]), (1.0, [1]), (0.5, [1])])
def test_an_action_stays_that_saves_more_than_it_costs(price: float, kept: list[int]) -> None:
    """Clearing costs 1; without it the reach pays for its guard. Of two that cost as much, the shorter."""
    guard = Guard(facts("c"), ("clear",))
    ways = [operator("clear", "c", "", deleted="c"), operator("reach", "a", "g", guards=(guard,))]
    s = Successors(task(ways, "g", "a c"), {("clear",): price})
    assert eliminate_actions(s, [0, 1]) == (kept, 2.0 if len(kept) == 2 else 1.0 + price)


def test_a_forbidden_step_is_no_shorter_plan() -> None:
    guard = Guard(facts("c"), None)
    ways = [operator("clear", "c", "", deleted="c"), operator("reach", "a", "g", guards=(guard,))]
    assert eliminate_actions(Successors(task(ways, "g", "a c"), {}), [0, 1]) == ([0, 1], 2.0)


def test_an_action_stays_that_makes_room_for_the_next() -> None:
    ways = [operator("open", "x", "", deleted="x"), operator("reach", "a", "g", absent="x")]
    assert eliminate_actions(Successors(task(ways, "g", "a x"), {}), [0, 1]) == ([0, 1], 2.0)


def test_what_is_kept_already_pays_for_nothing_later() -> None:
    """An action of cost 10 that is needed is no reason to drop the clearing for a guard of 5."""
    guard = Guard(facts("c"), ("clear",))
    ways = [
        operator("long", "a", "b", cost=10.0), operator("clear", "c", "", deleted="c"),
        operator("reach", "b", "g", guards=(guard,)),
    ]  # fmt: skip
    s = Successors(task(ways, "g", "a c"), {("clear",): 5.0})
    assert eliminate_actions(s, [0, 1, 2]) == ([0, 1, 2], 12.0)


def two_ways(after: str = "s") -> InstantiatedTask:
    """`done` follows from a or from c where a static fact holds each; d comes with a only."""
    rules = [
        replace(axiom("done", "a"), static=facts("dear")),
        replace(axiom("done", "c"), static=facts("cheap")),
    ]
    ways = [operator("more", after, "c"), operator("both", "s", "a d")]
    return task(ways, "done d", "s", axioms=rules)


@pytest.mark.parametrize(("price", "kept"), [(5.0, [0, 1]), (1.0, [1]), (0.5, [1])])
def test_an_action_stays_that_the_goal_is_derived_from_for_less(
    price: float, kept: list[int]
) -> None:
    """Without `more` the goal still holds, from a; the plan is one action shorter, and dearer by 5 - 1."""
    s = Successors(two_ways(), {("dear",): price})
    assert eliminate_actions(s, [0, 1], GoalPrice(s)) == (kept, float(len(kept)))


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("cheap", [0.0, 0.2])
@pytest.mark.parametrize(
    ("dear", "named"), [(5.0, ["both", "more"]), (0.5, ["both"]), (math.inf, ["both", "more"])]
)
def test_a_search_returns_the_goal_that_it_waited_for(
    dear: float, cheap: float, named: list[str], packed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(selection, "pays", lambda entries: packed)
    found = search(two_ways(), price={("dear",): dear, ("cheap",): cheap})
    assert found.plan is not None
    assert sorted(one.name for one in found.plan.operators) == named
    assert found.plan.cost == len(named)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("method", ["wastar", "greedy"])
def test_a_goal_whose_derivation_is_forbidden_is_passed_by(
    method: str, packed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`more` can only follow where the goal holds already, but must not be derived from a."""
    monkeypatch.setattr(selection, "pays", lambda entries: packed)
    found = search(two_ways(after="d"), search=method, price={("dear",): math.inf})
    assert found.plan is not None
    assert [one.name for one in found.plan.operators] == ["both", "more"]


def cost_of(s: Successors, plan: Sequence[int]) -> float:
    """What a plan costs with its goal; infinite where it is none."""
    state, cost = s.initial, 0.0
    for one in plan:
        closed = s.closure(state)
        if one not in s.applicable(closed):
            return math.inf
        cost += s.step_cost(one, state)
        state = s.apply(one, state, closed)
    return cost + GoalPrice(s)(state) if s.holds_goal(s.closure(state)) else math.inf


def test_random_walks_become_plans_that_cost_no_more_and_have_no_action_to_spare() -> None:
    """Walks that end in a goal; afterwards no single action can be left out for nothing."""
    shortened = priced = 0
    for seed in range(200):
        rng = Random(seed)
        instantiated = instantiate(random_task(rng))
        static = sorted({fact for one in instantiated.axioms for fact in one.static})
        s = Successors(instantiated, {fact: rng.choice((0.5, 3.0)) for fact in static})
        goal_price, walk, state = GoalPrice(s), list[int](), s.initial
        for _ in range(8):
            closed = s.closure(state)
            ways = s.applicable(closed)
            if not ways:
                break
            walk.append(rng.choice(ways))
            state = s.apply(walk[-1], state, closed)
        whole = cost_of(s, walk)
        if whole == math.inf:
            continue

        kept, cost = eliminate_actions(s, walk, goal_price)
        total = cost_of(s, kept)
        assert total <= whole + 1e-9
        assert cost <= total
        for one in range(len(kept)):
            assert cost_of(s, [*kept[:one], *kept[one + 1 :]]) > total
        remaining = iter(walk)
        assert all(one in remaining for one in kept)  # in their order
        shortened += len(kept) < len(walk)
        priced += not goal_price.is_free
    assert shortened > 20 and priced > 10, (shortened, priced)
