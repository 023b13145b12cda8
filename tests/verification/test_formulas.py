"""The judge's formulas: written, substituted, taken apart and unified as PDDL means them."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Formula, Not, Or, Parameter
from tamp.verification.formulas import (
    facts,
    flat,
    free,
    ground,
    predicates,
    substitute,
    unify,
)

ON = Atom("on", ("?x", "?y"))
CLEAR = Atom("clear", ("?x",))
SOME = Exists((Parameter("?y", ("surface",)),), And((ON, Not(CLEAR))))


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        (Atom("empty", ()), "(empty)"),
        (ON, "(on ?x ?y)"),
        (Not(CLEAR), "(not (clear ?x))"),
        (And(()), "(and)"),
        (Or((CLEAR, ON)), "(or (clear ?x) (on ?x ?y))"),
        (SOME, "(exists (?y - surface) (and (on ?x ?y) (not (clear ?x))))"),
        (
            Forall((Parameter("?x"), Parameter("?y")), ON),
            "(forall (?x ?y) (on ?x ?y))",
        ),
    ],
)
def test_formulas_are_written_in_pddl(formula: Formula, text: str) -> None:
    assert to_text(formula) == text


def test_free_variables_are_those_that_no_quantifier_binds() -> None:
    assert free(ON) == {"?x", "?y"}
    assert free(SOME) == {"?x"}
    assert free(And((SOME, Atom("at", ("?y", "table"))))) == {
        "?x",
        "?y",
    }  # a ?y of its own, outside


def test_substitution_stops_at_a_quantifier_of_the_same_name() -> None:
    assert to_text(substitute(SOME, {"?x": "cup", "?y": "table"})) == (
        "(exists (?y - surface) (and (on cup ?y) (not (clear cup))))"
    )
    both = Or((SOME, Not(Atom("wet", ("?y",)))))
    assert free(substitute(both, {"?x": "cup", "?y": "table"})) == set()
    assert to_text(substitute(both, {"?y": "table"})).endswith("(not (wet table)))")
    assert substitute(SOME, {}) == SOME


def test_a_conjunction_is_taken_apart_and_nothing_else() -> None:
    nested = And((ON, And((CLEAR, And(()), Or((ON, CLEAR)))), SOME))
    assert flat(nested) == [ON, CLEAR, Or((ON, CLEAR)), SOME]
    assert flat(And(())) == [] and flat(Not(And((ON, CLEAR)))) == [Not(And((ON, CLEAR)))]


def test_predicates_are_found_however_deep() -> None:
    assert predicates(Forall((Parameter("?z"),), Or((SOME, Not(Atom("wet", ("?z",))))))) == {
        "on",
        "clear",
        "wet",
    }


def test_facts_of_a_formula_are_its_atoms_without_variables() -> None:
    wet, dry = Atom("wet", ("cup",)), Atom("empty", ())
    formula = And((SOME, Not(wet), Or((dry, Forall((Parameter("?z"),), Atom("by", ("a", "b")))))))
    assert facts(formula) == {("wet", "cup"), ("empty",), ("by", "a", "b")}


def test_an_atom_is_ground_by_what_is_bound() -> None:
    assert ground(Atom("on", ("?x", "table")), {"?x": "cup", "?y": "no"}) == ("on", "cup", "table")


@pytest.mark.parametrize(
    ("terms", "row", "before", "after"),
    [
        (("?x", "?y"), ("a", "b"), {}, {"?x": "a", "?y": "b"}),
        (("?x", "?x"), ("a", "a"), {}, {"?x": "a"}),
        (("?x", "?x"), ("a", "b"), {}, None),
        (("?x", "b"), ("a", "b"), {"?x": "a"}, {"?x": "a"}),
        (("?x", "b"), ("c", "b"), {"?x": "a"}, None),
        (("a", "?y"), ("b", "b"), {}, None),
        (("?x",), ("a", "b"), {}, None),
        ((), (), {"?z": "c"}, {"?z": "c"}),
    ],
)
def test_unification(
    terms: tuple[str, ...], row: tuple[str, ...], before: dict, after: dict | None
) -> None:
    kept = dict(before)
    assert unify(terms, row, before) == after
    assert before == kept  # the binding that it extends stays as it was
