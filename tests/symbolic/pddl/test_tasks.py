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
