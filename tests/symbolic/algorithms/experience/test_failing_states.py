"""Calls that gave nothing in a state are not asked in that state again, by whatever way it is reached."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.experience.failing_states import (
    OTHER_STATE_PREDICATE,
    avoid_failing_states,
    choose_instances,
)
from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts, OptimisticInstance
from tamp.symbolic.pddl.structs import Fact, Stream
from tamp.symbolic.search.operators import Goal, InstantiatedTask, Operator
from tamp.symbolic.search.search import search

WAY: Fact = ("way", "#w1")
DOORS = [("open", name) for name in "abc"]


def instance(stream: str, *inputs: str) -> OptimisticInstance:
    """A call of a stream that looks at doors and certifies the way."""
    declared = Stream(stream, (), (), (), (), ("open",))
    return OptimisticInstance(BoundStream(declared, lambda: None, ()), inputs, (), (), (WAY,), 1)


def facts_of(first: OptimisticInstance, *others: OptimisticInstance) -> OptimisticFacts:
    made = [first, *others]
    return OptimisticFacts(
        producers={WAY: first}, alternatives={WAY: made} if others else {}, instances=made
    )


def task(initial: frozenset[Fact] = frozenset()) -> InstantiatedTask:
    """Doors are opened for one, closed for one; going takes a way."""
    none: frozenset[Fact] = frozenset()
    operators = [
        Operator("go", (), none, none, frozenset({("there",)}), none, static=frozenset({WAY})),
        *(
            Operator("open", door[1:], none, frozenset({door}), frozenset({door}), none)
            for door in DOORS
        ),
        *(
            Operator("shut", door[1:], frozenset({door}), none, none, frozenset({door}))
            for door in DOORS
        ),
    ]
    goal = Goal(frozenset({("there",)}))
    return InstantiatedTask(
        initial, goal, tuple(operators), (), frozenset({("there",), *DOORS}), {}
    )


def doors_when_going(
    failed: dict[str, list[frozenset[Fact]]], *made: OptimisticInstance
) -> frozenset[Fact] | None:
    """The open doors in the state from which the cheapest plan goes; None without a plan."""
    experience = Experience()
    for stream, states in failed.items():
        for state in states:
            experience.record_failing_state((stream, ()), ("open",), state)
    plan = search(
        avoid_failing_states(task(), experience, facts_of(*made)), search="astar", heuristic="blind"
    ).plan
    if plan is None:
        return None
    state: frozenset[Fact] = frozenset()
    for operator in plan.operators:
        if operator.name == "go":
            return state
        state = (state - operator.deleted) | operator.added
    raise AssertionError("nobody went")


NOTHING: frozenset[Fact] = frozenset()
ALL_STATES = [frozenset(some) for count in range(4) for some in combinations(DOORS, count)]


def test_without_failures_the_task_is_the_same() -> None:
    before = task()
    assert avoid_failing_states(before, Experience(), facts_of(instance("plan"))) is before
    assert doors_when_going({}, instance("plan")) == NOTHING


@pytest.mark.parametrize("count", range(1, 8))
def test_a_call_is_asked_in_the_nearest_state_in_which_it_has_not_failed(count: int) -> None:
    failed = ALL_STATES[:count]
    found = doors_when_going({"plan": failed}, instance("plan"))
    assert found is not None and found not in failed
    assert len(found) == min(len(state) for state in ALL_STATES if state not in failed)


def test_when_it_failed_in_all_states_there_is_no_plan() -> None:
    assert doors_when_going({"plan": ALL_STATES}, instance("plan")) is None


def test_of_several_calls_one_must_not_have_failed_there() -> None:
    made = instance("plan"), instance("fly")
    assert doors_when_going({"plan": ALL_STATES}, *made) == NOTHING, "the other call never failed"
    one_door = [frozenset({door}) for door in DOORS]
    found = doors_when_going({"plan": ALL_STATES, "fly": [NOTHING, *one_door]}, *made)
    assert found is not None and len(found) == 2
    assert doors_when_going({"plan": ALL_STATES, "fly": ALL_STATES}, *made) is None


def test_facts_of_other_predicates_say_nothing() -> None:
    experience = Experience()
    experience.record_failing_state(("plan", ()), ("lit",), NOTHING)
    changed = avoid_failing_states(task(), experience, facts_of(instance("plan")))
    assert search(changed, search="astar", heuristic="blind").plan is None, (
        "no lamp can be lit, whatever is opened"
    )


def test_made_up_predicates_look_like_no_pddl_name() -> None:
    assert OTHER_STATE_PREDICATE.startswith("(")


@pytest.mark.parametrize(
    ("state", "chosen"),
    [(NOTHING, "fly"), (frozenset(DOORS[:1]), "plan"), (frozenset(DOORS), None)],
)
def test_the_first_call_that_has_not_failed_in_the_state_is_chosen(
    state: frozenset[Fact], chosen: Any
) -> None:
    made = instance("plan"), instance("fly")
    experience = Experience()
    for stream, failed in (
        ("plan", NOTHING),
        ("plan", frozenset(DOORS)),
        ("fly", frozenset(DOORS)),
    ):
        experience.record_failing_state((stream, ()), ("open",), failed)
    found = choose_instances(facts_of(*made), experience, frozenset({WAY}), state | {("there",)})
    assert ({WAY: chosen} if chosen else {}) == {
        fact: one.stream.name for fact, one in found.items()
    }


def test_nothing_is_chosen_where_one_call_certifies() -> None:
    assert (
        choose_instances(facts_of(instance("plan")), Experience(), frozenset({WAY}), NOTHING) == {}
    )
