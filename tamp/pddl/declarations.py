"""The sections of a domain that declare names: types, constants, predicates, functions."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass

from tamp.errors import closest
from tamp.pddl.formulas import RESERVED
from tamp.pddl.nodes import Group, Node, as_group, as_name, as_symbol, error, warning
from tamp.pddl.structs import Predicate
from tamp.pddl.typed import known_types, parameters, refuse_duplicates, typed_list

REQUIREMENTS = (
    ":strips", ":typing", ":negative-preconditions", ":disjunctive-preconditions", ":equality",
    ":existential-preconditions", ":universal-preconditions", ":quantified-preconditions", ":conditional-effects",
    ":fluents", ":numeric-fluents", ":object-fluents", ":adl", ":durative-actions", ":duration-inequalities",
    ":continuous-effects", ":derived-predicates", ":domain-axioms", ":timed-initial-literals", ":preferences",
    ":constraints", ":action-costs", ":goal-utilities",
)  # fmt: skip


def check_requirements(nodes: Sequence[Node]) -> None:
    """Refuse words that are no requirement of any PDDL. What is used is checked where it is used."""
    for node in nodes:
        symbol = as_symbol(node, "a requirement such as :typing")
        if symbol.text not in REQUIREMENTS:
            raise error(symbol, f"unknown requirement '{symbol.written}'", found=symbol.text, choices=REQUIREMENTS)


@dataclass(frozen=True)
class Types:
    """The declared types: each one's parent, its further parents, and oddities that are no errors."""

    parents: dict[str, str]
    more_parents: dict[str, tuple[str, ...]]
    notes: tuple[str, ...]


def parse_types(nodes: Sequence[Node]) -> Types:
    """Read `:types`. A type may be listed twice, with a parent each, and a parent not at all, as in competitions."""
    entries = typed_list(nodes, "a type")
    parents: dict[str, tuple[str, ...]] = {}
    for entry in entries:
        name = as_name(entry.name, "a type").text
        above = tuple(symbol.text for symbol in entry.types)
        parents[name] = tuple(dict.fromkeys((*parents.get(name, ()), *above)))
        if name == "object" and parents[name] not in ((), ("object",)):
            raise error(entry.name, "'object' is the root of all types, it cannot stand below another one")
    parents.setdefault("object", ())
    notes: list[str] = []
    for symbol in (symbol for entry in entries for symbol in entry.types):
        if symbol.text not in parents:
            near = closest(symbol.text, sorted(parents.keys() - {"object"}))
            meant = f". Did you mean '{near}'?" if near else ""
            notes.append(warning(symbol, f"type '{symbol.written}' is not listed itself, only as a parent{meant}"))
            parents[as_name(symbol, "a type").text] = ()
    for entry in entries:
        cycle = _cycle(entry.name.text, parents)
        if cycle and entry.name.text != "object":
            raise error(entry.name, f"types form a cycle: {' - '.join(cycle)}")
    full = {name: tuple(t for t in above if t != "object") or ("object",) for name, above in parents.items()}
    first = {"object": "object", **{name: above[0] for name, above in full.items()}}
    return Types(first, {name: above[1:] for name, above in full.items() if len(above) > 1}, tuple(notes))


def parse_objects(
    nodes: Sequence[Node], types: Mapping[str, str], what: str, constants: Container[str] = ()
) -> dict[str, tuple[str, ...]]:
    """Read `:constants` or `:objects`: names with their types; one behind `(either ...)` has all of them."""
    entries = typed_list(nodes, what)
    for entry in entries:
        as_name(entry.name, what)
        if entry.name.text in constants:
            raise error(entry.name, f"object '{entry.name.written}' is already a constant of the domain")
    refuse_duplicates((entry.name for entry in entries), what.removeprefix("an ").removeprefix("a "))
    return {entry.name.text: known_types(entry.types, types) or ("object",) for entry in entries}


def parse_predicates(nodes: Sequence[Node], types: Mapping[str, str]) -> dict[str, Predicate]:
    """Read `:predicates`: `(name ?a - type ...)` each."""
    groups = [as_group(node, "a predicate such as (on ?a ?b)") for node in nodes]
    return _signatures(groups, types, "predicate")


def parse_functions(nodes: Sequence[Node], types: Mapping[str, str]) -> dict[str, Predicate]:
    """Read `:functions`: like predicates, each group optionally followed by `- number`."""
    groups: list[Group] = []
    position = 0
    while position < len(nodes):
        node = nodes[position]
        position += 1
        if isinstance(node, Group):
            groups.append(node)
            continue
        result = nodes[position] if position < len(nodes) else None
        if node.text != "-" or not groups or result is None:
            raise error(node, f"expected a function such as (distance ?a ?b), found '{node.written}'")
        symbol = as_symbol(result, "the type 'number'")
        if symbol.text != "number":
            raise error(symbol, f"functions have numbers as values, found '{symbol.written}'", choices=("number",))
        position += 1
    return _signatures(groups, types, "function")


def _signatures(groups: Sequence[Group], types: Mapping[str, str], what: str) -> dict[str, Predicate]:
    for group in groups:
        if not group.items:
            raise error(group, f"expected a {what}, found '()'")
    names = [as_name(group.items[0], f"a {what}'s name") for group in groups]
    for name in names:
        if name.text in RESERVED:
            raise error(name, f"'{name.written}' is a word of PDDL and cannot name a {what}")
    refuse_duplicates(names, what)
    return {
        name.text: Predicate(name.text, parameters(group.items[1:], types), group.place)
        for name, group in zip(names, groups, strict=True)
    }


def _cycle(start: str, parents: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """A way up from a type back to itself, or nothing."""
    ways: list[tuple[str, ...]] = [(start,)]
    seen: set[str] = set()
    while ways:
        way = ways.pop()
        for parent in parents.get(way[-1], ()):
            if parent == start:
                return (*way, start)
            if parent not in seen:
                seen.add(parent)
                ways.append((*way, parent))
    return ()
