"""Rules of derived predicates: `(:derived (on ?o ?s) CONDITION)`, and the older `:axiom`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from tamp.symbolic.pddl.formulas import parse_formula, repeated, scope_of
from tamp.symbolic.pddl.nodes import Group, Node, as_group, as_symbol, error, show, warning
from tamp.symbolic.pddl.sections import Section, keyword_values
from tamp.symbolic.pddl.structs import And, Atom, Derived, Domain, Parameter, Predicate
from tamp.symbolic.pddl.typed import parameters, typed_list

AXIOM_KEYWORDS = (":parameters", ":context", ":implies")


def rule_head(section: Section, names: Domain) -> str:
    """Return the name of the predicate that a rule defines, checked to be declared."""
    head, _ = _parts(section)
    symbol = as_symbol(head.items[0], "a predicate") if head.items else None
    if symbol is None:
        raise error(head, "expected a fact such as (on ?a ?b), found '()'")
    if symbol.text not in names.predicates:
        choices = names.predicates
        raise error(
            symbol, f"unknown predicate '{symbol.written}'", found=symbol.text, choices=choices
        )
    return symbol.text


def redefinition(
    section: Section, predicates: Mapping[str, Predicate]
) -> Iterator[tuple[str, tuple[Predicate, str]]]:
    """Return the predicate as a rule's head has it, with a warning, where it is declared with
    another number of arguments.
    """
    head, _ = _parts(section)
    listed = [entry.name.text for entry in typed_list(head.items[1:], "a variable")]
    declared = predicates.get(head.head or "")
    if declared is not None and len(declared.parameters) != len(listed):
        note = warning(
            head,
            f"'{declared.name}' is declared with {len(declared.parameters)}, "
            f"defined with {len(listed)}",
        )
        yield (
            declared.name,
            (replace(declared, parameters=tuple(map(Parameter, listed))), f"{note} arguments"),
        )


def parse_rule(section: Section, names: Domain, notes: list[str] | None = None) -> Derived:
    """Read one rule. A variable without a type in the head has the type that the predicate declares
    for it.
    """
    head, body = _parts(section)
    predicate = names.predicates[rule_head(section, names)]
    listed = parameters(head.items[1:], names.types)
    if len(listed) != len(predicate.parameters):
        wanted = len(predicate.parameters)
        plural = "" if wanted == 1 else "s"
        message = f"'{predicate.name}' takes {wanted} argument{plural}, found {len(listed)}"
        form = " ".join((predicate.name, *(parameter.name for parameter in predicate.parameters)))
        raise error(head, message, remedy=f"Its form is ({form})")

    outer = _axiom_types(section, names)
    typed = {entry.name.text for entry in typed_list(head.items[1:], "a variable") if entry.types}
    own = tuple(
        parameter
        if parameter.name in typed
        else replace(parameter, types=outer.get(parameter.name, declared.types))
        for parameter, declared in zip(listed, predicate.parameters, strict=True)
    )
    scope, bound = scope_of(names, notes=notes).with_variables(own)
    atom = Atom(predicate.name, tuple(parameter.name for parameter in bound), head.place)
    formula, same = parse_formula(body, scope), repeated(own, bound)
    return Derived(atom, bound, And((formula, *same)) if same else formula, section.group.place)


def _parts(section: Section) -> tuple[Group, Node]:
    """Return the head and the body of a rule in any of its spellings."""
    keyword = section.keyword.text
    if keyword == ":axiom" and section.items and not isinstance(section.items[0], Group):
        values = keyword_values(section.items, "the axiom", AXIOM_KEYWORDS)
        for needed in (":context", ":implies"):
            if needed not in values:
                raise error(section.group, f"the axiom has no {needed}")
        return as_group(values[":implies"], "a fact such as (on ?a ?b)"), values[":context"]
    if len(section.items) != 2:
        found = len(section.items)
        raise error(
            section.group,
            f"'{keyword}' takes a fact and a condition, found {found} "
            f"part{'' if found == 1 else 's'}",
        )
    head = as_group(section.items[0], "a fact such as (on ?a ?b)")
    if head.head in ("and", "or", "not", "forall", "exists", "imply"):
        raise error(head, f"a rule defines one predicate, found {show(head)}")
    return head, section.items[1]


def _axiom_types(section: Section, names: Domain) -> dict[str, tuple[str, ...]]:
    """Read the types of the variables in an axiom's own `:parameters`."""
    if section.keyword.text != ":axiom" or not section.items or isinstance(section.items[0], Group):
        return {}
    values = keyword_values(section.items, "the axiom", AXIOM_KEYWORDS)
    node = values.get(":parameters")
    if node is None:
        return {}
    listed: tuple[Parameter, ...] = parameters(
        as_group(node, "a list of parameters").items, names.types
    )
    return {parameter.name: parameter.types for parameter in listed}
