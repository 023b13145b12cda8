"""The one walk over formulas: every atom once, from left to right, with its sign."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.atoms import atoms, necessary_atoms, signed_atoms
from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Formula, Not, Or, Parameter

A, B, C = (Atom(name, ("?x",)) for name in "abc")
X = (Parameter("?x", ("object",)),)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (A, "+a"),
        (Not(A), "-a"),
        (Not(Not(A)), "+a"),
        (And((A, B, C)), "+a +b +c"),
        (Or((C, Not(B), A)), "+c -b +a"),
        (Not(And((A, Or((B, Not(C)))))), "-a -b +c"),
        (Exists(X, Not(Forall(X, Not(A)))), "+a"),
        (Forall(X, Or((Not(A), B))), "-a +b"),
        (And(()), ""),
        (Not(Or(())), ""),
        (And((A, A)), "+a +a"),
    ],
)
def test_atoms_come_from_left_to_right_with_their_signs(formula: Formula, expected: str) -> None:
    assert (
        " ".join(("+" if sign else "-") + atom.predicate for atom, sign in signed_atoms(formula))
        == expected
    )
    turned = [(atom, not sign) for atom, sign in signed_atoms(formula)]
    assert list(signed_atoms(formula, False)) == turned == list(signed_atoms(Not(formula)))
    assert list(atoms(formula)) == [atom for atom, _ in turned]


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (A, "a"),
        (Not(A), ""),
        (And((A, Not(B), C)), "a c"),
        (And((And((A, B)), Exists(X, And((C, Or((A, B))))))), "a b c"),
        (Or((A, B)), ""),
        (Or((A,)), ""),
        (Forall(X, A), ""),
        (Exists(X, Forall(X, A)), ""),
    ],
)
def test_only_conjuncts_are_necessary(formula: Formula, expected: str) -> None:
    assert " ".join(atom.predicate for atom in necessary_atoms(formula)) == expected
