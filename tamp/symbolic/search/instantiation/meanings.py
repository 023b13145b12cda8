"""Meanings of formulas, for people: in PDDL on one line, and the terms that they speak of."""

from __future__ import annotations

from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.structs import Formula
from tamp.symbolic.search.operators import Meaning


def meaning_of(formula: Formula) -> Meaning:
    """Show a formula, and list its atoms' terms from left to right, repeated ones too."""
    return Meaning(to_text(formula), tuple(term for atom in atoms(formula) for term in atom.terms))
