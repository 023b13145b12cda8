"""Axioms over bits by stratum: which is under which bit, and that the closure misses none."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from random import Random

import pytest

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.axiom_strata import axiom_strata
from tamp.symbolic.search.instantiation.axioms import derive, stratify
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import axiom, facts, operator, task

NAMES = "abcdefgh"


def bit(*names: str) -> int:
    return sum(1 << NAMES.index(name) for name in names)


def mask(of: Iterable[Fact]) -> int:
    return bit(*(fact[0] for fact in of))


def test_the_lowest_stratum_comes_first_whatever_the_order() -> None:
    rules = [axiom("h", "", "g", stratum=2), axiom("f", "a"), axiom("g", "", "f", stratum=1)]
    heads = [[head for _, head in one.axioms()] for one in axiom_strata(rules, mask)]
    assert heads == [[bit("f")], [bit("g")], [bit("h")]]


def test_an_axiom_lies_under_the_lowest_bit_of_what_it_needs() -> None:
    (one,) = axiom_strata([axiom("g", "c b", "d"), axiom("h", "b"), axiom("f", "", "e")], mask)
    assert one.watched == {bit("b"): [(bit("b", "c"), bit("d"), bit("g")), (bit("b"), 0, bit("h"))]}
    assert one.free == [(bit("e"), bit("f"))]
    assert one.mask == bit("b")


def test_all_axioms_are_told_with_what_must_and_must_not_hold() -> None:
    (one,) = axiom_strata([axiom("g", "c b", "d"), axiom("f", "", "e"), axiom("h")], mask)
    assert sorted(one.axioms()) == sorted([
        ((bit("b", "c"), bit("d")), bit("g")), ((0, bit("e")), bit("f")), ((0, 0), bit("h")),
    ])  # fmt: skip


@pytest.mark.parametrize(
    ("rules", "recursive"),
    [
        ([axiom("f", "a"), axiom("g", "b")], False),
        ([axiom("f", "a"), axiom("g", "f", stratum=1)], False),
        ([axiom("f", "a"), axiom("g", "a f")], True),
        ([axiom("g", "f"), axiom("f", "a")], True),
        ([axiom("f", "f a")], True),
    ],
)
def test_a_stratum_is_recursive_where_a_rule_needs_a_head_of_its_own(
    rules: list, recursive: bool
) -> None:
    """Of a lower stratum it may need what it will: that is closed already."""
    assert axiom_strata(rules, mask)[-1].recursive is recursive


def test_closures_of_random_states_against_the_rules_by_name() -> None:
    """Random rules, circles among them, in their strata; some negative."""
    derived = 0
    for seed in range(150):
        rng = Random(seed)
        rules = [
            axiom(
                rng.choice("efgh"),
                " ".join(rng.sample("abcdefgh", rng.randint(0, 2))),
                rng.choice(("", "", "a", "b")),
            )
            for _ in range(6)
        ]
        ordered = list(stratify(rules))
        rng.shuffle(ordered)
        s = Successors(task([operator("all", "", "a b c d")], "e", "a", ordered), {})
        for _ in range(4):
            state = facts(" ".join(rng.sample("abcd", rng.randint(0, 4))))
            expected = fixpoint([(r.positive, r.negative, r.head) for r in rules], set(state))
            assert s.closure(s.mask(state)) == s.mask(expected)
            assert expected == set(state) | derive(stratify(rules), state).keys()
            derived += len(expected) - len(state)
    assert derived > 300


def fixpoint(rules: list[tuple[frozenset[Fact], frozenset[Fact], Fact]], state: set[Fact]) -> set:
    """All that follows, one fact at a time; what the rules deny here is never derived."""
    holds = set(state)
    while True:
        more = {head for yes, no, head in rules if yes <= holds and holds.isdisjoint(no)} - holds
        if not more:
            return holds
        holds.add(min(more))


def test_no_axioms_no_strata() -> None:
    assert axiom_strata([], mask) == []
    assert axiom_strata([replace(axiom("f"), static=facts("s"))], mask)[0].free == [(0, bit("f"))]
