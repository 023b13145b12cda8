"""Axioms: their strata, what they derive in a state, and what a derivation rests on."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import networkx as nx
import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.axioms import components, derive, stratify, supports
from tamp.symbolic.search.operators import Axiom
from tests.symbolic.search.packed.room import axiom, facts


def priced(head: str, needed: str, static: str, stratum: int = 0) -> Axiom:
    return replace(axiom(head, needed, stratum=stratum), static=facts(static))


def test_an_axiom_stands_above_what_it_denies_and_what_it_needs() -> None:
    ways = [axiom("y", "a"), axiom("y", "b"), axiom("y", "a")]
    rules = [axiom("d", "x"), *ways, axiom("x", "", "y")]
    found = [(one.head[0], one.stratum) for one in stratify(rules)]
    assert found == [("y", 0), ("y", 0), ("x", 1), ("d", 2)]  # what stands twice counts once


def test_facts_that_rest_on_each_other_share_a_stratum() -> None:
    rules = [
        axiom("b", "c"),
        axiom("c", "b"),
        axiom("b", "a"),
        axiom("a", "x"),
        axiom("e", "", "c"),
    ]
    assert {one.head[0]: one.stratum for one in stratify(rules)} == {"a": 0, "b": 1, "c": 1, "e": 2}


@pytest.mark.parametrize(
    "rules", [[axiom("b", "", "b")], [axiom("b", "c"), axiom("c", "", "b")]], ids=["self", "round"]
)
def test_what_rests_on_its_own_negation_is_refused(rules: list[Axiom]) -> None:
    with pytest.raises(InputError, match=r"depends on the negation of \(b\), which depends on it"):
        stratify(rules)


def test_components_are_those_of_networkx_and_come_after_what_they_lead_to() -> None:
    several = 0
    for seed in range(100):
        rng = Random(seed)
        nodes: list[Fact] = [(f"n{i}",) for i in range(rng.randint(1, 9))]
        graph = {node: rng.sample(nodes, rng.randint(0, min(2, len(nodes)))) for node in nodes}
        found = components(graph)
        wanted = nx.strongly_connected_components(nx.DiGraph(graph))
        assert sorted(found) == sorted(map(sorted, wanted))
        place = {node: i for i, part in enumerate(found) for node in part}
        assert all(place[node] >= place[other] for node in nodes for other in graph[node])
        several += len(found) < len(nodes)
    assert several > 20


def test_facts_are_derived_by_the_first_axiom_that_gives_them() -> None:
    """Stratum by stratum: c by b though a rule from a stands behind it, and n where c is not derived."""
    ways = [axiom("c", "b"), axiom("c", "a")]
    others = [axiom("b", "a"), axiom("n", "", "c"), axiom("m", "", "a")]
    for order, first in ((ways, "b"), (ways[::-1], "a")):
        why = derive(stratify([*order, *others]), facts("a"))
        found = {head[0]: one.positive for head, one in why.items()}
        assert found == {"b": facts("a"), "c": facts(first)}
    rules = stratify([*ways, *others])
    assert [head[0] for head in derive(rules, facts("c"))] == ["m"]  # c is given, not derived
    assert set(derive(rules, facts(""))) == facts("n m")


def test_with_prices_each_fact_has_its_cheapest_derivation() -> None:
    """c directly for 9, or by b for 2 + 3; d for 4, or by b for 2 + 3; b for 7 or 3."""
    rules = [
        priced("c", "a", "nine"), priced("b", "a", "seven"), priced("b", "a", "three"),
        priced("c", "b", "two"), priced("d", "b", "two"), priced("d", "a", "four"),
    ]  # fmt: skip
    prices = {("nine",): 9.0, ("seven",): 7.0, ("three",): 3.0, ("four",): 4.0, ("two",): 2.0}
    why = derive(rules, facts("a"), prices)
    assert {head[0]: one.static for head, one in why.items()} == {
        "c": facts("two"), "b": facts("three"), "d": facts("four"),
    }  # fmt: skip
    assert derive(rules, facts("a b"), prices)["c",].static == facts("two")


def test_a_derivation_rests_on_all_that_stands_below_it() -> None:
    rules = [priced("b", "a", "s"), priced("c", "b d", "t"), priced("u", "a", "unused")]
    found = supports(derive(rules, facts("a d")), [("c",), ("d",)])
    assert found == (facts("s t"), facts("a d"), facts("b c"))
    assert supports({}, [("a",)]) == (facts(""), facts("a"), facts(""))
