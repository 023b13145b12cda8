"""A stream task prepared for a run: which streams are of use, which facts are there, what is shown."""

from __future__ import annotations

from typing import Any

import pytest

from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts
from tamp.symbolic.algorithms.planning_task import prepare
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.structs import Atom
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain shop)
  (:requirements :typing :negative-preconditions :derived-predicates)
  (:types cup pose)
  (:constants till - pose)
  (:predicates (pose ?c - cup ?p - pose) (at ?c - cup ?p - pose) (free ?c - cup ?p - pose ?d - cup ?q - pose)
    (blocked ?c - cup ?p - pose) (dusty ?c - cup) (tall ?c - cup) (sold ?c - cup) (unused ?c - cup))
  (:derived (blocked ?c - cup ?p - pose)
    (exists (?d - cup ?q - pose) (and (at ?d ?q) (not (free ?c ?p ?d ?q)))))
  (:action put :parameters (?c - cup ?p - pose) :precondition (and (pose ?c ?p) (not (blocked ?c ?p)))
    :effect (at ?c ?p))
  (:action sell :parameters (?c - cup) :precondition (at ?c till) :effect (sold ?c)))
"""
STREAMS = """
(define (stream shop)
  (:stream sample-pose :inputs (?c) :domain (cup ?c) :fluents (at tall) :outputs (?p) :certified (pose ?c ?p))
  (:stream test-free :inputs (?c ?p ?d ?q) :domain (and (pose ?c ?p) (pose ?d ?q)) :certified (free ?c ?p ?d ?q))
  (:stream test-dust :inputs (?c) :domain (cup ?c) :certified (unused ?c)))
"""
CUPS = {"mug": ("cup",), "glass": ("cup",)}


def shop(goal: str = "(sold mug)") -> StreamTask:
    functions: dict[str, Any] = dict.fromkeys(
        ("sample-pose", "test-free", "test-dust"), lambda *values, call: iter(())
    )
    return stream_task(
        DOMAIN, STREAMS, functions, CUPS, "(tall mug) (dusty mug) (at glass till)", goal
    )


def names(streams: Any) -> list[str]:
    return [stream.name for stream in streams]


def test_streams_that_nothing_asks_for_are_left_out_and_lazy_tests_are_not_instantiated() -> None:
    task = prepare(shop())
    assert names(task.streams) == ["sample-pose"]
    assert {name: stream.name for name, (stream, _) in task.lazily_tested.items()} == {
        "free": "test-free"
    }
    assert task.lazily_tested["free"][1] == Atom("free", ("?c", "?p", "?d", "?q"))


def test_unpruned_all_streams_are_instantiated_but_lazy_tests() -> None:
    assert names(prepare(shop(), pruned=False).streams) == ["sample-pose", "test-dust"]
    assert names(prepare(shop("(unused mug)")).streams) == ["sample-pose", "test-dust"]


def test_initial_facts_are_sorted_and_types_are_among_them() -> None:
    facts = prepare(shop()).initial_facts
    assert facts[:3] == (("at", "glass", "till"), ("dusty", "mug"), ("tall", "mug"))
    assert {("cup", "mug"), ("cup", "glass"), ("pose", "till"), ("object", "mug")} <= set(facts)
    assert len(facts) == len(set(facts))


def test_streams_are_shown_what_no_action_changes_beside_the_state() -> None:
    """`at` changes and comes with the state; `tall` does not; `dusty` nobody asked to see."""
    assert prepare(shop()).shown_facts == {("tall", "mug")}


def test_constants_are_objects_and_stand_for_themselves() -> None:
    objects = prepare(shop()).objects
    assert objects.types["till"] == ("pose",) and objects.values["till"] == "till"
    assert objects.values["mug"] == "mug"


def test_two_runs_have_objects_of_their_own() -> None:
    problem = shop()
    first, second = prepare(problem), prepare(problem)
    name = first.objects.add(1.5, ("pose",), "p")
    assert name not in second.objects.types and name not in problem.values


@pytest.mark.parametrize("goal", ["(sold mug)", "(sold glass)"])
def test_instantiation_takes_certified_facts_and_another_goal(goal: str) -> None:
    task = prepare(shop(goal))
    empty = task.instantiate([], OptimisticFacts(), frozenset())
    assert (empty.goal.positive <= empty.reachable | empty.initial) == (goal == "(sold glass)")
    certified = task.instantiate([("pose", "mug", "till")], OptimisticFacts(), frozenset())
    assert certified.goal.positive <= certified.reachable
    other = task.instantiate([], OptimisticFacts(), frozenset(), Atom("sold", ("glass",)))
    assert other.goal.positive == {("sold", "glass")}


def test_facts_of_lazy_tests_that_do_not_hold_forbid() -> None:
    task = prepare(shop())
    lazy = OptimisticFacts(lazily_tested=task.lazily_tested)
    pose, against = ("pose", "mug", "till"), ("free", "mug", "till", "glass", "till")
    other = ("pose", "glass", "till")

    def waived(false_facts: frozenset[Any], *facts: Any) -> set[Any]:
        made = task.instantiate([pose, *facts], lazy, false_facts)
        (put,) = (
            one for one in made.operators if one.name == "put" and one.arguments == ("mug", "till")
        )
        return {guard.waived_by for guard in put.guards}

    own = ("free", "mug", "till", "mug", "till")
    assert waived(frozenset(), other) == {against, own}
    assert waived(frozenset({against}), other) == {None, own}
    assert waived(frozenset()) == {None, own}  # the test is not asked of a pose that is none
