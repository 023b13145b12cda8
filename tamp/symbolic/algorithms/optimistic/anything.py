"""Of which types a task asks for anything at all: a variable of which no condition says what has to hold of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Formula, Not, Or, Parameter, Task

Types = tuple[str, ...]


def anything(task: Task) -> set[Types]:
    """The types of parameters and quantified variables that some disjunct of their condition names in no fact.

    Any object of such a type will do, so every stream that gives one is of use, whatever it certifies.
    """
    domain = task.domain
    found = set(_unnamed((), task.goal))
    for action in domain.actions:
        found.update(_unnamed(action.parameters, action.precondition))
    for rule in domain.derived:
        heads = [one for one in rule.parameters if one.name in rule.head.terms]
        found.update(_unnamed(heads, rule.body))
    return found


def distinguishes(task: Task) -> bool:
    """Whether a condition wants two things to differ."""
    domain = task.domain
    conditions = [task.goal, *(rule.body for rule in domain.derived)]
    conditions += [action.precondition for action in domain.actions]
    conditions += [effect.condition for action in domain.actions for effect in action.effects]
    return any(_differs(condition) for condition in conditions)


def _differs(formula: Formula) -> bool:
    match formula:
        case Atom():
            return False
        case Not(body):
            return (isinstance(body, Atom) and body.predicate == "=") or _differs(body)
        case And(parts) | Or(parts):
            return any(_differs(part) for part in parts)
        case Exists(_, body) | Forall(_, body):
            return _differs(body)


def _unnamed(parameters: Iterable[Parameter], condition: Formula) -> Iterator[Types]:
    named = _named(condition, True)
    yield from (one.types for one in parameters if one.name not in named)
    yield from _inside(condition, True)


def _inside(formula: Formula, sign: bool) -> Iterator[Types]:
    """Those of the variables that are quantified existentially within."""
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
    """The terms that a fact which has to hold names, whichever disjunct it is that holds."""
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
