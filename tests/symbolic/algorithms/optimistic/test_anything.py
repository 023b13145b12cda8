"""Which variables nothing is said of, and which conditions want two things to differ."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.optimistic.anything import anything, distinguishes
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tamp.symbolic.pddl.structs import Task

DOMAIN = """
(define (domain things)
  (:requirements :typing :equality :adl :derived-predicates)
  (:types cup lid - object)
  (:predicates (full ?c - cup) (fits ?l - lid ?c - cup) (done) (covered ?c - cup))
  RULE
  (:action act :parameters PARAMETERS :precondition CONDITION :effect EFFECT))
"""
CUP = "(?c - cup)"
PAIR = "(?c - cup ?l - lid)"
RULE = "(:derived (covered ?c - cup) BODY)"


def task(
    condition: str = "(done)",
    parameters: str = "()",
    goal: str = "(done)",
    rule: str = "",
    effect: str = "(done)",
) -> Task:
    text = DOMAIN.replace("CONDITION", condition).replace("PARAMETERS", parameters)
    domain = parse_domain(text.replace("RULE", rule).replace("EFFECT", effect))
    objects = {"c1": ("cup",), "c2": ("cup",)}
    return Task("t", domain, objects, frozenset(), parse_goal(goal, domain, objects), {})


@pytest.mark.parametrize(
    ("parameters", "condition", "expected"),
    [
        (CUP, "(full ?c)", set()),
        (CUP, "(done)", {("cup",)}),
        (CUP, "(not (full ?c))", {("cup",)}),
        (CUP, "(= ?c ?c)", {("cup",)}),
        (PAIR, "(fits ?l ?c)", set()),
        (PAIR, "(full ?c)", {("lid",)}),
        (PAIR, "(or (full ?c) (fits ?l ?c))", {("lid",)}),
        (PAIR, "(or (fits ?l ?c) (and (full ?c) (fits ?l ?c)))", set()),
        (CUP, "(and (full ?c) (exists (?l - lid) (done)))", {("lid",)}),
        (CUP, "(and (full ?c) (exists (?l - lid) (fits ?l ?c)))", set()),
        (CUP, "(and (full ?c) (forall (?l - lid) (done)))", set()),
        (CUP, "(and (full ?c) (not (forall (?l - lid) (done))))", {("lid",)}),
        (CUP, "(and (full ?c) (not (exists (?l - lid) (fits ?l ?c))))", set()),
    ],
)
def test_variables_that_no_fact_names(
    parameters: str, condition: str, expected: set[tuple[str, ...]]
) -> None:
    assert anything(task(condition, parameters)) == expected


def test_goals_and_heads_of_rules_ask_for_anything_too() -> None:
    assert anything(task(goal="(exists (?l - lid) (done))")) == {("lid",)}
    assert anything(task(goal="(exists (?c - cup) (full ?c))")) == set()
    assert anything(task(rule=RULE.replace("BODY", "(done)"))) == {("cup",)}
    assert anything(task(rule=RULE.replace("BODY", "(full ?c)"))) == set()
    assert anything(task(rule=RULE.replace("BODY", "(exists (?l - lid) (full ?c))"))) == {("lid",)}


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("(not (= ?c ?d))", True),
        ("(= ?c ?d)", False),
        ("(not (not (= ?c ?d)))", False),
        ("(not (full ?c))", False),
        ("(imply (= ?c ?d) (done))", True),
        ("(or (done) (and (full ?c) (not (= ?d c1))))", True),
        ("(exists (?e - lid) (not (= ?e ?c)))", True),
        ("(forall (?e - cup) (imply (full ?e) (= ?e ?c)))", False),
        ("(not (forall (?e - cup) (= ?e ?c)))", True),
    ],
)
def test_conditions_that_want_things_to_differ(condition: str, expected: bool) -> None:
    constants = "(:constants c1 - cup)"
    text = DOMAIN.replace("(:predicates", f"{constants} (:predicates").replace("RULE", "")
    text = text.replace("PARAMETERS", "(?c ?d - cup)").replace("EFFECT", "(done)")
    domain = parse_domain(text.replace("CONDITION", condition))
    one = Task("t", domain, {}, frozenset(), parse_goal("(done)", domain, {}), {})
    assert distinguishes(one) == expected


def test_only_things_that_may_be_of_the_asked_types_matter() -> None:
    both = task("(not (= ?c ?l))", PAIR)
    assert distinguishes(both, [("lid",)]) and distinguishes(both, [("cup",)])
    cups = task("(not (= ?c ?d))", "(?c ?d - cup)")
    assert distinguishes(cups, [("cup",)])
    assert not distinguishes(cups, [("lid",)])
    assert not distinguishes(cups, [])


def test_rules_effects_and_goals_count() -> None:
    assert distinguishes(task(rule=RULE.replace("BODY", "(exists (?d - cup) (not (= ?c ?d)))")))
    assert distinguishes(task(goal="(exists (?c ?d - cup) (and (full ?c) (not (= ?c ?d))))"))
    when = "(forall (?d - cup) (when (not (= ?c ?d)) (full ?d)))"
    assert distinguishes(task(parameters=CUP, effect=when))
    assert not distinguishes(task())
