"""Walks over formulas for their atoms: all of them with their signs, or those that must hold."""

from __future__ import annotations

from collections.abc import Iterator

from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Formula, Not, Or


def signed_atoms(formula: Formula, sign: bool = True) -> Iterator[tuple[Atom, bool]]:
    """Generate the atoms of a formula from left to right, each with whether it helps by holding.

    Args:
        formula: Any formula.
        sign: Whether the formula is needed to hold; each negation turns it round.
    """
    match formula:
        case Atom():
            yield formula, sign
        case Not(body):
            yield from signed_atoms(body, not sign)
        case And(parts) | Or(parts):
            for part in parts:
                yield from signed_atoms(part, sign)
        case Exists(_, body) | Forall(_, body):
            yield from signed_atoms(body, sign)


def atoms(formula: Formula) -> Iterator[Atom]:
    """Generate the atoms of a formula from left to right, whatever stands around them."""
    return (atom for atom, _ in signed_atoms(formula))


def necessary_atoms(formula: Formula) -> tuple[Atom, ...]:
    """List the atoms that must hold for a formula to hold, as far as they are plain.

    Those are its conjuncts, also under an existential quantifier.
    """
    match formula:
        case Atom():
            return (formula,)
        case And(parts):
            return tuple(atom for part in parts for atom in necessary_atoms(part))
        case Exists(_, body):
            return necessary_atoms(body)
        case _:
            return ()
