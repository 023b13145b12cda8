"""Formulas and facts as PDDL text, for messages and plan files."""

from __future__ import annotations

from collections.abc import Sequence

from tamp.symbolic.pddl.structs import And, Atom, Exists, Fact, Forall, Formula, Not, Or, Parameter


def to_text(item: Formula | Fact) -> str:
    """Format as PDDL text on one line; parsing it gives the formula again.

    A variable is shown up to a blank in its name: what comes behind tells those of one name apart.
    """
    match item:
        case Atom(predicate, terms):
            return _group(predicate, *map(_shown, terms))
        case Not(body):
            return _group("not", to_text(body))
        case And(parts):
            return _group("and", *map(to_text, parts))
        case Or(parts):
            return _group("or", *map(to_text, parts))
        case Exists(parameters, body):
            return _group("exists", _parameters(parameters), to_text(body))
        case Forall(parameters, body):
            return _group("forall", _parameters(parameters), to_text(body))
        case _:
            return _group(*item)


def _parameters(parameters: Sequence[Parameter]) -> str:
    # An untyped variable before a typed one would take its type, so all types are written out, or
    # none.
    if all(parameter.types == ("object",) for parameter in parameters):
        return _group(*(_shown(parameter.name) for parameter in parameters))
    return _group(
        *(f"{_shown(parameter.name)} - {_types(parameter.types)}" for parameter in parameters)
    )


def _shown(name: str) -> str:
    return name.partition(" ")[0]


def _types(types: tuple[str, ...]) -> str:
    return types[0] if len(types) == 1 else _group("either", *types)


def _group(*words: str) -> str:
    return f"({' '.join(words)})"
