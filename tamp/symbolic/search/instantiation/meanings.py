"""Meanings of formulas, for people: in PDDL on one line, and the terms that they speak of."""

from __future__ import annotations

from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.structs import And, Atom, Exists, Formula, Not, Or
from tamp.symbolic.search.operators import Meaning


def meaning_of(formula: Formula) -> Meaning:
    """Show a formula, and list its atoms' terms from left to right, repeated ones too."""
    return Meaning(show(formula), tuple(term for atom in atoms(formula) for term in atom.terms))


def show(formula: Formula) -> str:
    """Show a formula in PDDL, on one line."""
    if isinstance(formula, Atom):
        return f"({' '.join((formula.predicate, *(t.split(' ')[0] for t in formula.terms)))})"
    if isinstance(formula, Not):
        return f"(not {show(formula.body)})"
    if isinstance(formula, And | Or):
        connective = "and" if isinstance(formula, And) else "or"
        return f"({' '.join((connective, *map(show, formula.parts)))})"
    word = "exists" if isinstance(formula, Exists) else "forall"
    variables = " ".join(p.name.split(" ")[0] for p in formula.parameters)
    return f"({word} ({variables}) {show(formula.body)})"
