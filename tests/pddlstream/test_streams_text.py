"""Facts and functions of a streams file, before the domain is known to which they belong."""

from __future__ import annotations

import pytest

from tamp.pddlstream.streams_text import facts_of, stream_functions
from tamp.symbolic.pddl.sexpr import read


def facts(text: str) -> list[tuple[str, int]]:
    return [(name, count) for name, count, _ in facts_of(read(f"(define (stream s) {text})"))]


def functions(text: str) -> list[tuple[str, int]]:
    found = stream_functions(read(f"(define (stream s) {text})"))
    return [(name, len(one.parameters)) for name, one in found]


@pytest.mark.parametrize("kind", [":stream", ":wild-stream"])
def test_conditions_and_promises_are_facts_and_lists_of_words_are_none(kind: str) -> None:
    text = f"""({kind} sample-pose
      :inputs (?o ?r) :domain (and (Stackable ?o ?r) (Region ?r)) :fluents (AtPose Holding)
      :outputs (?p) :certified (Supported ?o ?p ?r))"""
    assert facts(text) == [("stackable", 2), ("region", 1), ("supported", 3)]


def test_a_rule_that_names_its_variables_first() -> None:
    text = "(:rule :inputs (?q ?p) :domain (Kin ?q ?p) :certified (and (Reach ?q) (Seen)))"
    assert facts(text) == [("kin", 2), ("reach", 1), ("seen", 0)]


def test_a_decided_predicate_is_a_fact_with_its_condition() -> None:
    assert facts("(:predicate (Hits ?t ?p) (and (Traj ?t) (Pose ?p)))") == [
        ("hits", 2),
        ("traj", 1),
        ("pose", 1),
    ]


def test_of_a_function_its_condition_is_a_fact_and_its_head_a_function() -> None:
    text = "(:function (Distance ?a ?b) (and (Conf ?a) (Conf ?b)))"
    assert facts(text) == [("conf", 1), ("conf", 1)]
    assert functions(text) == [("distance", 2)]


def test_what_an_optimizer_asks_for_is_a_fact_its_words_are_not() -> None:
    text = """(:optimizer gurobi
      (:variables (?p) :inputs (?o) :domain (Graspable ?o) :graph (Pose ?o ?p))
      (:constraint (Kin ?o ?p) :necessary (and (Pose ?o ?p)) :cost (Length ?p)))"""
    assert facts(text) == [("graspable", 1), ("pose", 2), ("kin", 2), ("pose", 2), ("length", 1)]


@pytest.mark.parametrize("formula", ["(not (Far ?x))", "(or (Far ?x))", "(= ?x ?y)", "(?x ?y)"])
def test_what_is_no_fact_is_left_to_the_parser(formula: str) -> None:
    assert facts(f"(:stream s :inputs (?x) :domain {formula} :certified (Near ?x))") == [
        ("near", 1)
    ]


def test_an_empty_condition_and_words_alone_say_nothing() -> None:
    assert facts("(:stream s :inputs () :domain () :outputs (?x) :certified)") == []
    assert facts("(:stream)") == [] and functions("(:function)") == []
    assert functions("(:function cost (Conf ?a))") == [] and functions(":function") == []


def test_a_function_of_nothing() -> None:
    assert functions("(:function (Price) (and))") == [("price", 0)]


def test_each_fact_knows_its_line() -> None:
    text = (
        "(define (stream s)\n (:stream s :inputs (?x)\n  :domain (Far ?x)\n  :certified (Near ?x)))"
    )
    assert [(name, where.place.line) for name, _, where in facts_of(read(text))] == [
        ("far", 3),
        ("near", 4),
    ]
