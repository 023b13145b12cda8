"""The optimistic task follows from knowledge: ended calls are out, excluded objects too, and depth is limited."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms.knowledge import Knowledge
from tamp.symbolic.algorithms.optimistic import optimistic_task as module
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import MAX_DEPTH
from tamp.symbolic.algorithms.optimistic.optimistic_task import (
    MAX_DEPTH_FACTOR,
    OptimisticTask,
    optimistic_task,
    raise_depth_limit,
    sampled_task,
)
from tamp.symbolic.algorithms.planning_task import PlanningTask, prepare
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain chain)
  (:requirements :typing)
  (:types link)
  (:predicates (link ?x) (after ?x ?y) (last ?x) (done))
  (:action end :parameters (?x) :precondition (last ?x) :effect (done))
  (:action close :parameters (?x ?y) :precondition (and (after ?x ?y) (last ?y)) :effect (done)))
"""
STREAMS = """
(define (stream chain)
  (:stream next :inputs (?x) :domain (link ?x) :outputs (?y) :certified (and (link ?y) (after ?x ?y)))
  (:stream test-last :inputs (?x) :domain (link ?x) :certified (last ?x)))
"""


def task(objects: str = "a", domain: str = DOMAIN, streams: str = STREAMS) -> PlanningTask:
    functions: dict[str, Any] = dict.fromkeys(("next", "test-last"), lambda *values, call: iter(()))
    init = " ".join(f"(link {name})" for name in objects.split())
    names = {name: ("object",) for name in objects.split()}
    return prepare(stream_task(domain, streams, functions, names, init, "(done)"))


def calls(made: OptimisticTask) -> set[tuple[str, ...]]:
    return {(instance.stream.name, *instance.inputs) for instance in made.facts.instances}


def test_endless_streams_are_instantiated_as_deep_as_a_plan_asks_for() -> None:
    knowledge = Knowledge()
    made = optimistic_task(task(), knowledge)
    assert knowledge.depth_limit == 1 and made.goal_is_reachable and not made.facts.complete
    assert ("next", "a") in calls(made)
    generators = [one for one in made.facts.instances if not one.stream.is_test]
    assert max(one.depth for one in generators) == 1


def test_the_limit_rises_until_the_goal_is_reachable() -> None:
    """Only what comes four links behind the start can end the chain."""
    names = ["link"] + [f"link{number}" for number in range(1, 5)]
    predicates = " ".join(f"({name} ?x)" for name in names)
    domain = DOMAIN.replace("(link ?x)", predicates, 1)
    steps = "".join(
        f"(:stream next{n} :inputs (?x) :domain ({here} ?x) :outputs (?y) :certified ({there} ?y))"
        for n, (here, there) in enumerate(pairwise(names))
    )
    endless = "(:stream next :inputs (?x) :domain (link ?x) :outputs (?y) :certified (and (link ?y) (after ?x ?y)))"
    test = "(:stream test-last :inputs (?x) :domain (link4 ?x) :certified (last ?x))"
    text = f"(define (stream chain) {endless} {steps} {test})"
    functions: dict[str, Any] = dict.fromkeys(
        ("next", "test-last", *(f"next{n}" for n in range(4))), lambda *values, call: iter(())
    )
    problem = stream_task(domain, text, functions, {"a": ("object",)}, "(link a)", "(done)")
    knowledge = Knowledge()
    made = optimistic_task(prepare(problem), knowledge)
    assert made.goal_is_reachable
    assert knowledge.depth_limit == 4


def test_where_it_is_their_number_no_depth_is_tried_in_vain(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two calls of the first level are too many for a second one: more are needed, not deeper ones."""
    made_of: list[int] = []
    instantiate = module.instantiate_streams

    def counted(*arguments: Any, **options: Any) -> Any:
        made_of.append(options["max_instances"])
        return instantiate(*arguments, **options)

    monkeypatch.setattr(module, "MAX_INSTANCES", 3)
    monkeypatch.setattr(module, "instantiate_streams", counted)
    domain = DOMAIN.replace("(last ?x)", "(last ?x) (far ?x)", 1)
    streams = """(define (stream chain)
      (:stream next :inputs (?x) :domain (link ?x) :outputs (?y) :certified (after ?x ?y))
      (:stream far :inputs (?x ?y) :domain (after ?x ?y) :outputs (?z) :certified (and (link ?z) (far ?z)))
      (:stream test-last :inputs (?x) :domain (far ?x) :certified (last ?x)))"""
    functions: dict[str, Any] = dict.fromkeys(
        ("next", "far", "test-last"), lambda *values, call: iter(())
    )
    names = {name: ("object",) for name in "abcd"}
    init = " ".join(f"(link {name})" for name in names)
    prepared = prepare(stream_task(domain, streams, functions, names, init, "(done)"))
    knowledge = Knowledge()

    made = optimistic_task(prepared, knowledge)
    assert made.facts.crowded and not made.goal_is_reachable
    assert knowledge.depth_limit == MAX_DEPTH and len(made_of) <= 3
    assert raise_depth_limit(knowledge, made) and knowledge.depth_factor == 2
    made = optimistic_task(prepared, knowledge)
    assert made.goal_is_reachable


def test_calls_that_ended_are_left_out_and_their_values_are_there() -> None:
    knowledge = Knowledge()
    prepared = task("a b")
    assert ("next", "a") in calls(optimistic_task(prepared, knowledge))
    knowledge.exhausted_calls["next", ("a",)] = Rejection("no more")
    knowledge.enumerated_calls.add(("next", ("b",)))
    knowledge.certified_facts.update({("link", "c"): None, ("after", "b", "c"): None})
    made = calls(optimistic_task(prepared, knowledge))
    assert ("next", "a") not in made and ("next", "b") not in made
    assert {("next", "c"), ("test-last", "c"), ("test-last", "a")} <= made


def test_nothing_is_instantiated_of_excluded_objects() -> None:
    prepared = task("a b")
    knowledge = Knowledge(excluded_objects=frozenset("b"))
    assert all("b" not in call for call in calls(optimistic_task(prepared, knowledge)))
    knowledge.excluded_objects = frozenset()
    assert ("next", "b") in calls(optimistic_task(prepared, knowledge))


def test_a_placeholder_always_means_the_same() -> None:
    prepared, knowledge = task("a b"), Knowledge(excluded_objects=frozenset("b"))
    before = {one.call: one.outputs for one in optimistic_task(prepared, knowledge).facts.instances}
    knowledge.excluded_objects = frozenset()
    after = {one.call: one.outputs for one in optimistic_task(prepared, knowledge).facts.instances}
    assert before.items() <= after.items() and len(after) > len(before)
    outputs = [name for names in after.values() for name in names]
    assert len(outputs) == len(set(outputs))


def test_depth_is_raised_by_one_and_then_the_number_of_instances_doubles() -> None:
    prepared, knowledge = task(), Knowledge()
    made = optimistic_task(prepared, knowledge)
    for limit in range(2, MAX_DEPTH + 1):
        assert raise_depth_limit(knowledge, made)
        assert (knowledge.depth_limit, knowledge.depth_factor) == (limit, 1)
    assert raise_depth_limit(knowledge, made)
    assert (knowledge.depth_limit, knowledge.depth_factor) == (MAX_DEPTH, 2)


def test_at_the_greatest_depth_it_is_given_up() -> None:
    prepared, knowledge = task(), Knowledge()
    made = optimistic_task(prepared, knowledge)
    knowledge.depth_factor = MAX_DEPTH_FACTOR
    knowledge.depth_limit = MAX_DEPTH * MAX_DEPTH_FACTOR
    assert not raise_depth_limit(knowledge, made)
    assert knowledge.incomplete


def test_where_all_is_instantiated_there_is_no_more() -> None:
    finite = STREAMS.replace("(and (link ?y) (after ?x ?y))", "(after ?x ?y)")
    prepared, knowledge = task(streams=finite), Knowledge()
    made = optimistic_task(prepared, knowledge)
    assert made.facts.complete and knowledge.depth_limit is None
    assert not raise_depth_limit(knowledge, made)
    assert not knowledge.incomplete


@pytest.mark.parametrize("sampled", [(), (("link", "c"), ("after", "a", "c")), (("last", "a"),)])
def test_the_sampled_task_has_no_placeholders_of_streams_that_can_be_called(
    sampled: tuple[Any, ...],
) -> None:
    knowledge = Knowledge()
    knowledge.sampled_facts.update(dict.fromkeys(sampled))
    made = sampled_task(task(), knowledge)
    assert not made.facts.instances
    assert made.goal_is_reachable == (("last", "a") in sampled)
