"""Strata against networkx: one above each negation, none where a negation lies on a cycle."""

from __future__ import annotations

from random import Random

import networkx as nx
import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.stratification import strata
from tamp.symbolic.pddl.structs import And, Atom, Derived, Formula, Not, Place

Uses = list[tuple[str, str, bool]]


def rules_of(uses: Uses, names: list[str]) -> list[Derived]:
    """A rule for each name; it rests on what it uses, or on a fluent fact."""
    rules: list[Derived] = []
    for name in names:
        body: list[Formula] = [Atom("fluent", ())]
        for number, (head, used, positive) in enumerate(uses):
            if head == name:
                atom = Atom(used, (), Place(None, number + 1, 7))
                body.append(atom if positive else Not(atom))
        rules.append(Derived(Atom(name, ()), (), And(tuple(body))))
    return rules


def cyclic(uses: Uses, names: list[str]) -> bool:
    """Whether both ends of a negation are in one strongly connected component."""
    graph = nx.DiGraph()
    graph.add_nodes_from(names)
    graph.add_edges_from((head, used) for head, used, _ in uses)
    component = {
        name: number
        for number, part in enumerate(nx.strongly_connected_components(graph))
        for name in part
    }
    return any(not positive and component[head] == component[used] for head, used, positive in uses)


def test_random_rules_have_strata_just_where_no_negation_is_on_a_cycle() -> None:
    refused = 0
    for seed in range(400):
        random = Random(seed)
        names = [f"p{number}" for number in range(random.randint(1, 7))]
        uses = [
            (random.choice(names), random.choice(names), random.random() < 0.6)
            for _ in range(random.randint(0, 2 * len(names)))
        ]
        rules = rules_of(uses, names)
        if cyclic(uses, names):
            refused += 1
            with pytest.raises(InputError, match="rests on its own negation"):
                strata(rules)
            continue

        levels = strata(rules)
        assert levels.keys() == set(names)
        for head, used, positive in uses:
            assert levels[head] >= levels[used] + (not positive), (seed, head, used)
        # and no level is higher than what it rests on asks for
        for name in names:
            floors = [
                levels[used] + (not positive) for head, used, positive in uses if head == name
            ]
            assert levels[name] == max(floors, default=0) or name in {
                used for head, used, _ in uses if head == name
            }
    assert 50 < refused < 350


def test_the_error_names_the_shortest_way_round_and_stands_at_the_negation() -> None:
    uses = [
        ("a", "b", True),
        ("b", "c", True),
        ("c", "a", False),
        ("b", "a", True),
        ("a", "d", False),
    ]
    with pytest.raises(InputError) as caught:
        strata(rules_of(uses, ["a", "b", "c", "d"]))
    assert (
        "derived predicate 'c' rests on its own negation: c rests on not a rests on b rests on c"
        in str(caught.value)
    )
    assert (caught.value.line, caught.value.column) == (3, 7)


def test_a_predicate_that_denies_itself() -> None:
    with pytest.raises(InputError, match="'a' rests on its own negation: a rests on not a"):
        strata(rules_of([("a", "a", False)], ["a"]))


def test_what_rests_on_fluents_alone_is_at_the_bottom() -> None:
    assert strata(rules_of([], ["a", "b"])) == {"a": 0, "b": 0}
    chain = [("c", "b", False), ("b", "a", False)]
    assert strata(rules_of(chain, ["a", "b", "c"])) == {"a": 0, "b": 1, "c": 2}
    assert strata([]) == {}
