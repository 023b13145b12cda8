"""Domain files: text in, a checked Domain out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from pathlib import Path

from tamp.symbolic.pddl.declarations import (
    check_requirements,
    parse_functions,
    parse_objects,
    parse_predicates,
    parse_types,
)
from tamp.symbolic.pddl.effects import TOTAL_COST, Effects, parse_effects
from tamp.symbolic.pddl.formulas import parse_formula, repeated, scope_of
from tamp.symbolic.pddl.nodes import Group, Node, as_group, as_name, error, warning
from tamp.symbolic.pddl.rules import parse_rule, redefinition, rule_head
from tamp.symbolic.pddl.sections import Section, items_of, keyword_values, read_sections
from tamp.symbolic.pddl.stratification import strata
from tamp.symbolic.pddl.structs import Action, And, Domain, Place, Predicate
from tamp.symbolic.pddl.typed import parameters

SECTIONS = (
    ":requirements", ":types", ":constants", ":predicates", ":functions",
    ":action", ":derived", ":axiom",
)  # fmt: skip
ACTION_KEYWORDS = (":parameters", ":precondition", ":effect")


@dataclass(frozen=True)
class Undeclared:
    """Predicates and functions that may be used although the domain does not declare them.

    Attributes:
        predicates: By name.
        functions: By name.
        computed: Functions that a streams file computes: they have the arguments that it says.
    """

    predicates: Mapping[str, Predicate]
    functions: Mapping[str, Predicate]
    computed: Mapping[str, Predicate] = field(default_factory=dict[str, Predicate])


def parse_domain(
    text: str, file: str | Path | None = None, undeclared: Undeclared | None = None
) -> Domain:
    """Read a PDDL domain.

    Types, constants, predicates and functions are known everywhere, in whatever order the sections
    stand.

    Args:
        text: The domain.
        file: For messages: where the text comes from.
        undeclared: What else may be used. When it is given, a derived predicate has as many
            arguments as its rules say.

    Raises:
        InputError: With file, line and column of what is wrong.
    """
    title, sections = read_sections(text, "domain", SECTIONS, file)
    notes = list(check_requirements(items_of(sections, ":requirements")))
    declared = parse_types(items_of(sections, ":types"))
    types = declared.parents
    notes += declared.notes
    constants = parse_objects(items_of(sections, ":constants"), types, "a constant", notes)
    signatures = parse_predicates(items_of(sections, ":predicates"), types)
    functional = parse_functions(items_of(sections, ":functions"), types)
    predicates, functions = signatures.by_name, functional.by_name
    notes += (*signatures.notes, *functional.notes)
    if undeclared is not None:
        notes += _add_undeclared(undeclared, types, predicates, functions, title.place)
    for function in functions.values():
        if function.name in predicates and function.place:
            raise error(function.place, f"'{function.name}' is already a predicate")

    # Domains written for PDDLStream increase the total cost without declaring it.
    counts_costs = TOTAL_COST in functions or any(
        _mentions(section.group, "increase") for section in sections
    )
    functions.setdefault(TOTAL_COST, Predicate(TOTAL_COST, ()))
    file_name = None if file is None else str(file)
    rules = [section for section in sections if section.keyword.text in (":derived", ":axiom")]
    if undeclared is not None:
        redefined = dict(entry for rule in rules for entry in redefinition(rule, predicates))
        notes += [note for _, note in redefined.values()]
        predicates |= {name: predicate for name, (predicate, _) in redefined.items()}
    names = Domain(
        title.text,
        types,
        constants,
        predicates,
        functions,
        (),
        (),
        file_name,
        declared.more_parents,
    )

    derived_names = {rule_head(section, names) for section in rules}
    derived = tuple(parse_rule(section, names, notes) for section in rules)
    strata(derived)
    acts = [section for section in sections if section.keyword.text == ":action"]
    actions = [_action(section, names, derived_names, counts_costs, notes) for section in acts]
    return replace(names, actions=_distinct(actions, notes), derived=derived, notes=tuple(notes))


def _add_undeclared(
    undeclared: Undeclared,
    types: Mapping[str, str],
    predicates: dict[str, Predicate],
    functions: dict[str, Predicate],
    place: Place,
) -> list[str]:
    """Add predicates and functions that may be used undeclared, in place; return notes of them."""
    notes: list[str] = []
    declared = (types, predicates, functions)
    predicates |= {
        n: p for n, p in undeclared.predicates.items() if not any(n in names for names in declared)
    }
    functions |= {
        n: f for n, f in undeclared.functions.items() if not any(n in names for names in declared)
    }

    for name, computed in undeclared.computed.items():
        declared_as = functions.get(name)
        if declared_as is not None and len(declared_as.parameters) != len(computed.parameters):
            declares, computes = len(declared_as.parameters), len(computed.parameters)
            sizes = f"{declares} arguments, computed of {computes}"
            notes.append(
                warning(
                    declared_as.place or place,
                    f"function '{name}' is declared with {sizes}",
                )
            )
        if declared_as is None or len(declared_as.parameters) != len(computed.parameters):
            functions[name] = computed
    return notes


def _distinct(actions: Sequence[Action], notes: list[str]) -> tuple[Action, ...]:
    """Give the actions names of their own: the same one written twice is one, another one of its
    name is renamed.

    Fast Downward keeps both under one name; a plan would not say which of them is meant.
    """
    found: dict[str, Action] = {}
    for action in actions:
        if found.get(action.name) == action:
            if action.place is not None:
                notes.append(warning(action.place, f"action '{action.name}' stands twice"))
            continue
        name, number = action.name, 2
        while name in found:
            name, number = f"{action.name}~{number}", number + 1
        if name != action.name and action.place is not None:
            notes.append(
                warning(action.place, f"another action '{action.name}': plans have it as '{name}'")
            )
        found[name] = replace(action, name=name)
    return tuple(found.values())


def _action(
    section: Section, names: Domain, derived: Set[str], counts_costs: bool, notes: list[str]
) -> Action:
    if not section.items:
        raise error(section.group, "an action has no name")
    name = as_name(section.items[0], "an action's name")
    values = keyword_values(section.items[1:], f"action '{name.text}'", ACTION_KEYWORDS)
    listed = (
        as_group(values[":parameters"], "a list of parameters").items
        if ":parameters" in values
        else ()
    )
    written = parameters(listed, names.types)
    scope, bound = scope_of(names, notes=notes).with_variables(written)
    precondition = (
        parse_formula(values[":precondition"], scope) if ":precondition" in values else And(())
    )
    same = repeated(written, bound)
    precondition = And((precondition, *same)) if same else precondition
    effects = parse_effects(values[":effect"], scope, derived) if ":effect" in values else Effects()
    # PDDL: where costs are counted, an action that increases nothing is free; elsewhere every
    # action counts one.
    cost = effects.cost if effects.cost is not None else (0.0 if counts_costs else 1.0)
    return Action(name.text, bound, precondition, tuple(effects.simple), cost, section.group.place)


def _mentions(node: Node, word: str) -> bool:
    return isinstance(node, Group) and (
        node.head == word or any(_mentions(item, word) for item in node.items)
    )
