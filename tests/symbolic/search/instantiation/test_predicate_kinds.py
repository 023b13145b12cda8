"""Predicates by kind: fluent where an action changes them, derived where a rule does, static else."""

from __future__ import annotations

from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.instantiation.normal_form import Literals, Normalizer
from tamp.symbolic.search.instantiation.predicate_kinds import NOTHING, Assumed, PredicateKinds

DOMAIN = """
(define (domain d)
  (:requirements :typing :derived-predicates)
  (:types thing place)
  (:predicates (at ?x - thing ?p - place) (road ?p ?q - place) (way ?p ?q - place) (busy ?p - place))
  (:action go :parameters (?x - thing ?p ?q - place) :precondition (and (at ?x ?p) (way ?p ?q))
    :effect (and (at ?x ?q) (not (at ?x ?p))))
  (:derived (way ?p ?q - place) (or (road ?p ?q) (exists (?m - place) (and (way ?p ?m) (road ?m ?q)))))
  (:derived (busy ?p - place) (exists (?x - thing) (at ?x ?p))))
"""
PROBLEM = """
(define (problem p) (:domain d) (:objects box - thing a b - place)
  (:init (at box a) (road a b)) (:goal (at box b)))
"""


def kinds(assumed: Assumed = NOTHING) -> PredicateKinds:
    domain = parse_domain(DOMAIN)
    task = parse_task(PROBLEM, domain)
    normalizer = Normalizer(domain)
    return PredicateKinds(task, normalizer, assumed)


def test_fluents_are_what_actions_change_and_rules_in_circles_are_recursive() -> None:
    made = kinds()
    assert made.fluent == {"at"}
    assert "way" in made.recursive() and "busy" not in made.recursive()


def test_a_static_fact_holds_when_it_is_known_or_assumed_and_not_refused() -> None:
    assert kinds().may_hold(("road", "a", "b")) and not kinds().may_hold(("road", "b", "a"))
    made = kinds({"road": ()})
    assert made.may_hold(("road", "b", "a"))
    made.refused = frozenset({("road", "b", "a"), ("road", "a", "b")})
    assert not made.may_hold(("road", "b", "a"))
    assert made.may_hold(("road", "a", "b"))  # what is known is not refused


def test_only_what_is_new_and_static_is_taken_over() -> None:
    made = kinds()
    facts = [("road", "a", "b"), ("road", "b", "c"), ("at", "box", "c")]
    assert made.add(facts, {"c": ("place",)}) == {"road": [("b", "c")]}
    assert made.add(facts, {"c": ("place",)}) == {}
    assert list(made.relations.rows("at")) == [("box", "a")]


def test_atoms_are_sorted_by_what_becomes_of_them() -> None:
    at, way, road = (
        Atom("at", ("?x", "?p")),
        Atom("way", ("?p", "?q")),
        Atom("road", ("?p", "?q")),
    )
    classified = kinds().classify(Literals((), (at, way, road), (way, road), ()))
    assert (classified.positive, classified.negative) == ((at,), ())
    assert (classified.derived, classified.refuted) == ((way,), (way,))
    assert (classified.static, classified.absent) == ((road,), (road,))
