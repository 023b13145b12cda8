"""Initial facts and goals as nested tuples of Python values, turned into PDDL."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from tamp.errors import InputError, closest
from tamp.symbolic.algorithms.bound_stream import value_key
from tamp.symbolic.pddl.formulas import CONNECTIVES
from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Domain,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
    Predicate,
)

_WORD = re.compile(r"[A-Za-z][\w-]*")


class Names:
    """Names for values: a constant's own, a word for a string that is one, else v1, v2, ...

    Args:
        constants: Name to value.
    """

    def __init__(self, constants: Mapping[str, Any]) -> None:
        self.values: dict[str, Any] = dict(constants)
        self._names = {value_key(value): name for name, value in constants.items()}

    def of(self, value: Any) -> str:
        """Return the value's name; the same one for equal values."""
        key = value_key(value)
        name = self._names.get(key)
        if name is None:
            name = (
                value
                if isinstance(value, str) and _WORD.fullmatch(value) and value not in self.values
                else ""
            )
            number = len(self.values)
            while not name or name in self.values:
                number += 1
                name = name if name and name not in self.values else f"v{number}"
            self._names[key] = name
            self.values[name] = value
        return name


class Initial(NamedTuple):
    """Initial facts, the costs given with "=", the types given as facts, and warnings of what
    nothing asks for.
    """

    facts: frozenset[Fact]
    costs: dict[Fact, float]
    types: dict[str, tuple[str, ...]]
    warnings: tuple[str, ...]


def initial_functions(init: Sequence[Any]) -> dict[str, Predicate]:
    """Declare the functions whose values are initial facts: PDDLStream's domains leave some
    undeclared.
    """
    functions: dict[str, Predicate] = {}
    for item in init:
        head, arguments = _parts(item, "an initial fact")
        if head == "=" and arguments:
            name, terms = _parts(arguments[0], "a function")
            functions[name] = Predicate(name, tuple(Parameter(f"?x{i}") for i in range(len(terms))))
    return functions


def initial_facts(init: Sequence[Any], domain: Domain, names: Names) -> Initial:
    """Parse the initial facts of a list of tuples.

    Raises:
        InputError: A predicate that looks misspelt, or the wrong number of arguments.
    """
    unused: dict[str, None] = {}
    facts: set[Fact] = set()
    costs: dict[Fact, float] = {}
    types: dict[str, tuple[str, ...]] = {}

    for item in init:
        head, arguments = _parts(item, "an initial fact")
        if head == "=":
            if len(arguments) != 2:
                raise InputError(f"expected ('=', (FUNCTION, ...), NUMBER), found {item!r}")
            function, terms = _parts(arguments[0], "a function")
            if _unknown(function, domain.functions):
                unused.setdefault(function)
                continue
            _check(function, len(terms), domain, domain.functions, "function", item)
            costs[function, *(names.of(term) for term in terms)] = float(arguments[1])
        elif head in domain.types and head not in domain.predicates:
            name = names.of(arguments[0])
            types[name] = (*types.get(name, ()), head)
        elif head in domain.derived_predicates:
            raise InputError(
                f"'{head}' is derived: its rules say where it holds, "
                f"{item!r} cannot be an initial fact"
            )
        elif _unknown(head, domain.predicates):
            unused.setdefault(head)
        else:
            _check(head, len(arguments), domain, domain.predicates, "predicate", item)
            facts.add((head, *(names.of(argument) for argument in arguments)))

    warnings = tuple(
        f"neither the domain nor a stream knows '{name}', of which there are initial facts"
        for name in unused
    )
    return Initial(frozenset(facts), costs, types, warnings)


def goal_formula(goal: Any, domain: Domain, names: Names) -> Formula:
    """Parse a goal given as nested tuples: ("and", ("In", "b0", "red"), ("not", ("AtConf", conf)),
    ("exists", ["?p"], ...)).

    Raises:
        InputError: An unknown predicate, the wrong number of arguments, an unbound variable.
    """
    return _formula(goal, domain, names, ())


def _formula(item: Any, domain: Domain, names: Names, bound: tuple[str, ...]) -> Formula:
    head, tail = _parts(item, "a condition")
    if head not in CONNECTIVES:
        if head != "=" and head not in domain.types:
            _check(head, len(tail), domain, domain.predicates, "predicate", item)
        return Atom(head, tuple(_term(term, names, bound) for term in tail))

    wanted = {"not": 1, "imply": 2, "exists": 2, "forall": 2}.get(head)
    if wanted is not None and len(tail) != wanted:
        raise InputError(
            f"'{head}' takes {wanted} part{'s' if wanted > 1 else ''}, found {len(tail)}: {item!r}"
        )

    if head in ("exists", "forall"):
        parameters = _parameters(tail[0], domain)
        inner = (*bound, *(parameter.name for parameter in parameters))
        body = _formula(tail[1], domain, names, inner)
        return Exists(parameters, body) if head == "exists" else Forall(parameters, body)

    parts = tuple(_formula(part, domain, names, bound) for part in tail)

    match head:
        case "and":
            return And(parts)
        case "or":
            return Or(parts)
        case "not":
            return Not(parts[0])
        case _:
            return Or((Not(parts[0]), parts[1]))


def _parameters(listed: Any, domain: Domain) -> tuple[Parameter, ...]:
    """Parse variables, as one string or a list, each group optionally followed by "-" and a
    type.
    """
    words = listed.split() if isinstance(listed, str) else [str(word) for word in listed]
    result: list[Parameter] = []
    waiting: list[str] = []
    while words:
        word = words.pop(0)
        if word != "-":
            if not word.startswith("?"):
                raise InputError(f"expected a variable such as ?x, found {word!r}")
            waiting.append(word)
            continue
        type_ = words.pop(0).lower() if words else ""
        if type_ not in domain.types:
            raise InputError(f"unknown type '{type_}'", found=type_, choices=domain.types)
        result += [Parameter(name, (type_,)) for name in waiting]
        waiting = []
    return (*result, *(Parameter(name) for name in waiting))


def _term(term: Any, names: Names, bound: tuple[str, ...]) -> str:
    if isinstance(term, str) and term.startswith("?"):
        if term not in bound:
            raise InputError(f"unknown variable '{term}'", found=term, choices=bound)
        return term
    return names.of(term)


def _parts(item: Any, what: str) -> tuple[str, tuple[Any, ...]]:
    if not isinstance(item, tuple | list) or not item or not isinstance(item[0], str):
        raise InputError(f"expected {what} such as ('On', 'mug', 'table'), found {item!r}")
    head, *tail = item
    return str(head).lower(), tuple(tail)


def _unknown(name: str, declared: Mapping[str, Any]) -> bool:
    """Check that it is none of them, nor looks like one of them misspelt."""
    return name not in declared and closest(name, declared) is None


def _check(
    name: str, count: int, domain: Domain, declared: Mapping[str, Any], what: str, item: Any
) -> None:
    if name not in declared:
        raise InputError(
            f"unknown {what} '{name}' in {item!r}", file=domain.file, found=name, choices=declared
        )
    wanted = len(declared[name].parameters)
    if wanted != count:
        raise InputError(
            f"'{name}' takes {wanted} argument{'' if wanted == 1 else 's'}, found {count}: {item!r}"
        )
