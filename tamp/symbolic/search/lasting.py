"""Facts that hold from the start to the end of every plan, and the operators that they forbid."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.datalog import Row
from tamp.symbolic.search.instantiation.lazy_guards import DerivedGuards, LazyGuards
from tamp.symbolic.search.operators import Axiom, Facts, Guard, InstantiatedTask, Operator


@dataclass(frozen=True)
class Lasting:
    """Facts that nothing ever makes false.

    Attributes:
        facts: Those of the initial state, and what follows from them by rules without negation.
        operators: Those that no lasting fact forbids.
        forbidden: The others, each with the lasting facts that it wants not to hold.
        causes: For a derived fact the facts that it follows from.
    """

    facts: frozenset[Fact]
    operators: tuple[Operator, ...]
    forbidden: tuple[tuple[Operator, frozenset[Fact]], ...]
    causes: dict[Fact, frozenset[Fact]]


def lasting(instantiated: InstantiatedTask) -> Lasting:
    """Compute a fixpoint: what is never deleted forbids operators, so that less is deleted."""
    alive = list(instantiated.operators)
    forbidden: list[tuple[Operator, frozenset[Fact]]] = []
    rules = [axiom for axiom in instantiated.axioms if not axiom.negative]
    possible = instantiated.initial | instantiated.reachable
    final: dict[DerivedGuards, dict[Row, list[Guard]]] = {}
    while True:
        facts = set(instantiated.initial - _deleted(alive))
        causes = _derive(facts, rules)
        kept: list[Operator] = []
        for operator in alive:
            against = set(operator.negative & facts)
            for guard in _final(operator, possible, final):
                against |= guard.facts if guard.facts <= facts else set()
            if against:
                forbidden.append((operator, frozenset(against)))
            else:
                kept.append(operator)
        if len(kept) == len(alive):
            return Lasting(frozenset(facts), tuple(alive), tuple(forbidden), causes)
        alive = kept


def forbidden_by(
    instantiated: InstantiatedTask, facts: frozenset[Fact]
) -> list[tuple[Operator, frozenset[Fact]]]:
    """List the operators that a state forbids whatever streams give, and what must be absent."""
    state = set(facts)
    _derive(state, [axiom for axiom in instantiated.axioms if not axiom.negative])
    possible = facts | instantiated.reachable
    final: dict[DerivedGuards, dict[Row, list[Guard]]] = {}
    found: list[tuple[Operator, frozenset[Fact]]] = []
    for operator in instantiated.operators:
        against = set(operator.negative & state)
        for guard in _final(operator, possible, final):
            against |= guard.facts if guard.facts <= state else set()
        if against:
            found.append((operator, frozenset(against)))
    return found


def _final(
    operator: Operator, possible: Facts, final: dict[DerivedGuards, dict[Row, list[Guard]]]
) -> Iterator[Guard]:
    """List an operator's guards that nothing waives; those that only a price asks for stay away."""
    guards = operator.guards
    if isinstance(guards, LazyGuards):
        for source, row in guards.blocked:
            if source not in final:
                rows = final[source] = dict[Row, list[Guard]]()
                for one, guard in source.unwaivable(possible):
                    rows.setdefault(one, []).append(guard)
            yield from final[source].get(row, ())
        guards = guards.made
    yield from (guard for guard in guards if guard.waived_by is None)


def _deleted(operators: Iterable[Operator]) -> set[Fact]:
    gone: set[Fact] = set()
    for operator in operators:
        gone |= operator.deleted
        for effect in operator.conditional:
            gone |= effect.deleted
    return gone


def _derive(facts: set[Fact], rules: list[Axiom]) -> dict[Fact, frozenset[Fact]]:
    """Add what follows from the facts; return why each does."""
    causes: dict[Fact, frozenset[Fact]] = {}
    grown = True
    while grown:
        grown = False
        for rule in rules:
            if rule.head not in facts and rule.positive <= facts:
                facts.add(rule.head)
                causes[rule.head] = rule.positive
                grown = True
    return causes
