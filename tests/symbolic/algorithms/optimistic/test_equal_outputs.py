"""Conditions over equal outputs of two calls: where they are, nothing is proven by placeholders."""

from __future__ import annotations

import pytest

from tamp.pddlstream import from_list_fn, solve
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.optimistic.equal_outputs import equal_outputs_may_meet
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_streams
from tamp.symbolic.pddl.structs import Task

DOMAIN = """
(define (domain roads)
  (:types thing way - object)
  (:predicates (is-thing ?x - thing) (from ?x - thing ?w - way) (to ?x - thing ?w - way)
               (joined ?x - thing ?w - way) (wide ?w - way) (moved) (done))
  {rule}
  (:action go :parameters (?x ?y - thing ?v ?w - way)
    :precondition {condition} :effect {effect}))
"""
STREAMS = """
(define (stream roads)
  (:stream plan-from :inputs (?x) :domain (is-thing ?x) :fluents ({fluents})
    :outputs (?w) :certified (from ?x ?w))
  (:stream plan-to :inputs (?x) :domain (is-thing ?x) :fluents ({fluents})
    :outputs (?w) :certified (to ?x ?w)))
"""
MEETS = "(and (from ?x ?w) (to ?y ?w))"


def said(
    condition: str, *, rule: str = "", effect: str = "(done)", goal: str = "(done)",
    fluents: str = "moved",
) -> bool:  # fmt: skip
    domain = parse_domain(DOMAIN.format(rule=rule, condition=condition, effect=effect))
    declared = parse_streams(STREAMS.format(fluents=fluents), domain)
    streams = [BoundStream(one, lambda *_, **__: iter(()), (("way",),)) for one in declared.streams]
    objects = {"a": ("thing",), "b": ("thing",)}
    task = Task("roads", domain, objects, frozenset(), parse_goal(goal, domain, objects), {})
    return equal_outputs_may_meet(task, streams)


@pytest.mark.parametrize(
    ("condition", "more"),
    [
        (MEETS, {}),
        ("(not (and (from ?x ?w) (not (to ?y ?w))))", {}),
        ("(exists (?u - way) (and (from ?x ?u) (to ?y ?u)))", {}),
        ("(and (from ?x ?w) (from ?y ?w))", {}),
        ("(and (from ?x ?v) (to ?y ?w) (= ?v ?w))", {}),
        (
            "(and (joined ?x ?w) (to ?y ?w))",
            {"rule": "(:derived (joined ?x - thing ?w - way) (from ?x ?w))"},
        ),
        ("(from ?x ?w)", {"effect": "(wide ?w)", "goal": "(exists (?w - way) (and (wide ?w) (to a ?w)))"}),
    ],
)  # fmt: skip
def test_two_facts_about_one_output_are_seen(condition: str, more: dict[str, str]) -> None:
    assert said(condition, **more)


@pytest.mark.parametrize(
    ("condition", "more"),
    [
        ("(and (from ?x ?v) (to ?y ?w))", {}),
        ("(and (from ?x ?v) (from ?x ?v))", {}),
        ("(from ?x ?w)", {"effect": "(wide ?w)"}),
        (MEETS, {"fluents": ""}),
    ],
)
def test_outputs_that_stand_alone_or_are_asked_for_beforehand_are_not(
    condition: str, more: dict[str, str]
) -> None:
    assert not said(condition, **more)


@pytest.mark.parametrize("algorithm", ["adaptive", "incremental"])
def test_no_plan_is_not_called_infeasible_where_two_ways_may_be_equal(algorithm: str) -> None:
    """Both streams give the way 'bridge': for PDDLStream one object, of which the placeholders know nothing."""
    give = from_list_fn(lambda *_, **__: [("bridge",)])
    init = [("thing", "a"), ("is-thing", "a"), ("thing", "b"), ("is-thing", "b")]
    problem = (
        DOMAIN.format(rule="", condition=MEETS, effect="(done)"), {}, STREAMS.format(fluents="moved"),
        {"plan-from": give, "plan-to": give}, init, ("done",),
    )  # fmt: skip
    solution = solve(problem, algorithm, max_time=10.0)
    assert solution.outcome in (Outcome.SOLVED, Outcome.EXHAUSTED)
