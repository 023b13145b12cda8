"""Axioms: their stratification, and what they derive in a state."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Axiom, Facts


def stratify(axioms: Iterable[Axiom]) -> tuple[Axiom, ...]:
    """Sort the axioms such that each one's body needs only its own stratum (positively) and lower
    ones.

    Raises:
        InputError: A fact depends on its own negation.
    """
    by_head: dict[Fact, list[Axiom]] = {}
    for axiom in dict.fromkeys(axioms):
        by_head.setdefault(axiom.head, []).append(axiom)
    below = {
        head: sorted({f for rule in rules for f in rule.positive | rule.negative if f in by_head})
        for head, rules in by_head.items()
    }
    stratum: dict[Fact, int] = {}

    for component in components(below):
        members = set(component)
        for head in component:
            for rule in by_head[head]:
                for fact in sorted(rule.negative & members):
                    raise InputError(
                        f"the derived fact ({' '.join(head)}) depends on the negation of "
                        f"({' '.join(fact)}), "
                        "which depends on it",
                        remedy="Derived predicates must be stratified: "
                        "no predicate may depend on its own negation",
                    )
        level = 1 + max(
            (stratum[f] for head in component for f in below[head] if f not in members), default=-1
        )
        for head in component:
            stratum[head] = level

    ordered = sorted(by_head, key=lambda head: (stratum[head], head))

    return tuple(
        replace(axiom, stratum=stratum[head]) for head in ordered for axiom in by_head[head]
    )


def components(graph: dict[Fact, list[Fact]]) -> list[list[Fact]]:
    """Find the strongly connected components, those that others lead to first (Tarjan 1972,
    without recursion).
    """
    order: dict[Fact, int] = {}
    low: dict[Fact, int] = {}
    stack: list[Fact] = []
    on_stack: set[Fact] = set()
    found: list[list[Fact]] = []

    for root in sorted(graph):
        if root in order:
            continue
        order[root] = low[root] = len(order)
        stack.append(root)
        on_stack.add(root)
        work = [(root, iter(graph[root]))]
        while work:
            node, children = work[-1]
            for child in children:
                if child not in order:
                    order[child] = low[child] = len(order)
                    stack.append(child)
                    on_stack.add(child)
                    work.append((child, iter(graph[child])))
                    break
                if child in on_stack:
                    low[node] = min(low[node], order[child])
            else:
                work.pop()
                if work:
                    parent = work[-1][0]
                    low[parent] = min(low[parent], low[node])
                if low[node] == order[node]:
                    at = stack.index(node)
                    found.append(sorted(stack[at:]))
                    on_stack.difference_update(stack[at:])
                    del stack[at:]

    return found


def derive(
    axioms: Sequence[Axiom], state: Facts, price: Mapping[Fact, float] | None = None
) -> dict[Fact, Axiom]:
    """Derive the facts of a state, each with the axiom that gave it; in the order of derivation.

    Args:
        axioms: By stratum.
        state: The fluent facts.
        price: Of static facts: then each fact has an axiom of its cheapest derivation, else the
            first that gave it.
    """
    holds = set(state)
    why: dict[Fact, Axiom] = {}
    costs: dict[Fact, float] = {}
    start = 0

    while start < len(axioms):
        stop = start
        while stop < len(axioms) and axioms[stop].stratum == axioms[start].stratum:
            stop += 1
        changed = True
        while changed:
            changed = False
            for axiom in axioms[start:stop]:
                head = axiom.head
                if head in holds and (not price or head not in costs):
                    continue
                if not (axiom.positive <= holds and axiom.negative.isdisjoint(holds)):
                    continue
                if price:
                    cost = sum(price.get(fact, 0.0) for fact in axiom.static)
                    cost += sum(costs.get(fact, 0.0) for fact in axiom.positive)
                    if cost >= costs.get(head, math.inf):
                        continue
                    costs[head] = cost
                holds.add(head)
                why[head] = axiom
                changed = True
        start = stop

    return why


class DerivationSupport(NamedTuple):
    """The supports of derivations: static facts, facts of the state, and the derived facts
    themselves.
    """

    static: frozenset[Fact]
    read: frozenset[Fact]
    heads: frozenset[Fact]


def supports(why: dict[Fact, Axiom], facts: Iterable[Fact]) -> DerivationSupport:
    """Collect what the derivations of the given facts rest on; those that are not derived are
    facts of the state.
    """
    static: set[Fact] = set()
    read: set[Fact] = set()
    seen: set[Fact] = set()
    stack = list(facts)
    while stack:
        fact = stack.pop()
        axiom = why.get(fact)
        if axiom is None:
            read.add(fact)
        elif fact not in seen:
            seen.add(fact)
            static |= axiom.static
            stack.extend(axiom.positive)
    return DerivationSupport(frozenset(static), frozenset(read), frozenset(seen))
