"""Effects are flattened to simple ones with their conditions and variables, and a cost."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.effects import Effects, parse_effects
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.formulas import Scope, scope_of
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.sexpr import read_one
from tamp.symbolic.pddl.structs import Effect, Parameter

DOMAIN = parse_domain("""(define (domain d) (:requirements :adl :action-costs) (:types body - object)
  (:predicates (on ?a ?b - body) (clean ?a - body) (ready) (high ?a - body))
  (:functions (total-cost) (weight ?a - body))
  (:derived (high ?a) (exists (?b - body) (on ?a ?b))))""")


def scope() -> Scope:
    inside, _ = scope_of(DOMAIN).with_variables(
        [Parameter("?x", ("body",)), Parameter("?y", ("body",))]
    )
    return inside


def parsed(text: str) -> Effects:
    return parse_effects(read_one(text, "an effect"), scope(), DOMAIN.derived_predicates)


def shown(effect: Effect) -> str:
    variables = " ".join(parameter.name for parameter in effect.parameters)
    sign = "+" if effect.adds else "-"
    return f"{variables}|{to_text(effect.condition)}|{sign}{to_text(effect.atom)}"


@pytest.mark.parametrize(
    ("text", "effects"),
    [
        ("()", []),
        ("(and)", []),
        ("(ready)", ["|(and)|+(ready)"]),
        ("(not (on ?x ?y))", ["|(and)|-(on ?x ?y)"]),
        (
            "(and (ready) (and (not (ready)) (clean ?x)))",
            ["|(and)|+(ready)", "|(and)|-(ready)", "|(and)|+(clean ?x)"],
        ),
        (
            "(when (clean ?x) (and (ready) (not (on ?x ?y))))",
            ["|(clean ?x)|+(ready)", "|(clean ?x)|-(on ?x ?y)"],
        ),
        ("(when (clean ?x) (when (clean ?y) (ready)))", ["|(and (clean ?x) (clean ?y))|+(ready)"]),
        ("(forall (?z - body) (clean ?z))", ["?z|(and)|+(clean ?z)"]),
        ("(forall (?z - body) (when (on ?z ?x) (not (clean ?z))))", ["?z|(on ?z ?x)|-(clean ?z)"]),
        ("(forall (?z) (forall (?w) (when (on ?z ?w) (ready))))", ["?z ?w|(on ?z ?w)|+(ready)"]),
        ("(when (clean ?x) (forall (?z - body) (clean ?z)))", ["?z|(clean ?x)|+(clean ?z)"]),
    ],
)
def test_nested_effects_become_simple_ones(text: str, effects: list[str]) -> None:
    assert [shown(effect) for effect in parsed(text).simple] == effects


def test_a_variable_that_hides_a_parameter_is_renamed() -> None:
    (effect,) = parsed("(forall (?x - body) (on ?x ?y))").simple
    (inner,) = effect.parameters
    assert inner.name != "?x" and effect.atom.terms == (inner.name, "?y")


def test_a_variable_written_twice_is_one() -> None:
    (effect,) = parsed("(forall (?z ?z - body) (clean ?z))").simple
    first, second = (parameter.name for parameter in effect.parameters)
    assert first != second
    assert f"(= {first} {second})" in to_text(
        effect.condition
    ) or f"(= {second} {first})" in to_text(effect.condition)


@pytest.mark.parametrize(
    ("text", "cost"),
    [
        ("(ready)", None),
        ("(increase (total-cost) 2)", 2.0),
        ("(and (increase (total-cost) 2) (ready) (increase (total-cost) 0.5))", 2.5),
        ("(increase (total-cost) 0)", 0.0),
    ],
)
def test_costs_add_up(text: str, cost: float | None) -> None:
    assert parsed(text).cost == cost


def test_a_cost_may_be_a_function() -> None:
    cost = parsed("(increase (total-cost) (weight ?x))").cost
    assert cost is not None and not isinstance(cost, float) and to_text(cost) == "(weight ?x)"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("(increase (total-cost) -1)", "an action's cost cannot be negative, found -1"),
        ("(increase (total-cost) 1e999)", "expected a number, found '1e999'"),
        ("(increase (total-cost) nan)", "expected a number, found 'nan'"),
        (
            "(increase (total-cost) (+ 1 2))",
            "arithmetic such as .* is not supported.*Name a number or a function",
        ),
        ("(increase (total-cost) (total-cost))", "the total cost cannot increase by itself"),
        ("(increase (weight ?x) 1)", r"only \(total-cost\) can be increased"),
        ("(increase (total-cost))", r"'increase' takes \(total-cost\) and an amount, found 1 part"),
        (
            "(and (increase (total-cost) 1) (increase (total-cost) (weight ?x)))",
            "by one function only",
        ),
        (
            "(when (ready) (increase (total-cost) 1))",
            "a cost inside 'when' or 'forall' is not supported",
        ),
        (
            "(forall (?z) (increase (total-cost) 1))",
            "a cost inside 'when' or 'forall' is not supported",
        ),
        ("(decrease (total-cost) 1)", r"'decrease' is not supported.*Costs grow by \(increase"),
        (
            "(or (ready) (clean ?x))",
            "'or' is not possible in an effect.*What happens only sometimes is written",
        ),
        ("(not (and (ready)))", "'and' is not possible in an effect"),
        ("(= ?x ?y)", "'=' is not possible in an effect"),
        ("(when (ready))", "'when' takes a condition and an effect, found 1 part"),
        ("(not)", "'not' takes one fact, found 0 parts"),
        ("(high ?x)", "an effect cannot change the derived predicate 'high'. Its rules define it"),
        ("(body ?x)", "an effect cannot change the type 'body' of an object"),
        ("(clen ?x)", "unknown predicate 'clen'.*Did you mean 'clean'"),
        ("(clean ?z)", "unknown variable '.z'"),
        ("(clean ?x ?y)", "'clean' takes 1 argument, found 2"),
        (
            "(probabilistic 0.5 (ready))",
            "'probabilistic' is not supported: tamp has no probabilistic effects",
        ),
    ],
)
def test_what_no_effect_can_do_is_refused_in_words(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        parsed(text)
