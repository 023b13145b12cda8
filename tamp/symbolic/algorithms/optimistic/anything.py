"""Types of which a task asks for anything at all: its conditions say nothing of such a variable."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Formula, Not, Or, Parameter, Task

Types = tuple[str, ...]


def anything(task: Task) -> set[Types]:
    """Return the types of variables that some disjunct of their condition names in no fact.

    Any object of such a type will do, so every stream that gives one is of use, whatever it
    certifies.
    """
    domain = task.domain
    found = set(_unnamed((), task.goal))
    for action in domain.actions:
        found.update(_unnamed(action.parameters, action.precondition))
    for rule in domain.derived:
        heads = [one for one in rule.parameters if one.name in rule.head.terms]
        found.update(_unnamed(heads, rule.body))
    return found


def distinguishes(task: Task, kinds: Iterable[Types] | None = None) -> bool:
    """Check that a condition wants two things to differ.

    Args:
        task: Gives the conditions.
        kinds: The types of the things that matter; by default all do.
    """
    domain = task.domain
    conditions: list[tuple[tuple[Parameter, ...], Formula]] = [((), task.goal)]
    conditions += [(rule.parameters, rule.body) for rule in domain.derived]
    for action in domain.actions:
        conditions.append((action.parameters, action.precondition))
        conditions += [
            ((*action.parameters, *effect.parameters), effect.condition)
            for effect in action.effects
        ]

    own = None if kinds is None else list(kinds)

    def matters(types: Types) -> bool:
        return own is None or any(domain.fits(kind, types) for kind in own)

    return any(
        matters(types)
        for parameters, one in conditions
        for types in _differing(one, True, parameters)
    )


def _differing(formula: Formula, sign: bool, scope: tuple[Parameter, ...]) -> Iterator[Types]:
    """Yield the types of the variables that are to differ from something."""
    match formula:
        case Atom(predicate, terms):
            if predicate == "=" and not sign:
                yield from (one.types for one in scope if one.name in terms)
        case Not(body):
            yield from _differing(body, not sign, scope)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _differing(part, sign, scope)
        case Exists(parameters, body) | Forall(parameters, body):
            yield from _differing(body, sign, (*scope, *parameters))


def _unnamed(parameters: Iterable[Parameter], condition: Formula) -> Iterator[Types]:
    named = _named(condition, True)
    yield from (one.types for one in parameters if one.name not in named)
    yield from _inside(condition, True)


def _inside(formula: Formula, sign: bool) -> Iterator[Types]:
    """Yield the types of those variables that are quantified existentially within."""
    match formula:
        case Atom():
            return
        case Not(body):
            yield from _inside(body, not sign)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _inside(part, sign)
        case Exists(parameters, body) | Forall(parameters, body):
            if isinstance(formula, Exists) is sign:
                named = _named(body, sign)
                yield from (one.types for one in parameters if one.name not in named)
            yield from _inside(body, sign)


def _named(formula: Formula, sign: bool) -> frozenset[str]:
    """Return the terms that a fact which has to hold names, whichever disjunct holds."""
    match formula:
        case Atom(predicate, terms):
            return frozenset(terms) if sign and predicate != "=" else frozenset()
        case Not(body):
            return _named(body, not sign)
        case And(parts) | Or(parts):
            sets = [_named(part, sign) for part in parts]
            if isinstance(formula, And) is sign:
                return frozenset[str]().union(*sets)
            return sets[0].intersection(*sets[1:]) if sets else frozenset()
        case Exists(parameters, body) | Forall(parameters, body):
            return _named(body, sign) - {one.name for one in parameters}
