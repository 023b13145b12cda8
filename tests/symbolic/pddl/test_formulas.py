"""Conditions from text: connectives, variables that hide others, and every name checked against the domain."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.formulas import (
    Scope,
    parse_conjunction,
    parse_formula,
    parse_function_term,
    repeated,
    scope_of,
)
from tamp.symbolic.pddl.parser import parse_goal
from tamp.symbolic.pddl.sexpr import read_one
from tamp.symbolic.pddl.structs import Atom, Domain, Formula, Parameter

RaisesAt = Callable[..., InputError]
Objects = dict[str, tuple[str, ...]]


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


def formula(text: str, scope: Scope) -> Formula:
    return parse_formula(read_one(text, "a condition"), scope)


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("()", "(and)"),
        ("(imply (hand-empty) (on mug table))", "(or (not (hand-empty)) (on mug table))"),
        ("(movable mug)", "(movable mug)"),  # a type asks like a predicate
        ("(= mug table)", "(= mug table)"),
        ("(exists (?x - movable) (on ?x table))", "(exists (?x - movable) (on ?x table))"),
        (
            "(forall (?x - movable) (exists (?x - surface) (on mug ?x)))",
            "(forall (?x - movable) (exists (?x~2 - surface) (on mug ?x~2)))",
        ),
        (
            "(exists (?x ?x - movable) (on ?x table))",
            "(exists (?x - movable ?x~2 - movable) (and (on ?x~2 table) (= ?x ?x~2)))",
        ),
        (
            "(forall (?x ?x - movable) (on ?x table))",
            "(forall (?x - movable ?x~2 - movable) (or (on ?x~2 table) (not (= ?x ?x~2))))",
        ),
    ],
)
def test_connectives_and_quantifiers(
    text: str, read: str, domain: Domain, objects: Objects
) -> None:
    assert to_text(formula(text, scope_of(domain, objects))) == read


def test_an_inner_variable_hides_an_outer_one_under_a_name_of_its_own(domain: Domain) -> None:
    outer, _ = scope_of(domain).with_variables([Parameter("?x", ("movable",))])
    inner, bound = outer.with_variables([Parameter("?x", ("surface",)), Parameter("?y")])
    assert bound == (Parameter("?x~2", ("surface",)), Parameter("?y"))
    assert inner.variables["?x"].name == "?x~2" and outer.variables["?x"].name == "?x"
    assert repeated([Parameter("?x"), Parameter("?y")], bound) == ()


def test_streams_know_facts_and_conjunctions_only(domain: Domain, objects: Objects) -> None:
    def atoms(text: str) -> tuple[Atom, ...]:
        return parse_conjunction(read_one(text, "facts"), scope_of(domain, objects))

    empty = Atom("hand-empty", ())
    assert atoms("()") == ()
    assert atoms("(and (hand-empty) (and (on mug table)))") == (empty, Atom("on", ("mug", "table")))
    with pytest.raises(InputError, match=r"'or' is not possible here\. Streams have facts and"):
        atoms("(and (hand-empty) (or (hand-empty)))")


def test_a_more_general_object_is_noted_where_notes_are_taken(domain: Domain) -> None:
    objects = {"thing": ("body",), "slab": ("container",)}
    notes: list[str] = []
    noting = scope_of(domain, objects, notes)
    assert formula("(holding thing ?g)", noting.with_variables([Parameter("?g")])[0])
    assert notes == ["1:10: 'thing' is only said to be a body, where a movable is declared"]

    with pytest.raises(InputError, match="'slab' is a container, not a surface"):
        formula("(on thing slab)", noting)
    with pytest.raises(InputError, match="'thing' is a body, not a surface; there is none"):
        formula("(on thing thing)", Scope(domain, {"thing": ("body",)}, {}))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("(not)", "'not' takes one condition, found 0 parts"),
        ("(imply (hand-empty))", "'imply' takes two conditions, found 1 part:"),
        ("(distance mug mug)", "'distance' is a function, not a predicate"),
        ("(at-most (hand-empty))", "unknown connective 'at-most'"),
        ("(always (hand-empty))", "'always' is not supported: tamp has no trajectory constraints"),
        ("(= mug 3)", r"'\(= ... 3\)' is not supported: tamp has no numeric or object fluents"),
    ],
)
def test_what_is_no_condition(text: str, words: str, domain: Domain, objects: Objects) -> None:
    with pytest.raises(InputError, match=words):
        formula(text, scope_of(domain, objects))


def test_a_function_term_names_a_declared_function(domain: Domain) -> None:
    scope = scope_of(domain, {"b1": ("base-conf",)})
    term = parse_function_term(read_one("(Distance b1 b1)", "a function"), scope)
    assert term == Atom("distance", ("b1", "b1"))
    with pytest.raises(InputError, match=r"unknown function 'hand-empty'\. Choices: total-cost"):
        parse_function_term(read_one("(hand-empty)", "a function"), scope)
