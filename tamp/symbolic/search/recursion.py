"""Recursive derived predicates: those that rest on themselves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from tamp.symbolic.pddl.structs import And, Atom, Derived, Exists, Forall, Formula, Not, Or


def strata_of(rules: Mapping[str, Sequence[Derived]]) -> tuple[dict[str, frozenset[str]], set[str]]:
    """Return for each derived predicate those of its stratum; and which rest on themselves."""
    below = {
        name: {p for rule in those for p in _used(rule.body) if p in rules}
        for name, those in rules.items()
    }
    reached: dict[str, set[str]] = {}
    for name in below:
        seen: set[str] = set()
        stack = list(below[name])
        while stack:
            at = stack.pop()
            if at not in seen:
                seen.add(at)
                stack.extend(below[at])
        reached[name] = seen
    kinds = {
        name: frozenset((name, *(other for other in reached[name] if name in reached[other])))
        for name in below
    }
    return kinds, {name for name in below if name in reached[name]}


def _used(formula: Formula) -> Iterator[str]:
    match formula:
        case Atom(predicate):
            yield predicate
        case And(parts) | Or(parts):
            for part in parts:
                yield from _used(part)
        case Not(body) | Exists(_, body) | Forall(_, body):
            yield from _used(body)
