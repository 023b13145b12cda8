"""Formulas as replay reads them: the atoms that surely hold, against all states of small worlds."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from random import Random

import pytest

from tamp.symbolic.pddl.structs import And, Atom, Exists, Fact, Forall, Formula, Not, Or, Parameter
from tamp.symbolic.search.replay_formulas import (
    conjunct_atoms,
    formula_words,
    guard_atoms,
    substituted,
)

A, B, C = Atom("a", ("?x",)), Atom("b", ("?x", "k")), Atom("c", ())
X = Parameter("?x", ("thing",))


def test_variables_are_replaced_and_objects_stay() -> None:
    assert substituted(Atom("on", ("?x", "k", "?y", "?x")), {"?x": "m"}) == (
        "on", "m", "k", "?y", "m",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("formula", "atoms"),
    [
        (A, (A,)),
        (And((A, B)), (A, B)),
        (And((A, Not(B), Or((C,)), C)), (A, C)),
        (And(()), ()),
        (Not(A), ()),
        (Or((A, B)), ()),
        (Exists((X,), A), ()),
    ],
)
def test_atoms_that_hold_where_the_formula_does(formula: Formula, atoms: tuple[Atom, ...]) -> None:
    assert conjunct_atoms(formula) == atoms


@pytest.mark.parametrize(
    ("formula", "atoms"),
    [
        (Not(A), (A,)),
        (Not(And((A, B, Not(C)))), (A, B)),
        (Or((Not(A), B)), (A,)),
        (Or((Not(And((A, C))), Not(B), C)), (A, C, B)),
        (A, ()),
        (And((Not(A), Not(B))), ()),
        (Or((A, B)), ()),
        (Or(()), ()),
        (Forall((X,), Not(A)), ()),
    ],
)
def test_atoms_that_hold_where_the_formula_does_not(
    formula: Formula, atoms: tuple[Atom, ...]
) -> None:
    assert guard_atoms(formula) == atoms


def random_formula(rng: Random, depth: int) -> Formula:
    if not depth or rng.random() < 0.3:
        return Atom(rng.choice("abcd"), ())
    kind = rng.choice((And, Or, Not, Not))
    if kind is Not:
        return Not(random_formula(rng, depth - 1))
    return kind(tuple(random_formula(rng, depth - 1) for _ in range(rng.randint(0, 3))))


def true(formula: Formula, state: Iterable[Fact]) -> bool:
    match formula:
        case Atom():
            return (formula.predicate,) in state
        case Not(body):
            return not true(body, state)
        case And(parts):
            return all([true(part, state) for part in parts])
        case Or(parts):
            return any([true(part, state) for part in parts])
        case _:
            raise AssertionError(formula)


def test_they_do_in_every_state() -> None:
    """Replay looks among these atoms' facts only, so one that need not hold would hide a binding."""
    states = [
        [(name,) for name, there in zip("abcd", row, strict=True) if there]
        for row in itertools.product((False, True), repeat=4)
    ]
    told = 0
    for seed in range(400):
        formula = random_formula(Random(seed), 3)
        for state in states:
            sure = conjunct_atoms(formula) if true(formula, state) else guard_atoms(formula)
            assert {(atom.predicate,) for atom in sure} <= set(state)
            told += len(sure)
    assert told > 1000


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        (B, "(b m k)"),
        (Not(C), "(not (c))"),
        (And((A, Or((Not(A), C)))), "(and (a m) (or (not (a m)) (c)))"),
        (And(()), "(and)"),
        (Exists((Parameter("?y"), Parameter("?z")), Atom("d", ("?y", "?x"))),
         "(exists (?y ?z) (d ?y m))"),
        (Forall((Parameter("?y"),), Or((A, C))), "(forall (?y) (or (a m) (c)))"),
        (And((A, Exists((X,), And((A, B))))), "(and (a m) (exists (?x) (and (a ?x) (b ?x k))))"),
    ],
)  # fmt: skip
def test_words_are_pddl(formula: Formula, words: str) -> None:
    """A variable that a quantifier binds anew is not the one that is bound outside."""
    assert formula_words(formula, {"?x": "m"}) == words
