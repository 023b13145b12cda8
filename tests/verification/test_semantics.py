"""PDDL's meaning on small domains."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tamp.verification.semantics import Semantics, State

DOMAIN = """
(define (domain boxes)
  (:requirements :adl :derived-predicates :action-costs)
  (:types thing place - object crate ball - thing)
  (:constants home - place)
  (:predicates (at ?x - thing ?p - place) (on ?x ?y - thing) (heavy ?x - thing) (near ?p ?q - place)
               (above ?x ?y - thing) (clear ?x - thing) (linked ?p ?q - place))
  (:derived (above ?x ?y - thing) (or (on ?x ?y) (exists (?z - thing) (and (on ?x ?z) (above ?z ?y)))))
  (:derived (clear ?x - thing) (not (exists (?y - thing) (above ?y ?x))))
  (:derived (linked ?p ?q - place) (near ?p ?q))
  (:derived (linked ?p ?q - place) (exists (?r - place) (and (linked ?p ?r) (linked ?r ?q))))
  (:action carry
    :parameters (?x - thing ?p ?q - place)
    :precondition (and (at ?x ?p) (clear ?x) (not (= ?p ?q)) (linked ?p ?q) (imply (heavy ?x) (near ?p ?q)))
    :effect (and (not (at ?x ?p)) (at ?x ?q)
                 (forall (?y - thing) (when (on ?x ?y) (not (on ?x ?y))))
                 (forall (?z - ball) (when (heavy ?x) (at ?z home)))))
  (:action stay :parameters (?x - thing ?p - place) :precondition (at ?x ?p) :effect (and (not (at ?x ?p)) (at ?x ?p))))
"""
OBJECTS = {
    "a": ("crate",),
    "b": ("crate",),
    "c": ("ball",),
    "yard": ("place",),
    "dock": ("place",),
    "home": ("place",),
}
START = [("at", "a", "yard"), ("at", "c", "dock"), ("on", "a", "b"), ("on", "b", "c"), ("near", "yard", "dock"),
         ("near", "dock", "home")]  # fmt: skip


@pytest.fixture
def semantics() -> Semantics:
    return Semantics(parse_domain(DOMAIN), OBJECTS)


@pytest.mark.parametrize(
    ("formula", "truth"),
    [
        ("(at a yard)", True),
        ("(at a dock)", False),
        ("(and)", True),
        ("(or)", False),
        ("(not (at a dock))", True),
        ("(above a c)", True),
        ("(above c a)", False),
        ("(clear a)", True),
        ("(clear c)", False),
        ("(linked yard home)", True),
        ("(linked home yard)", False),
        ("(linked yard yard)", False),
        ("(exists (?x - ball) (at ?x dock))", True),
        ("(exists (?x - crate) (at ?x dock))", False),
        ("(exists (?x ?y - thing) (and (on ?x ?y) (not (= ?x a))))", True),
        ("(forall (?x - thing) (or (clear ?x) (exists (?y - thing) (on ?y ?x))))", True),
        ("(forall (?x - crate) (at ?x yard))", False),
        ("(forall (?x - thing) (imply (clear ?x) (at ?x yard)))", True),
        ("(exists (?p - place) (not (exists (?x - thing) (at ?x ?p))))", True),
        ("(exists (?x - thing) (and))", True),
        ("(= a a)", True),
        ("(= a b)", False),
        ("(exists (?x - thing ?y - thing) (and (= ?x ?y) (on ?x ?y)))", False),
        ("(crate a)", True),
        ("(ball a)", False),
        ("(forall (?x - thing) (or (crate ?x) (ball ?x)))", True),
    ],
)
def test_formulas(semantics: Semantics, formula: str, truth: bool) -> None:
    goal = parse_goal(formula, semantics.domain, OBJECTS)
    assert semantics.holds(goal, State.of(START)) is truth


def test_unmet_parts_are_named(semantics: Semantics) -> None:
    carry = semantics.actions["carry"]
    assert semantics.unmet(carry, ("a", "yard", "dock"), State.of(START)) == []
    unmet = semantics.unmet(carry, ("c", "dock", "dock"), State.of(START))
    assert [to_text(part) for part in unmet] == [
        "(clear c)",
        "(not (= dock dock))",
        "(linked dock dock)",
    ]
    heavy = State.of([*START, ("heavy", "a")])
    assert len(semantics.unmet(carry, ("a", "yard", "home"), heavy)) == 1


def test_effects_read_the_state_before_and_adding_wins(semantics: Semantics) -> None:
    state = State.of([*START, ("heavy", "a")])
    after = semantics.apply(semantics.actions["carry"], ("a", "yard", "dock"), state)
    assert ("at", "a", "dock") in after
    assert ("at", "a", "yard") not in after
    assert ("on", "a", "b") not in after
    assert ("on", "b", "c") in after
    assert ("at", "c", "home") in after
    assert ("at", "a", "yard") in state, "the old state stays"
    assert ("at", "a", "yard") in semantics.apply(semantics.actions["stay"], ("a", "yard"), state)


def test_facts_can_take_the_place_of_rules(semantics: Semantics) -> None:
    goal = parse_goal("(above c a)", semantics.domain, OBJECTS)
    assert semantics.without(("above",)).holds(goal, State.of([*START, ("above", "c", "a")]))


def test_a_conjunction_of_thousands_is_judged_without_a_call_for_each(semantics: Semantics) -> None:
    state = State.of(START)
    for formula, truth in (
        (f"(and {'(at a yard) ' * 5_000})", True),
        (f"(and {'(and) ' * 5_000} (at a dock))", False),
        (f"(exists (?x - thing) (and {'(on ?x b) ' * 3_000} (at ?x yard)))", True),
    ):
        assert semantics.holds(parse_goal(formula, semantics.domain, OBJECTS), state) == truth
