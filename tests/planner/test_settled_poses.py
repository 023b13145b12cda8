"""Which bodies the goal says a place of, and which may stay anywhere."""

from __future__ import annotations

import pytest

from tamp.planner.settled_poses import GOAL_PREDICATES, settled_facts
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tamp.symbolic.pddl.structs import Fact

DOMAIN = """(define (domain d) (:types movable surface - object)
  (:predicates (on ?o ?s) (inside ?o ?s) (near ?o ?o2) (clean ?o) (portable ?o) {goals}))"""
GOALS = "(settled ?o ?p) (unbound ?o) (meant ?o ?place)"
MOVABLE = ("cup", "tray")
OBJECTS = {"cup": ("movable",), "tray": ("movable",), "table": ("surface",)}


def found(
    goal: str, *, facts: tuple[Fact, ...] = (), wanted: tuple[Fact, ...] = (), now: bool = False,
    goals: str = GOALS,
) -> set[Fact]:  # fmt: skip
    domain = parse_domain(DOMAIN.format(goals=goals))
    parsed = parse_goal(goal, domain, OBJECTS)
    return settled_facts(domain, parsed, MOVABLE, facts, wanted, now)


@pytest.mark.parametrize("relation", ["on", "inside"])
def test_a_body_is_meant_where_the_goal_wants_it(relation: str) -> None:
    assert found(f"({relation} cup table)") == {("meant", "cup", "table"), ("unbound", "tray")}


@pytest.mark.parametrize(
    "goal",
    [
        "(clean cup)",
        "(not (on cup table))",
        "(or (on cup table) (on cup tray))",
        "(near cup tray)",
        "(on table table)",
    ],
)
def test_what_the_goal_does_not_need_binds_nobody(goal: str) -> None:
    assert found(goal) == {("unbound", "cup"), ("unbound", "tray")}


def test_each_conjunct_counts_also_below_a_quantifier() -> None:
    assert found("(exists (?s - surface) (and (on cup table) (on tray ?s)))") == {
        ("meant", "cup", "table"),
        ("unbound", "tray"),
    }


def test_a_place_of_whatever_name_is_no_place_where_a_body_has_to_stay() -> None:
    """Else no pose of the tray were settled, and a goal with a cup on it were called infeasible."""
    goal = "(and (exists (?s - surface) (on tray ?s)) (on cup tray))"
    assert found(goal) == {("meant", "cup", "tray"), ("unbound", "tray")}
    assert found("(exists (?s) (and (inside cup ?s) (on cup table)))") == {
        ("meant", "cup", "table"),
        ("unbound", "tray"),
    }


def test_what_is_portable_may_be_anywhere_and_is_meant_somewhere() -> None:
    portable = (("portable", "tray"),)
    assert found("(and (on cup tray) (on tray table))", facts=portable) == {
        ("meant", "cup", "tray"),
        ("meant", "tray", "table"),
        ("unbound", "tray"),
    }


def test_a_wanted_relation_binds_a_body_without_a_place() -> None:
    wanted = (("near", "cup", "tray"),)
    assert found("(near cup tray)", wanted=wanted) == {("unbound", "tray")}
    assert found("(near tray cup)", wanted=wanted) == {("unbound", "cup"), ("unbound", "tray")}


def test_where_actions_want_relations_nobody_is_bound() -> None:
    assert found("(on cup table)", now=True) == {("unbound", "cup"), ("unbound", "tray")}


@pytest.mark.parametrize("missing", GOAL_PREDICATES)
def test_a_domain_without_the_words_gets_no_facts(missing: str) -> None:
    goals = " ".join(f"{part})" for part in GOALS.split(") ") if missing not in part)
    assert found("(on cup table)", goals=goals.replace("))", ")")) == set()
