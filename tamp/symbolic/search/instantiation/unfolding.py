"""Select the derived predicates whose rule is unfolded (inlined) into the conditions that use it.

After the idea of magic sets (Bancilhon, Maier, Sagiv, Ullman, 1986): a rule is asked only for the
bindings that its caller has.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tamp.symbolic.pddl.structs import And, Atom, Derived, Domain, Exists, Forall, Formula, Not, Or


def unfoldable(domain: Domain, given: frozenset[str]) -> list[Derived]:
    """Select the rules whose head binds a variable that no positive atom of the body does.

    Instantiated by itself such a rule ranges over all objects for that variable (`free(?x)` as `not
    exists ...`); put in the place of its head, it ranges over what the condition around it binds.
    Only rules that say all of their predicate will do: one rule each, not recursive, without facts
    `given` besides.
    """
    rules: dict[str, list[Derived]] = {}
    for rule in domain.derived:
        rules.setdefault(rule.head.predicate, []).append(rule)

    below = {
        name: {a for rule in those for a in _predicates(rule.body)} for name, those in rules.items()
    }
    chosen: list[Derived] = []
    for name, (rule, *others) in rules.items():
        terms = rule.head.terms
        plain = len(set(terms)) == len(terms) and {p.name for p in rule.parameters} == set(terms)
        if others or not plain or name in given or name in _reached(below, name):
            continue
        if not bound_variables(rule.body, True).issuperset(terms):
            chosen.append(rule)
    return chosen


def bound_variables(formula: Formula, sign: bool) -> frozenset[str]:
    """Return the free variables that have a value wherever the formula (or its negation) holds:
    a positive atom names them.
    """
    match formula:
        case Atom():
            named = sign and formula.predicate != "="
            return (
                frozenset(term for term in formula.terms if term.startswith("?"))
                if named
                else frozenset()
            )
        case Not():
            return bound_variables(formula.body, not sign)
        case And() | Or():
            parts = [bound_variables(part, sign) for part in formula.parts]
            if isinstance(formula, And) is sign:
                return frozenset[str]().union(*parts)
            # A disjunction binds what all of its parts do.
            shared = set(parts[0]) if parts else set[str]()
            for part in parts:
                shared &= part
            return frozenset(shared)
        case Exists() | Forall():
            if isinstance(formula, Exists) is not sign:
                return frozenset()
            return bound_variables(formula.body, sign) - {
                parameter.name for parameter in formula.parameters
            }


def _predicates(formula: Formula) -> Iterator[str]:
    match formula:
        case Atom():
            yield formula.predicate
        case Not() | Exists() | Forall():
            yield from _predicates(formula.body)
        case And() | Or():
            for part in formula.parts:
                yield from _predicates(part)


def _reached(below: Mapping[str, set[str]], name: str) -> set[str]:
    """Return the predicates that the rules of one lead to, itself if they come back to it."""
    seen: set[str] = set()
    stack = list(below[name])
    while stack:
        at = stack.pop()
        if at not in seen:
            seen.add(at)
            stack.extend(below.get(at, ()))
    return seen
