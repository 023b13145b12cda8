"""Goals, initial facts and plain PDDL problem files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from tamp.symbolic.pddl.declarations import check_requirements, parse_objects
from tamp.symbolic.pddl.effects import TOTAL_COST, parse_number
from tamp.symbolic.pddl.features import FEATURES, lacking, unsupported
from tamp.symbolic.pddl.formulas import (
    Scope,
    parse_atom,
    parse_formula,
    parse_function_term,
    scope_of,
)
from tamp.symbolic.pddl.nodes import (
    Group,
    Node,
    Symbol,
    as_group,
    as_name,
    as_symbol,
    error,
    show,
    warning,
)
from tamp.symbolic.pddl.sections import Section, items_of, read_sections, single
from tamp.symbolic.pddl.sexpr import read, read_one
from tamp.symbolic.pddl.structs import Domain, Fact, Formula, Task

SECTIONS = (":domain", ":requirements", ":objects", ":init", ":goal", ":metric", ":length")


def parse_goal(
    text: str,
    domain: Domain,
    objects: Mapping[str, tuple[str, ...]],
    file: str | Path | None = None,
    line_offset: int = 0,
    column_offset: int = 0,
) -> Formula:
    """Read a goal.

    Args:
        text: One condition, such as "(on mug table)".
        domain: Whose predicates it uses.
        objects: Name -> types; an object has all of them.
        file: For messages: the file that the text is a part of.
        line_offset: Lines of that file before the text's first line.
        column_offset: Columns before the text on its first line.

    Raises:
        InputError: With file, line and column of what is wrong.
    """
    node = read_one(
        text,
        "one condition, (and ...) for several",
        file,
        line_offset=line_offset,
        column_offset=column_offset,
    )
    return parse_formula(node, scope_of(domain, objects))


def parse_facts(
    text: str | Sequence[str],
    domain: Domain,
    objects: Mapping[str, tuple[str, ...]],
    file: str | Path | None = None,
    line_offset: int = 0,
    column_offset: int = 0,
) -> frozenset[Fact]:
    """Read initial facts, "(hand-empty) (at-pose mug p0)"; the arguments are those of
    `parse_goal`.
    """
    scope = scope_of(domain, objects)
    texts = (text,) if isinstance(text, str) else text
    nodes = [
        n
        for t in texts
        for n in read(t, file, line_offset=line_offset, column_offset=column_offset)
    ]
    return frozenset(_fact(node, scope) for node in nodes)


def parse_task(text: str, domain: Domain, file: str | Path | None = None) -> Task:
    """Read a plain PDDL problem file.

    Costs count where it has a `:metric`; without one every action counts one, whatever the domain
    says.

    Raises:
        InputError: With file, line and column of what is wrong.
    """
    name, sections = read_sections(text, "problem", SECTIONS, file)
    notes = [*check_requirements(items_of(sections, ":requirements"))]
    notes += _check_domain(single(sections, ":domain"), domain)
    objects = parse_objects(
        items_of(sections, ":objects"), domain.types, "an object", notes, domain.constants
    )
    scope = replace(scope_of(domain, objects, notes), any_type=True)
    facts: set[Fact] = set()
    denied: dict[Fact, Node] = {}
    costs: dict[Fact, float] = {}

    for node in items_of(sections, ":init"):
        if isinstance(node, Group) and node.head == "=":
            term, value = _cost(node, scope)
            if costs.setdefault(term, value) != value:
                shown = " ".join(term)
                raise error(
                    node, f"({shown}) has two values at the start, {costs[term]:g} and {value:g}"
                )
        elif isinstance(node, Group) and node.head == "not":
            denied[_negative(node, scope)] = node
        else:
            facts.add(_fact(node, scope))

    for fact, node in denied.items():
        if fact in facts:
            raise error(node, f"({' '.join(fact)}) is said and denied at the start")
    goal = single(sections, ":goal")
    if goal is None or len(goal.items) != 1:
        raise error(goal.group if goal else name, "a problem has one (:goal CONDITION)")
    metric = single(sections, ":metric")
    _check_metric(metric)
    if metric is None and any(action.cost != 1.0 for action in domain.actions):
        domain = replace(
            domain, actions=tuple(replace(action, cost=1.0) for action in domain.actions)
        )
        what = "the problem has no (:metric minimize (total-cost)): every action costs 1"
        notes.append(warning(name, what))

    formula = parse_formula(goal.items[0], scope)
    return Task(name.text, domain, scope.objects, frozenset(facts), formula, costs, tuple(notes))


def _fact(node: Node, scope: Scope) -> Fact:
    group = as_group(node, "a fact such as (on mug table)")
    if group.head in ("and", "or", "not", "exists", "forall", "imply", "="):
        raise error(group, f"expected a fact such as (on mug table), found {show(group)}")
    if group.head == "at" and len(group.items) == 3 and isinstance(group.items[2], Group):
        raise error(group, lacking("(at TIME FACT)", "timed initial literals"))
    atom = parse_atom(group, scope)
    if atom.predicate not in scope.domain.predicates:
        raise error(
            group,
            f"'{atom.predicate}' is a type; it is given where the object is declared, "
            "not as a fact",
        )
    if atom.predicate in scope.domain.derived_predicates:
        raise error(
            group,
            f"'{atom.predicate}' is derived: its rules say where it holds, it cannot be a fact",
        )
    return (atom.predicate, *atom.terms)


def _cost(node: Group, scope: Scope) -> tuple[Fact, float]:
    """Parse `(= (distance a b) 3)`."""
    if len(node.items) != 3:
        raise error(node, "expected (= (FUNCTION object ...) NUMBER)")
    term = parse_function_term(node.items[1], scope)
    number = as_symbol(node.items[2], "a number")
    if number.text in scope.objects:
        raise error(number, lacking(f"(= ... {number.written})", "object fluents"))
    value = parse_number(number)
    if value < 0:
        raise error(number, f"a cost cannot be negative, found {number.written}")
    return (term.predicate, *term.terms), value


def _negative(node: Group, scope: Scope) -> Fact:
    """Parse `(not FACT)` in :init, which says what is so anyhow: the fact."""
    if len(node.items) != 2:
        raise error(node, "'not' takes one fact")
    return _fact(node.items[1], scope)


def _check_domain(section: Section | None, domain: Domain) -> tuple[str, ...]:
    """Note when the problem names another domain: collections of problems do, where a domain has
    variants.
    """
    if section is None:
        return ()
    if len(section.items) != 1:
        raise error(section.group, "a problem has one (:domain NAME)")
    name = as_name(section.items[0], "the domain's name")
    if name.text != domain.name:
        return (
            warning(
                name, f"the problem is for domain '{name.written}', the domain is '{domain.name}'"
            ),
        )
    return ()


def _check_metric(section: Section | None) -> None:
    """Check the metric: only `(:metric minimize (total-cost))` is known, with total-cost also
    without parentheses.
    """
    if section is None:
        return
    direction, *tail = section.items or (section.group,)
    if isinstance(direction, Symbol) and direction.text == "maximize":
        raise error(direction, lacking("maximize", "metrics to maximize"))
    if not (as_symbol(direction, "'minimize'").text == "minimize" and len(tail) == 1):
        raise error(direction, "expected (:metric minimize (total-cost))")
    target = tail[0]
    name = target.head if isinstance(target, Group) and len(target.items) == 1 else None
    used = {word for word in _words(target) if word in FEATURES}
    if used:
        raise error(target, unsupported(min(used)))
    if (name or (target.text if isinstance(target, Symbol) else "")) != TOTAL_COST:
        what = f"the metric is (total-cost), found {show(target)}: tamp has no numeric fluents"
        raise error(target, what)


def _words(node: Node) -> set[str]:
    return (
        {node.text}
        if isinstance(node, Symbol)
        else {word for item in node.items for word in _words(item)}
    )
