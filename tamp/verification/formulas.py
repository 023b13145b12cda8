"""Formulas of PDDL: substitute, take apart, unify."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tamp.symbolic.pddl.structs import And, Atom, Fact, Formula, Not, Or

Binding = dict[str, str]
"""What variables stand for."""


def substitute(formula: Formula, binding: Mapping[str, str]) -> Formula:
    """Substitute objects for a formula's bound variables."""
    if isinstance(formula, Atom):
        return Atom(formula.predicate, tuple(binding.get(term, term) for term in formula.terms))
    if isinstance(formula, Not):
        return Not(substitute(formula.body, binding))
    if isinstance(formula, And | Or):
        return type(formula)(tuple(substitute(part, binding) for part in formula.parts))
    inner = {p.name for p in formula.parameters}
    return type(formula)(
        formula.parameters,
        substitute(formula.body, {k: v for k, v in binding.items() if k not in inner}),
    )


def flat(formula: Formula) -> list[Formula]:
    """List the parts of a conjunction, nested ones taken apart."""
    if isinstance(formula, And):
        return [part for one in formula.parts for part in flat(one)]
    return [formula]


def free(formula: Formula) -> set[str]:
    """Return a formula's free variables."""
    if isinstance(formula, Atom):
        return {term for term in formula.terms if term.startswith("?")}
    if isinstance(formula, Not):
        return free(formula.body)
    if isinstance(formula, And | Or):
        return {name for part in formula.parts for name in free(part)}
    return free(formula.body) - {p.name for p in formula.parameters}


def facts(formula: Formula) -> set[Fact]:
    """Return the facts without variables that it speaks of."""
    if isinstance(formula, Atom):
        return {(formula.predicate, *formula.terms)} if not free(formula) else set()
    if isinstance(formula, And | Or):
        return {fact for part in formula.parts for fact in facts(part)}
    return facts(formula.body)


def predicates(formula: Formula) -> set[str]:
    """Return the predicates that it asks for."""
    if isinstance(formula, Atom):
        return {formula.predicate}
    if isinstance(formula, And | Or):
        return {name for part in formula.parts for name in predicates(part)}
    return predicates(formula.body)


def ground(atom: Atom, binding: Mapping[str, str]) -> Fact:
    """Ground an atom: the fact that it is under a binding of its variables."""
    return (atom.predicate, *(binding.get(term, term) for term in atom.terms))


def unify(terms: Sequence[str], row: Sequence[str], binding: Mapping[str, str]) -> Binding | None:
    """Unify terms with a row: extend the binding so that they agree; None when it cannot."""
    extended = dict(binding)
    if len(terms) != len(row):
        return None
    for term, value in zip(terms, row, strict=True):
        if term.startswith("?"):
            if extended.setdefault(term, value) != value:
                return None
        elif term != value:
            return None
    return extended
