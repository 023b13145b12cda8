"""Of which bodies a goal wants relations: as the goal names them, through rules, and one proposer a body."""

from __future__ import annotations

import pytest

from tamp.planner.wanted_relations import advice, unasked_streams, wanted_facts
from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_streams
from tamp.symbolic.pddl.structs import Domain, Fact, StreamFile

DOMAIN = """
(define (domain d)
  (:requirements :adl :derived-predicates :typing)
  (:types movable pose)
  (:predicates (pose ?o - movable ?p - pose) (at-pose ?o - movable ?p - pose)
    (lefts ?o - movable ?p - pose ?o2 - movable ?p2 - pose) (left ?o ?o2 - movable)
    (nears ?o - movable ?p - pose ?o2 - movable ?p2 - pose) (near ?o ?o2 - movable)
    (done) (wanted-left ?o ?o2 - movable) (wanted-near ?o ?o2 - movable)
    (also-near ?o ?o2 - movable) (also-left ?o ?o2 - movable) (lonely ?o - movable) {more})
  {actions}
  (:derived (left ?o ?o2 - movable) (exists (?p ?p2 - pose)
    (and (lefts ?o ?p ?o2 ?p2) (at-pose ?o ?p) (at-pose ?o2 ?p2))))
  (:derived (near ?o ?o2 - movable) (exists (?p ?p2 - pose)
    (and (nears ?o ?p ?o2 ?p2) (at-pose ?o ?p) (at-pose ?o2 ?p2))))
  (:derived (lonely ?o - movable) (forall (?o2 - movable) (not (near ?o ?o2)))))
"""
PUT = """(:action put :parameters (?o - movable ?p - pose) :precondition (pose ?o ?p)
    :effect (at-pose ?o ?p))"""
STREAM = """(:stream sample-{name} :inputs (?o ?o2 ?p2)
    :domain (and (movable ?o) (pose ?o2 ?p2)) :outputs (?p)
    :certified (and (pose ?o ?p) ({name}s ?o ?p ?o2 ?p2)))"""
BODIES = ("a", "b", "c")
OBJECTS = dict.fromkeys(BODIES, ("movable",))
START = [("pose", body, f"{body}_p") for body in BODIES]


def domain_of(actions: str = PUT, more: str = "") -> Domain:
    return parse_domain(DOMAIN.format(actions=actions, more=more))


def streams_of(domain: Domain) -> StreamFile:
    streams = "".join(STREAM.format(name=name) for name in ("left", "near"))
    return parse_streams(f"(define (stream d) {streams})", domain, None)


def wanted(goal: str, actions: str = PUT) -> set[Fact]:
    domain = domain_of(actions)
    formula = parse_goal(goal, domain, OBJECTS)
    return wanted_facts(streams_of(domain), domain, formula, OBJECTS, START, BODIES)


def test_a_goal_wants_what_it_names() -> None:
    assert wanted("(left a b)") == {("wanted-left", "a", "b")}
    assert wanted("(and (left a b) (left b c))") == {
        ("wanted-left", "a", "b"),
        ("wanted-left", "b", "c"),
    }
    assert wanted("(and)") == set()


def test_a_variable_wants_all_but_a_body_with_itself() -> None:
    assert wanted("(exists (?x - movable) (left a ?x))") == {
        ("wanted-left", "a", "b"),
        ("wanted-left", "a", "c"),
    }


def test_what_must_not_hold_is_not_wanted() -> None:
    assert wanted("(not (left a b))") == set()
    assert wanted("(lonely a)") == set()


def test_an_action_that_asks_for_a_relation_wants_it_of_all() -> None:
    ask = """(:action ask :parameters (?o ?o2 - movable) :precondition (near ?o ?o2)
        :effect (done))"""
    assert wanted("(done)", PUT + ask) == {
        ("wanted-near", one, other) for one in BODIES for other in BODIES if one != other
    }


def test_one_relation_proposes_where_a_body_is_the_others_are_wanted_also() -> None:
    found = wanted("(and (left a b) (near a c))")
    assert ("also-near", "a", "c") in found and ("also-left", "a", "b") not in found
    assert {("wanted-left", "a", "b"), ("wanted-near", "a", "c")} <= found


def test_a_circle_is_broken_where_it_closes() -> None:
    found = wanted("(and (left a b) (left b c) (left c a))")
    assert {fact for fact in found if fact[0].startswith("also")} == {("also-left", "c", "a")}
    open_ = wanted("(and (left a b) (left b c))")
    assert not any(fact[0].startswith("also") for fact in open_)


@pytest.mark.parametrize(
    ("goal", "idle"),
    [("(left a b)", {"near"}), ("(and)", {"left", "near"}), ("(lonely a)", {"left"})],
)
def test_streams_that_nothing_asks_for_need_no_function(goal: str, idle: set[str]) -> None:
    domain = domain_of()
    formula = parse_goal(goal, domain, OBJECTS)
    found = unasked_streams(streams_of(domain), domain, formula)
    assert {name for name in ("left", "near") if f"sample-{name}" in found} == idle


def test_predicates_that_speak_of_the_goal_are_advice() -> None:
    """They are no part of a plan file; the relation itself speaks of the world, and is."""
    told = {"wanted-left", "wanted-near", "also-near", "also-left"}
    assert advice(domain_of()) == told
    settled = advice(domain_of(more="(settled ?o - movable ?p - pose)"))
    assert settled == told | {"settled", "unbound", "meant"}
