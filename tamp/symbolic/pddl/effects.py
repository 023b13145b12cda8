"""Effects of actions: nodes in, simple effects and a cost out."""

from __future__ import annotations

import math
from collections.abc import Sequence, Set
from dataclasses import dataclass, field

from tamp.symbolic.pddl.features import unsupported
from tamp.symbolic.pddl.formulas import (
    CONNECTIVES,
    EFFECT_WORDS,
    Scope,
    parse_atom,
    parse_formula,
    parse_function_term,
    repeated,
)
from tamp.symbolic.pddl.nodes import Group, Node, Symbol, as_group, as_symbol, error, show
from tamp.symbolic.pddl.structs import And, Atom, Effect, Formula, Parameter
from tamp.symbolic.pddl.typed import parameters

TOTAL_COST = "total-cost"


@dataclass
class Effects:
    """The effects of an action: the simple effects, and its increases of the total cost, None when
    it has none.
    """

    simple: list[Effect] = field(default_factory=list[Effect])
    cost: float | Atom | None = None


def parse_effects(node: Node, scope: Scope, derived: Set[str]) -> Effects:
    """Read an effect; nested conjunctions, `when` and `forall` are flattened.

    Args:
        node: The value of `:effect`.
        scope: The action's parameters and the constants.
        derived: Names of the derived predicates, which no effect may change.
    """
    effects = Effects()
    _collect(node, scope, derived, effects, And(()), ())
    return effects


def parse_number(symbol: Symbol) -> float:
    """Read a finite number."""
    try:
        value = float(symbol.text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise error(symbol, f"expected a number, found '{symbol.written}'")
    return value


def _collect(
    node: Node,
    scope: Scope,
    derived: Set[str],
    effects: Effects,
    condition: Formula,
    quantified: tuple[Parameter, ...],
) -> None:
    group = as_group(node, "an effect such as (on ?a ?b)")
    if not group.items:
        return
    head = as_symbol(group.items[0], "a predicate or one of and, not, when, forall, increase")
    tail = group.items[1:]

    match head.text:
        case "and":
            for part in tail:
                _collect(part, scope, derived, effects, condition, quantified)
        case "when":
            _expect(group, 2, "a condition and an effect")
            inner = parse_formula(tail[0], scope)
            both = inner if condition == And(()) else And((condition, inner))
            _collect(tail[1], scope, derived, effects, both, quantified)
        case "forall":
            _expect(group, 2, "a list of variables and an effect")
            listed = parameters(
                as_group(tail[0], "a list of variables such as (?x - body)").items,
                scope.domain.types,
            )
            inside, bound = scope.with_variables(listed)
            same = repeated(listed, bound)
            where = And((condition, *same)) if same else condition
            _collect(tail[1], inside, derived, effects, where, (*quantified, *bound))
        case "increase":
            if quantified or condition != And(()):
                raise error(head, "a cost inside 'when' or 'forall' is not supported")
            effects.cost = _added(effects.cost, _increase(group, tail, scope), head)
        case "decrease" | "assign" | "scale-up" | "scale-down":
            raise error(
                head, unsupported(head.text), remedy="Costs grow by (increase (total-cost) ...)"
            )
        case "probabilistic" | "oneof" if head.text not in scope.domain.predicates:
            raise error(head, unsupported(head.text))
        case "not":
            _expect(group, 1, "one fact")
            atom = _changed(tail[0], scope, derived)
            effects.simple.append(Effect(atom, False, condition, quantified))
        case _:
            atom = _changed(group, scope, derived)
            effects.simple.append(Effect(atom, True, condition, quantified))


def _changed(node: Node, scope: Scope, derived: Set[str]) -> Atom:
    """Parse the atom that a simple effect adds or deletes."""
    group = as_group(node, "a fact such as (on ?a ?b)")
    if group.head in (*CONNECTIVES, *EFFECT_WORDS, "="):
        remedy = "What happens only sometimes is written (when CONDITION EFFECT)"
        raise error(group.items[0], f"'{group.head}' is not possible in an effect", remedy=remedy)
    atom = parse_atom(group, scope)
    if atom.predicate in derived:
        remedy = "Its rules define it: change what they rest on"
        raise error(
            group,
            f"an effect cannot change the derived predicate '{atom.predicate}'",
            remedy=remedy,
        )
    if atom.predicate not in scope.domain.predicates:
        raise error(group, f"an effect cannot change the type '{atom.predicate}' of an object")
    return atom


def _increase(group: Group, tail: Sequence[Node], scope: Scope) -> float | Atom:
    _expect(group, 2, "(total-cost) and an amount")
    target = as_group(tail[0], "(total-cost)")
    if target.head != TOTAL_COST or len(target.items) != 1:
        what = (
            f"only (total-cost) can be increased, found {show(target)}: tamp has no numeric fluents"
        )
        raise error(target, what)

    amount = tail[1]
    if isinstance(amount, Symbol):
        value = parse_number(amount)
        if value < 0:
            raise error(amount, f"an action's cost cannot be negative, found {amount.written}")
        return value

    if amount.head in ("+", "-", "*", "/"):
        raise error(
            amount,
            f"arithmetic such as {show(amount)} is not supported",
            remedy="Name a number or a function",
        )

    term = parse_function_term(amount, scope)
    if term.predicate == TOTAL_COST:
        raise error(amount, "the total cost cannot increase by itself")
    return term


def _added(cost: float | Atom | None, more: float | Atom, head: Symbol) -> float | Atom:
    if cost is None:
        return more
    if isinstance(cost, Atom) or isinstance(more, Atom):
        raise error(head, "an action can increase the total cost by one function only")
    return cost + more


def _expect(group: Group, wanted: int, what: str) -> None:
    if len(group.items) - 1 != wanted:
        found = len(group.items) - 1
        raise error(
            group, f"'{group.head}' takes {what}, found {found} part{'' if found == 1 else 's'}"
        )
