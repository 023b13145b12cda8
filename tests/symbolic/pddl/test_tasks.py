from __future__ import annotations

from collections.abc import Callable

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_facts, parse_goal, parse_task
from tamp.symbolic.pddl.structs import And, Atom, Domain, Not

RaisesAt = Callable[..., InputError]
Changed = Callable[[str, str, str], str]
Objects = dict[str, tuple[str, ...]]

PROBLEM = """\
(define (problem one)
  (:domain cupboard)
  (:objects mug - movable table - (either fixed surface) b1 b2 - base-conf p - pose)
  (:init (hand-empty) (at-base b1) (at-pose mug p) (= (total-cost) 0)
         (= (distance b1 b2) 3) (not (at-base b2)))
  (:goal (and (on mug table) (not (at-base b1))))
  (:metric minimize (total-cost)))
"""


def test_goal(domain: Domain, objects: Objects) -> None:
    goal = parse_goal("(and (on mug table) (not (hand-empty)))", domain, objects)
    assert goal == And((Atom("on", ("mug", "table")), Not(Atom("hand-empty", ()))))


def test_objects_are_named_as_their_owner_writes_them(domain: Domain, objects: Objects) -> None:
    assert parse_goal("(ON box TABLE)", domain, objects) == Atom("on", ("Box", "table"))
    with pytest.raises(InputError, match="may mean any of several objects"):
        parse_goal("(on box table)", domain, {**objects, "BOX": ("movable",)})
    assert parse_goal("(on BOX table)", domain, {**objects, "BOX": ("movable",)}) == Atom(
        "on", ("BOX", "table")
    )


@pytest.mark.parametrize(
    ("marked", "message"),
    [
        (
            "(on mug @@mug)",
            "'mug' is a movable, not a surface. Choices: depot, table, cupboard_top",
        ),
        ("(on mug @@shelf)", "'shelf' is a container, not a surface"),
        (
            "(on @@cupboard_top table)",
            "'cupboard_top' is a surface, not a body. Choices: depot, mug, Box, table",
        ),
        (
            "(on mug @@tabel)",
            "unknown object 'tabel'. Choices: depot, table, cupboard_top. Did you mean 'table'?",
        ),
        ("(at-base @@mug)", "'mug' is a movable, not a base-conf; there is none"),
        ("@@(on mug)", "'on' takes 2 arguments, found 1. Its form is (on ?o ?s)"),
        ("(and\n  (@@onn mug table))", "unknown predicate 'onn'"),
        ("(on @@?x table)", "unknown variable '?x'"),
        ("(exists (?x - @@movabel) (on ?x table))", "unknown type 'movabel'"),
        ("@@(on mug table", "never closed"),
        ("(on mug table)@@)", "closes nothing"),
        ("(on mug table) @@(on Box table)", "expected the end of the text"),
        ("(@@increase (total-cost) 1)", "belongs into an effect"),
        ("(@@preference p (on mug table))", "'preference' is not supported"),
        ("@@on", "expected a condition"),
        ("(@@(on mug table))", "expected a predicate or one of and, or, not"),
        ("@@", "empty: expected one condition"),
        ("(on @@(mug) table)", "expected a variable or an object, found '(mug)'"),
    ],
)
def test_wrong_goal(
    marked: str, message: str, domain: Domain, objects: Objects, raises_at: RaisesAt
) -> None:
    raises_at(lambda text: parse_goal(text, domain, objects, "p.yaml"), marked, message)


def test_places_in_the_file_around_a_goal(domain: Domain, objects: Objects) -> None:
    with pytest.raises(InputError, match=r"^p\.yaml:18:15: 'mug' is"):
        parse_goal("(on mug mug)", domain, objects, "p.yaml", line_offset=17, column_offset=6)
    with pytest.raises(InputError, match=r"^p\.yaml:19:10: 'mug' is"):
        parse_goal(
            "(and\n (on mug mug))", domain, objects, "p.yaml", line_offset=17, column_offset=6
        )


def test_facts(domain: Domain, objects: Objects) -> None:
    expected = {("hand-empty",), ("at-pose", "mug", "p0")}
    objects = {**objects, "p0": ("pose",)}
    assert parse_facts("(hand-empty)\n(at-pose mug p0)", domain, objects) == expected
    assert parse_facts(["(hand-empty)", "(at-pose mug p0)"], domain, objects) == expected
    assert parse_facts("", domain, objects) == frozenset()


@pytest.mark.parametrize(
    ("marked", "message"),
    [
        ("@@(on mug table)", "'on' is derived"),
        ("@@(movable mug)", "'movable' is a type"),
        ("@@(not (hand-empty))", "expected a fact"),
        ("@@hand-empty", "expected a fact"),
        ("@@()", "expected a predicate"),
        ("(hand-empty) (@@hand-emty)", "unknown predicate 'hand-emty'"),
    ],
)
def test_wrong_facts(
    marked: str, message: str, domain: Domain, objects: Objects, raises_at: RaisesAt
) -> None:
    raises_at(lambda text: parse_facts(text, domain, objects), marked, message)


def test_problem(domain: Domain) -> None:
    task = parse_task(PROBLEM, domain, "one.pddl")
    assert task.name == "one"
    assert task.objects["table"] == ("fixed", "surface")
    assert task.objects["depot"] == ("body", "surface")
    assert task.initial == {("hand-empty",), ("at-base", "b1"), ("at-pose", "mug", "p")}
    assert task.costs == {("total-cost",): 0.0, ("distance", "b1", "b2"): 3.0}
    assert task.goal == And((Atom("on", ("mug", "table")), Not(Atom("at-base", ("b1",)))))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(:objects", "(@@:object", "unknown section ':object'"),
        ("mug - movable", "@@depot - body mug - movable", "'depot' is already a constant"),
        ("mug - movable", "mug - movable @@mug - surface", "object 'mug' stands twice"),
        ("mug - movable", "mug - @@movabel", "unknown type 'movabel'"),
        ("(at-base b1) (", "(at-base @@b3) (", "unknown object 'b3'. Choices: b1, b2"),
        ("(= (distance b1 b2) 3)", "(= (@@distanc b1 b2) 3)", "unknown function 'distanc'"),
        ("(= (distance b1 b2) 3)", "(= (distance b1 b2) @@-3)", "cannot be negative"),
        ("(= (distance b1 b2) 3)", "(= (distance b1 b2) @@far)", "expected a number"),
        ("(= (distance b1 b2) 3)", "@@(= (distance b1 b2))", "expected (= (FUNCTION"),
        ("(not (at-base b2))", "(not @@at-base)", "expected a fact"),
        ("(:goal (and", "@@(:goal) (:metric (and", "a problem has one (:goal CONDITION)"),
        ("minimize", "@@maximize", "'maximize' is not supported"),
        ("minimize", "@@minimise", "expected (:metric minimize (total-cost))"),
        ("minimize (total-cost)", "minimize @@(total-time)", "tamp has no durations"),
        ("minimize (total-cost)", "minimize @@(fuel-used)", "the metric is (total-cost)"),
    ],
)
def test_wrong_problem(
    old: str, new: str, message: str, domain: Domain, changed: Changed, raises_at: RaisesAt
) -> None:
    raises_at(lambda text: parse_task(text, domain), changed(PROBLEM, old, new), message)


def test_a_problem_for_another_domain_is_noted(domain: Domain) -> None:
    task = parse_task(
        PROBLEM.replace("(:domain cupboard)", "(:domain cupbord)"), domain, "one.pddl"
    )
    assert task.notes == (
        "one.pddl:2:12: the problem is for domain 'cupbord', the domain is 'cupboard'",
    )


def test_without_a_metric_every_action_costs_one(domain: Domain) -> None:
    assert any(action.cost != 1.0 for action in domain.actions)
    task = parse_task(PROBLEM.replace("(:metric minimize (total-cost))", ""), domain, "one.pddl")
    assert {action.cost for action in task.domain.actions} == {1.0}
    assert "one.pddl:1:18: the problem has no (:metric" in task.notes[0]
