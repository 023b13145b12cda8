"""The sections of a domain that declare names: types, constants, predicates, functions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from tamp.errors import closest
from tamp.symbolic.pddl.features import lacking
from tamp.symbolic.pddl.formulas import RESERVED
from tamp.symbolic.pddl.nodes import (
    Group,
    Node,
    Symbol,
    as_group,
    as_name,
    as_symbol,
    error,
    warning,
)
from tamp.symbolic.pddl.structs import Parameter, Predicate
from tamp.symbolic.pddl.typed import declared_types, placeholders, typed_list

REQUIREMENTS = (
    ":strips", ":typing", ":negative-preconditions", ":disjunctive-preconditions", ":equality",
    ":existential-preconditions", ":universal-preconditions", ":quantified-preconditions",
    ":conditional-effects", ":fluents", ":numeric-fluents", ":object-fluents", ":adl",
    ":durative-actions", ":duration-inequalities", ":continuous-effects", ":derived-predicates",
    ":domain-axioms", ":timed-initial-literals", ":preferences", ":constraints",
    ":action-costs", ":goal-utilities",
)  # fmt: skip

MAX_TYPE_DEPTH = 200
"""Types above a type; an object is an instance of all of them, so a chain of thousands takes
gigabytes.
"""


def check_requirements(nodes: Sequence[Node]) -> tuple[str, ...]:
    """Warn of words that are no requirement of any PDDL. What is used is checked where it is
    used.
    """
    notes: list[str] = []
    for node in nodes:
        symbol = as_symbol(node, "a requirement such as :typing")
        if symbol.text not in REQUIREMENTS:
            near = closest(symbol.text, REQUIREMENTS)
            meant = f". Did you mean '{near}'?" if near else ""
            notes.append(warning(symbol, f"unknown requirement '{symbol.written}'{meant}"))
    return tuple(notes)


@dataclass(frozen=True)
class Types:
    """The declared types: each one's parent, its further parents, and oddities that are no
    errors.
    """

    parents: dict[str, str]
    more_parents: dict[str, tuple[str, ...]]
    notes: tuple[str, ...]


def parse_types(nodes: Sequence[Node]) -> Types:
    """Read `:types`. A type may be listed twice, with a parent each, and a parent not at all, as in
    competitions.
    """
    entries = typed_list(nodes, "a type")
    parents: dict[str, tuple[str, ...]] = {}
    for entry in entries:
        name = as_name(entry.name, "a type").text
        above = tuple(symbol.text for symbol in entry.types)
        parents[name] = tuple(dict.fromkeys((*parents.get(name, ()), *above)))
        if name == "object" and parents[name] not in ((), ("object",)):
            raise error(
                entry.name, "'object' is the root of all types, it cannot stand below another one"
            )
        if name != "object":
            parents[name] = tuple(
                parent for parent in parents[name] if parent != name
            )  # - itself: says nothing

    parents.setdefault("object", ())
    notes: list[str] = []
    for symbol in (symbol for entry in entries for symbol in entry.types):
        if symbol.text not in parents:
            near = closest(symbol.text, sorted(parents.keys() - {"object"}))
            meant = f". Did you mean '{near}'?" if near else ""
            notes.append(
                warning(
                    symbol, f"type '{symbol.written}' is not listed itself, only as a parent{meant}"
                )
            )
            parents[as_name(symbol, "a type").text] = ()

    _check_depth({entry.name.text: entry.name for entry in entries}, parents)
    full = {
        name: tuple(t for t in above if t != "object") or ("object",)
        for name, above in parents.items()
    }
    first = {"object": "object", **{name: above[0] for name, above in full.items()}}
    return Types(
        first, {name: above[1:] for name, above in full.items() if len(above) > 1}, tuple(notes)
    )


def parse_objects(
    nodes: Sequence[Node],
    types: Mapping[str, str],
    what: str,
    notes: list[str],
    constants: Mapping[str, tuple[str, ...]] | None = None,
) -> dict[str, tuple[str, ...]]:
    """Read `:constants` or `:objects`: names with their types; one behind `(either ...)` has all of
    them.

    Args:
        nodes: The typed list.
        types: The declared ones.
        what: What the names are: "an object".
        notes: Gets a line for each name that is said again with the same types.
        constants: Those of the domain, of which a problem may say one again.

    Raises:
        InputError: A name stands twice with different types, or a type is not known.
    """
    kind = what.removeprefix("an ").removeprefix("a ")
    found: dict[str, tuple[str, ...]] = {}
    lines: dict[str, int] = {}
    for entry in typed_list(nodes, what):
        name = as_name(entry.name, what)
        own = declared_types(entry.types, types) or ("object",)
        before = found.get(name.text) or (constants or {}).get(name.text)
        if before is None:
            found[name.text], lines[name.text] = own, name.place.line
            continue
        message = f"{kind} '{name.written}' is already a constant of the domain"
        if name.text in lines:
            message = f"{kind} '{name.written}' stands twice; first in line {lines[name.text]}"
        if set(own) != set(before):
            raise error(
                name, f"{message}, of type {' and '.join(before)}, here {' and '.join(own)}"
            )
        notes.append(warning(name, message))
    return found


@dataclass(frozen=True)
class Signatures:
    """Declared predicates or functions by name, and oddities that are no errors."""

    by_name: dict[str, Predicate]
    notes: tuple[str, ...]


def parse_predicates(nodes: Sequence[Node], types: Mapping[str, str]) -> Signatures:
    """Read `:predicates`: `(name ?a - type ...)` each. The same declaration may stand twice."""
    groups = [as_group(node, "a predicate such as (on ?a ?b)") for node in nodes]
    return _signatures(groups, types, "predicate")


def parse_functions(nodes: Sequence[Node], types: Mapping[str, str]) -> Signatures:
    """Read `:functions`: like predicates, each group optionally followed by `- number`."""
    groups: list[Group] = []
    position = typed = 0
    while position < len(nodes):
        node = nodes[position]
        position += 1
        if isinstance(node, Group):
            groups.append(node)
            continue

        result = nodes[position] if position < len(nodes) else None
        if node.text != "-" or result is None:
            raise error(
                node, f"expected a function such as (distance ?a ?b), found '{node.written}'"
            )
        symbol = as_symbol(result, "the type 'number'")
        if typed == len(groups):  # an empty list before a type
            position += 1
            continue

        typed = len(groups)
        if symbol.text in types:
            raise error(
                symbol,
                lacking(f"- {symbol.written}", "object fluents, functions have numbers as values"),
            )
        if symbol.text != "number":
            raise error(
                symbol,
                f"functions have numbers as values, found '{symbol.written}'",
                choices=("number",),
            )
        position += 1
    return _signatures(groups, types, "function")


def _signatures(groups: Sequence[Group], types: Mapping[str, str], what: str) -> Signatures:
    for group in groups:
        if not group.items:
            raise error(group, f"expected a {what}, found '()'")
    names = [as_name(group.items[0], f"a {what}'s name") for group in groups]
    for name in names:
        if name.text in RESERVED:
            raise error(name, f"'{name.written}' is a word of PDDL and cannot name a {what}")
    found: dict[str, Predicate] = {}
    notes: list[str] = []

    for name, group in zip(names, groups, strict=True):
        declared = Predicate(name.text, placeholders(group.items[1:], types), group.place)
        before = found.setdefault(name.text, declared)
        if before is declared:
            continue
        line = before.place.line if before.place else 0
        first = f"{what} '{name.written}' stands twice; first in line {line}"
        if len(before.parameters) != len(declared.parameters):
            sizes = f"{len(before.parameters)} and {len(declared.parameters)}"
            raise error(name, f"{first}, with other arguments ({sizes})")
        notes.append(warning(name, first))
        found[name.text] = replace(
            before, parameters=tuple(map(_either, before.parameters, declared.parameters))
        )

    return Signatures(found, tuple(notes))


def _either(first: Parameter, second: Parameter) -> Parameter:
    """Join two declarations of a parameter: it takes what either of them says."""
    return replace(first, types=tuple(dict.fromkeys((*first.types, *second.types))))


def _check_depth(names: Mapping[str, Symbol], parents: Mapping[str, tuple[str, ...]]) -> None:
    """Refuse types in a cycle, and a chain of more than MAX_TYPE_DEPTH of them."""
    heights: dict[str, int] = {"object": 0}
    order = {name: number for number, name in enumerate(names)}
    for start in names:
        way: list[str] = [start]  # from the start up to the type at hand, all with unknown heights
        on_way = {start}
        while way:
            name = way[-1]
            above = parents.get(name, ())
            waiting = next((parent for parent in above if parent not in heights), None)
            if waiting is None:
                heights[name] = 1 + max((heights[parent] for parent in above), default=0)
                if heights[name] > MAX_TYPE_DEPTH:
                    raise error(
                        names[start],
                        f"type '{names[start].written}' stands below {MAX_TYPE_DEPTH} others",
                    )
                on_way.discard(way.pop())
            elif waiting in on_way:
                cycle = way[way.index(waiting) :]
                first = min(range(len(cycle)), key=lambda index: order[cycle[index]])
                cycle = [*cycle[first:], *cycle[: first + 1]]
                shown = " - ".join(cycle if len(cycle) < 10 else (*cycle[:5], "...", *cycle[-4:]))
                raise error(names[cycle[0]], f"types form a cycle: {shown}")
            else:
                way.append(waiting)
                on_way.add(waiting)
