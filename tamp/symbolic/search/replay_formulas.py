"""Formulas as plan replay reads them: grounded, taken apart into atoms, and in words.

It shares no code with instantiation and search, so that a fault there is not repeated here.
"""

from __future__ import annotations

from collections.abc import Mapping

from tamp.symbolic.pddl.structs import And, Atom, Exists, Fact, Forall, Formula, Not, Or

Binding = Mapping[str, str]


def substituted(atom: Atom, binding: Binding) -> Fact:
    """Return the fact of an atom under a binding."""
    return (atom.predicate, *(binding.get(term, term) for term in atom.terms))


def conjunct_atoms(formula: Formula) -> tuple[Atom, ...]:
    """Return the atoms that hold where a conjunction does."""
    if isinstance(formula, Atom):
        return (formula,)
    return (
        tuple(part for part in formula.parts if isinstance(part, Atom))
        if isinstance(formula, And)
        else ()
    )


def guard_atoms(formula: Formula) -> tuple[Atom, ...]:
    """Return the atoms that hold where a disjunction may fail."""
    if isinstance(formula, Not):
        return conjunct_atoms(formula.body)
    if isinstance(formula, Or):
        return tuple(
            atom
            for part in formula.parts
            if isinstance(part, Not)
            for atom in conjunct_atoms(part.body)
        )
    return ()


def formula_words(formula: Formula, binding: Binding) -> str:
    """Write a formula under a binding as PDDL."""
    match formula:
        case Atom():
            return f"({' '.join(substituted(formula, binding))})"
        case Not(body):
            return f"(not {formula_words(body, binding)})"
        case And(parts) | Or(parts):
            head = "and" if isinstance(formula, And) else "or"
            return f"({' '.join((head, *(formula_words(part, binding) for part in parts)))})"
        case Exists(parameters, body) | Forall(parameters, body):
            head = "exists" if isinstance(formula, Exists) else "forall"
            names = [parameter.name for parameter in parameters]
            free = {name: word for name, word in binding.items() if name not in names}
            return f"({head} ({' '.join(names)}) {formula_words(body, free)})"
