"""Typed lists: `?a ?b - body ?c - (either pose grasp)`.

As Fast Downward reads them: no names before a type are an empty list, and where names are mere
placeholders, in declarations, one may stand twice.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from tamp.symbolic.pddl.nodes import Node, Symbol, as_symbol, as_variable, error, show
from tamp.symbolic.pddl.structs import Parameter


@dataclass(frozen=True, slots=True)
class Typed:
    """A name in a typed list and the types written behind it, none when it is untyped."""

    name: Symbol
    types: tuple[Symbol, ...]


def typed_list(nodes: Sequence[Node], what: str) -> list[Typed]:
    """Read a typed list. `what` says what the names are: "a type"."""
    result: list[Typed] = []
    waiting: list[Symbol] = []
    position = 0
    while position < len(nodes):
        symbol = as_symbol(nodes[position], what)
        position += 1
        if symbol.text != "-":
            waiting.append(symbol)
            continue
        if position == len(nodes):
            raise error(symbol, "expected a type after '-', found the end of the list")
        types = _types(nodes[position])
        position += 1
        result += [Typed(name, types) for name in waiting]
        waiting = []
    return result + [Typed(name, ()) for name in waiting]


def parameters(nodes: Sequence[Node], types: Mapping[str, str]) -> tuple[Parameter, ...]:
    """Read a typed list of variables, every type known; a variable may stand twice."""
    entries = typed_list(nodes, "a variable such as ?x")
    for entry in entries:
        as_variable(entry.name)
    return tuple(
        Parameter(entry.name.text, declared_types(entry.types, types) or ("object",))
        for entry in entries
    )


def placeholders(nodes: Sequence[Node], types: Mapping[str, str]) -> tuple[Parameter, ...]:
    """Read the parameters of a declaration, whose names mean nothing: one that stands twice is two
    parameters.
    """
    return distinct(parameters(nodes, types))


def distinct(listed: Sequence[Parameter], taken: Collection[str] = ()) -> tuple[Parameter, ...]:
    """Put a number behind each parameter's name that is taken or has stood before: ?x ?x~2 ?x~3."""
    used, numbers = set(taken), dict[str, int]()
    result: list[Parameter] = []
    for parameter in listed:
        name = parameter.name
        while name in used:
            numbers[parameter.name] = numbers.get(parameter.name, 1) + 1
            name = f"{parameter.name}~{numbers[parameter.name]}"
        used.add(name)
        result.append(replace(parameter, name=name))
    return tuple(result)


def declared_types(written: Iterable[Symbol], types: Mapping[str, str]) -> tuple[str, ...]:
    """Return the types' names, each checked to be declared."""
    written = tuple(written)
    for symbol in written:
        if symbol.text not in types:
            raise error(
                symbol, f"unknown type '{symbol.written}'", found=symbol.text, choices=types
            )
    return tuple(dict.fromkeys(symbol.text for symbol in written))


def refuse_duplicates(names: Iterable[Symbol], what: str) -> None:
    """Raise an InputError at the second of two equal names."""
    seen: dict[str, Symbol] = {}
    for name in names:
        if name.text in seen:
            raise error(
                name,
                f"{what} '{name.written}' stands twice; first in line {seen[name.text].place.line}",
            )
        seen[name.text] = name


def _types(node: Node) -> tuple[Symbol, ...]:
    if isinstance(node, Symbol):
        return (node,)
    if node.head != "either" or len(node.items) < 2:
        raise error(node, f"expected a type or (either type ...), found {show(node)}")
    return tuple(as_symbol(item, "a type") for item in node.items[1:])
