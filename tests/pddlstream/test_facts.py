"""Nested tuples of Python values become PDDL, with names for values, and mistakes are said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.pddlstream.facts import Names, goal_formula, initial_facts, initial_functions
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain

DOMAIN = parse_domain("""(define (domain d) (:types body region)
  (:predicates (on ?a - body ?b - region) (clean ?a - body) (ready) (high ?a - body))
  (:functions (total-cost) (weight ?a - body))
  (:derived (high ?a) (clean ?a)))""")


def shown(goal: Any, **constants: Any) -> str:
    return to_text(goal_formula(goal, DOMAIN, Names(constants)))


def test_equal_values_share_a_name_and_words_keep_theirs() -> None:
    names = Names({"base": (0.0, 1.0)})
    assert names.of((0.0, 1.0)) == "base"
    assert names.of("mug") == "mug" and names.of("two words") == "v3"
    assert names.of(3) == names.of(3.0) != names.of("3")
    array = np.array([1.0, 2.0])
    assert (
        names.of(array) == names.of(array) != names.of(array.copy())
    )  # what has no hash is one by identity
    assert names.values["base"] == (0.0, 1.0) and names.values["v3"] == "two words"


def test_a_word_that_names_another_value_gets_a_number() -> None:
    names = Names({"mug": 17})
    other = names.of("mug")  # the text, not the constant
    assert other != "mug" and names.values[other] == "mug" and names.values["mug"] == 17


def test_a_made_name_does_not_take_a_constants() -> None:
    names = Names({"v2": "taken"})
    made = [names.of(1.5), names.of(2.5)]
    assert len({"v2", *made}) == 3


@pytest.mark.parametrize(
    ("goal", "text"),
    [
        (("clean", "mug"), "(clean mug)"),
        (("Clean", "mug"), "(clean mug)"),
        (["on", "mug", "table"], "(on mug table)"),
        (("and",), "(and)"),
        (("and", ("ready",), ("not", ("clean", "mug"))), "(and (ready) (not (clean mug)))"),
        (("imply", ("ready",), ("clean", "mug")), "(or (not (ready)) (clean mug))"),
        (("exists", "?x - body", ("on", "?x", "table")), "(exists (?x - body) (on ?x table))"),
        (
            ("forall", ["?x", "?y", "-", "body"], ("=", "?x", "?y")),
            "(forall (?x - body ?y - body) (= ?x ?y))",
        ),
        (("exists", ("?x",), ("body", "?x")), "(exists (?x) (body ?x))"),
    ],
)
def test_goals(goal: Any, text: str) -> None:
    assert shown(goal) == text


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (("clen", "mug"), "unknown predicate 'clen' in .*Did you mean 'clean'"),
        (("clean",), "'clean' takes 1 argument, found 0"),
        (("on", "mug"), "'on' takes 2 arguments, found 1"),
        (("not", ("ready",), ("ready",)), "'not' takes 1 part, found 2"),
        (("exists", ("ready",)), "'exists' takes 2 parts, found 1"),
        (("exists", "x", ("ready",)), "expected a variable such as .x, found 'x'"),
        (("exists", "?x - bdy", ("ready",)), "unknown type 'bdy'.*Did you mean 'body'"),
        (("exists", "?x -", ("ready",)), "unknown type ''"),
        (("clean", "?x"), "unknown variable '.x'"),
        (("and", ("exists", "?x", ("clean", "?x")), ("clean", "?x")), "unknown variable '.x'"),
        ((), "expected a condition such as .'On', 'mug', 'table'., found"),
        ("ready", "expected a condition such as"),
        ((1, 2), "expected a condition such as"),
    ],
)
def test_wrong_goals(goal: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        shown(goal)


def test_initial_facts_costs_types_and_what_nothing_asks_for() -> None:
    names = Names({})
    start = [("On", "mug", "table"), ("ready",), ("=", ("weight", "mug"), 2), ("body", "mug"), ("region", "mug"),
             ("velocity", "mug"), ("=", ("charge",), 3), ("velocity", "box")]  # fmt: skip
    found = initial_facts(start, DOMAIN, names)
    assert found.facts == {("on", "mug", "table"), ("ready",)}
    assert found.costs == {("weight", "mug"): 2.0}
    assert found.types == {"mug": ("body", "region")}
    assert [warning.split("'")[1] for warning in found.warnings] == ["velocity", "charge"]


@pytest.mark.parametrize(
    ("start", "words"),
    [
        ([("cleen", "mug")], "unknown predicate 'cleen'.*Did you mean 'clean'"),
        ([("on", "mug")], "'on' takes 2 arguments, found 1"),
        (
            [("high", "mug")],
            "'high' is derived: its rules say where it holds, .* cannot be an initial fact",
        ),
        ([("=", ("weight", "mug"))], r"expected \('=', \(FUNCTION, ...\), NUMBER\)"),
        ([("=", ("weight",), 3)], "'weight' takes 1 argument, found 0"),
        (["ready"], "expected an initial fact such as"),
    ],
)
def test_wrong_initial_facts(start: list, words: str) -> None:
    with pytest.raises(InputError, match=words):
        initial_facts(start, DOMAIN, Names({}))


def test_functions_of_the_start_are_declared_with_their_number_of_arguments() -> None:
    found = initial_functions([("=", ("Far", "a", "b"), 3), ("=", ("charge",), 1), ("ready",)])
    assert {name: len(one.parameters) for name, one in found.items()} == {"far": 2, "charge": 0}
