from __future__ import annotations

from collections.abc import Callable

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.lint import lint
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import And, Atom, Domain, Effect, Exists, Not, Or, Parameter

RaisesAt = Callable[..., InputError]
Changed = Callable[[str, str, str], str]


def test_declarations(domain: Domain) -> None:
    assert domain.name == "cupboard"
    assert domain.types["movable"] == "body"
    assert domain.types["body"] == "object" == domain.types["object"]
    assert domain.constants == {"depot": ("body", "surface")}
    assert list(domain.functions) == ["total-cost", "distance"]
    assert domain.predicates["on"].parameters == (
        Parameter("?o", ("body",)),
        Parameter("?s", ("surface",)),
    )
    assert domain.predicates["hand-empty"].parameters == ()
    assert domain.derived_predicates == {"on", "blocked"}
    assert domain.fluent_predicates == {"at-base", "at-pose", "holding", "hand-empty"}


def test_rules_take_their_types_from_the_predicate(domain: Domain) -> None:
    on = domain.derived[0]
    assert on.parameters == (Parameter("?o", ("body",)), Parameter("?s", ("surface",)))
    assert on.head == Atom("on", ("?o", "?s"))
    parts = (Atom("supported", ("?o", "?p", "?s")), Atom("at-pose", ("?o", "?p")))
    assert on.body == Exists((Parameter("?p", ("pose",)),), And(parts))


def test_actions(domain: Domain) -> None:
    move, pick, wait = domain.actions
    assert move.cost == Atom("distance", ("?b", "?b2"))
    assert move.effects == (
        Effect(Atom("at-base", ("?b2",)), True),
        Effect(Atom("at-base", ("?b",)), False),
    )
    assert pick.cost == 2.5
    assert wait.cost == 0.0  # where costs are counted, an action without one is free
    assert isinstance(pick.precondition, And)
    implied = Or((Not(Atom("on", ("?o", "depot"))), Not(Atom("blocked", ("?o", "?p")))))
    assert pick.precondition.parts[3] == implied
    assert wait.precondition == And(())
    holding, quantified = (
        Atom("holding", ("?o", "?g")),
        (Parameter("?o", ("movable",)), Parameter("?g", ("grasp",))),
    )
    assert wait.effects == (
        Effect(Atom("hand-empty", ()), True, holding, quantified),
        Effect(holding, False, holding, quantified),
    )


def test_without_types_and_costs() -> None:
    domain = parse_domain(
        "(DEFINE (DOMAIN blocks) (:PREDICATES (Clear ?x) (on ?x ?y)) (:action go :parameters (?x) :effect (Clear ?x)))"
    )
    assert domain.types == {"object": "object"}
    assert domain.predicates["clear"].parameters == (Parameter("?x"),)
    assert domain.actions[0].cost == 1.0


def test_a_variable_that_hides_another_is_renamed() -> None:
    domain = parse_domain(
        "(define (domain d) (:predicates (p ?x)) (:action a :parameters (?x)"
        " :precondition (and (p ?x) (exists (?x) (p ?x))) :effect (forall (?x) (not (p ?x)))))"
    )
    (action,) = domain.actions
    inner = Exists((Parameter("?x~2"),), Atom("p", ("?x~2",)))
    assert action.precondition == And((Atom("p", ("?x",)), inner))
    assert action.effects[0].atom == Atom("p", ("?x~2",))


def test_conditions_of_nested_whens_are_joined() -> None:
    domain = parse_domain(
        "(define (domain d) (:predicates (p) (q) (r)) (:action a :effect (when (p) (when (q) (not (r))))))"
    )
    assert domain.actions[0].effects == (
        Effect(Atom("r", ()), False, And((Atom("p", ()), Atom("q", ())))),
    )


def test_the_old_axiom() -> None:
    text = "(define (domain d) (:types t) (:predicates (p ?x - t) (q ?x - t)) {})"
    one = parse_domain(text.format("(:axiom (p ?x) (not (q ?x)))"))
    other = parse_domain(
        text.format("(:axiom :parameters (?x - t) :context (not (q ?x)) :implies (p ?x))")
    )
    assert one.derived == other.derived
    assert one.derived[0].parameters == (Parameter("?x", ("t",)),)


def test_types_are_unary_predicates() -> None:
    text = "(define (domain d) (:types t) (:predicates (p ?x)) (:action a :parameters (?x) :precondition (t ?x)))"
    assert parse_domain(text).actions[0].precondition == Atom("t", ("?x",))


def test_a_type_may_be_listed_twice_and_a_parent_not_at_all() -> None:
    text = """(define (domain d)
      (:types area place - object area crate - surface truck - vehicl surface - object vehicle)
      (:predicates (p ?x - surface) (q ?x - place))
      (:constants a - area))"""
    domain = parse_domain(text, "d.pddl")
    assert [domain.is_a("area", other) for other in ("surface", "object", "place", "crate")] == [
        True,
        True,
        False,
        False,
    ]
    assert domain.is_a("truck", "vehicl")
    assert not domain.is_a("vehicl", "vehicle")
    note = (
        "d.pddl:2:64: type 'vehicl' is not listed itself, only as a parent. Did you mean 'vehicle'?"
    )
    assert domain.notes == (note,)
    assert note in lint(domain)


WRONG = [
    # requirements, sections, names
    ("(:types\n    movable", "(@@:type\n    movable", "unknown section ':type'", ":types"),
    (
        "(domain Cupboard)",
        "@@(problem Cupboard)",
        "expected (domain NAME), found '(problem ...)'",
        None,
    ),
    ("(domain Cupboard)", "@@(domain Cup board)", "with one name, found 2 names", None),
    ("(domain Cupboard)", "@@cupboard", "expected (domain NAME), found 'cupboard'", None),
    (
        "(:derived (on ?o ?s)",
        "(@@:durative-action a) (:derived (on ?o ?s)",
        "':durative-action' is not supported",
        None,
    ),
    ("(:derived (on ?o ?s)", "@@strips (:derived (on ?o ?s)", "expected a section", None),
    # types
    ("movable fixed - body", "@@object - body", "'object' is the root of all types", None),
    (
        "movable fixed - body\n    body",
        "movable @@fixed - body\n body - fixed",
        "cycle: fixed - body - fixed",
        None,
    ),
    (
        "depot - (either body surface)",
        "depot - (either body @@surfac)",
        "unknown type 'surfac'",
        "surface",
    ),
    (
        "depot - (either body surface)",
        "depot - @@(ether body)",
        "expected a type or (either type ...)",
        None,
    ),
    ("depot - (either body surface)", "depot @@-", "expected a type after '-'", None),
    (
        "depot - (either body surface)",
        "depot - body @@depot - surface",
        "constant 'depot' stands twice",
        None,
    ),
    (
        "depot - (either body surface)",
        "@@?depot - body",
        "expected a constant, found '?depot'",
        None,
    ),
    # predicates and functions
    ("(holding ?o - movable", "(holding ?o - @@movabel", "unknown type 'movabel'", "movable"),
    (
        "(hand-empty)\n    (at-base ?b",
        "(at-base @@b",
        "expected a variable such as ?x, found 'b'",
        None,
    ),
    (
        "(hand-empty)\n    (at-base ?b",
        "@@hand-empty\n    (at-base ?b",
        "expected a predicate",
        None,
    ),
    (
        "(hand-empty)\n    (at-base ?b",
        "(@@when)\n    (at-base ?b",
        "'when' is a word of PDDL",
        None,
    ),
    (
        "(distance ?b ?b2 - ",
        "@@(blocked ?b) (distance ?b ?b2 - ",
        "'blocked' is already a predicate",
        None,
    ),
    ("(total-cost) - number", "(total-cost) - @@body", "tamp has no object fluents", None),
    ("(total-cost) - number", "(total-cost) - @@bodies", "functions have numbers as values", None),
    # rules
    ("(:derived (on ?o ?s)", "(:derived (@@onn ?o ?s)", "unknown predicate 'onn'", "on"),
    ("(:derived (on ?o ?s)", "(:derived @@(on ?o)", "'on' takes 2 arguments, found 1", None),
    (
        "(:derived (on ?o ?s)",
        "(:derived (on ?o @@depot)",
        "expected a variable such as ?x, found 'depot'",
        None,
    ),
    (
        "(:derived (on ?o ?s)",
        "@@(:derived (on ?o ?s) (and)",
        "takes a fact and a condition, found 3 parts",
        None,
    ),
    (
        "(and (supported ?o ?p ?s)",
        "(and (supported ?o ?p @@?t)",
        "unknown variable '?t'. Choices: ?o, ?s, ?p",
        None,
    ),
    ("(not (clear ?o ?p ?o2 ?p2))", "(not @@(blocked ?o2 ?p2))", "rests on its own negation", None),
    # actions
    (
        ":parameters (?b ?b2 - base-conf)",
        "@@:params (?b ?b2 - base-conf)",
        "unknown keyword ':params'",
        ":parameters",
    ),
    (":parameters ()", ":parameters () @@:parameters ()", "stands twice", None),
    (":parameters ()", "@@:parameters", "':parameters' of action 'wait' has no value", None),
    ("(:action wait", "(:action @@(wait)", "expected an action's name, found '(wait)'", None),
    # conditions
    (
        "(and (kin ?o ?p ?g ?b)",
        "(and @@(kin ?o ?p ?g)",
        "'kin' takes 4 arguments, found 3. Its form is (kin ?o",
        None,
    ),
    ("(and (kin ?o ?p ?g ?b)", "(and (@@kim ?o ?p ?g ?b)", "unknown predicate 'kim'", "kin"),
    ("(and (kin ?o ?p ?g ?b)", "(and (kin ?o ?p ?g @@b)", "unknown object 'b'", "?b"),
    (
        "(and (kin ?o ?p ?g ?b)",
        "(and (@@distance ?o ?p)",
        "'distance' is a function, not a predicate",
        None,
    ),
    (
        "(and (kin ?o ?p ?g ?b)",
        "(and (kin ?o ?p ?g @@depot)",
        "'depot' is a body and surface, not a base-conf",
        None,
    ),
    ("(imply (on", "(@@implies (on", "unknown connective 'implies'", "imply"),
    ("(imply (on ?o depot)", "@@(imply", "'imply' takes two conditions, found 1 part", None),
    (
        "(not (= ?o ?o2))",
        "@@(not (= ?o ?o2) (= ?o2 ?o))",
        "'not' takes one condition, found 2 parts",
        None,
    ),
    ("(not (= ?o ?o2))", "(not @@(= ?o))", "'=' takes 2 arguments, found 1", None),
    ("(not (= ?o ?o2))", "(@@> ?o ?o2)", "'>' is not supported", None),
    ("(not (= ?o ?o2))", "(@@when (= ?o ?o2) (= ?o ?o2))", "belongs into an effect", None),
    ("(exists (?p - pose) (and", "(exists @@?p (and", "expected a list of variables", None),
    (
        "(at-base ?b)\n    :effect",
        "@@at-base\n    :effect",
        "expected a condition such as (on ?a ?b)",
        None,
    ),
    # effects
    (
        "(and (holding ?o ?g)",
        "(and @@(on ?o depot)",
        "an effect cannot change the derived predicate 'on'",
        None,
    ),
    (
        "(and (holding ?o ?g)",
        "(and @@(movable ?o)",
        "an effect cannot change the type 'movable'",
        None,
    ),
    (
        "(and (holding ?o ?g)",
        "(and (@@or (holding ?o ?g))",
        "'or' is not possible in an effect",
        None,
    ),
    ("(and (holding ?o ?g)", "(and @@holding", "expected an effect such as", None),
    ("(total-cost) 2)", "@@(distance ?b ?b) 2)", "only (total-cost) can be increased", None),
    ("(total-cost) 2)", "(total-cost) @@-2)", "cannot be negative", None),
    ("(total-cost) 2)", "(total-cost) @@two)", "expected a number, found 'two'", None),
    ("(total-cost) 2)", "(total-cost) @@nan)", "expected a number, found 'nan'", None),
    (
        "(total-cost) 2)",
        "(total-cost) @@(+ 1 2))",
        "arithmetic such as '(+ ...)' is not supported",
        None,
    ),
    (
        "(total-cost) (distance ?b",
        "(total-cost) (@@distanc ?b",
        "unknown function 'distanc'",
        "distance",
    ),
    (
        "(increase (total-cost) 0.5)",
        "(@@increase (total-cost) (distance ?b ?b))",
        "by one function only",
        None,
    ),
    ("(increase (total-cost) 0.5)", "(@@assign (total-cost) 5)", "'assign' is not supported", None),
    (
        "(and (hand-empty) (not",
        "(and (@@increase (total-cost) 1) (not",
        "a cost inside 'when' or 'forall'",
        None,
    ),
]


@pytest.mark.parametrize(("old", "new", "message", "suggestion"), WRONG)
def test_wrong(
    old: str,
    new: str,
    message: str,
    suggestion: str | None,
    domain_text: str,
    changed: Changed,
    raises_at: RaisesAt,
) -> None:
    marked = changed(domain_text, old, new)
    error = raises_at(lambda text: parse_domain(text, "d.pddl"), marked, message)
    assert str(error).startswith("d.pddl:")
    assert error.suggestion == suggestion


def test_duplicate_predicate(domain_text: str, changed: Changed, raises_at: RaisesAt) -> None:
    marked = changed(domain_text, "(clear ?o - movable", "(@@pose ?o - movable")
    raises_at(parse_domain, marked, "predicate 'pose' stands twice; first in line 14")


def test_duplicate_sections(domain_text: str, changed: Changed, raises_at: RaisesAt) -> None:
    for old in ("(:constants", "(:predicates", "(:functions"):
        keyword = old[1:]
        marked = changed(domain_text, old, f"({keyword})\n({'@@'}{keyword}")
        raises_at(parse_domain, marked, f"section '{keyword}' stands twice")


@pytest.mark.parametrize(
    "text",
    ["()", "(domain d)", "define", "(define)", "(define (domain d) ())", "(define (domain d) x)"],
)
def test_no_domain(text: str) -> None:
    with pytest.raises(InputError, match=r"f:1:\d+: expected"):
        parse_domain(text, "f")


def test_unsupported_words_are_said_to_be() -> None:
    with pytest.raises(InputError, match="':durative-action' is not supported"):
        parse_domain("(define (domain d) (:durative-action a))")
