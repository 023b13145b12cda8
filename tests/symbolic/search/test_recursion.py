"""Recursive predicates against networkx' strongly connected components."""

from __future__ import annotations

from random import Random

import networkx as nx

from tamp.symbolic.pddl.structs import And, Atom, Derived, Not
from tamp.symbolic.search.recursion import strata_of


def test_random_rules() -> None:
    recursive = 0
    for seed in range(300):
        random = Random(seed)
        names = [f"p{number}" for number in range(random.randint(1, 8))]
        graph = nx.DiGraph()
        graph.add_nodes_from(names)
        rules: dict[str, list[Derived]] = {}
        for name in names:
            used = [random.choice(names) for _ in range(random.randint(0, 2))]
            graph.add_edges_from((name, other) for other in used)
            body = [
                Atom(other, ()) if random.random() < 0.7 else Not(Atom(other, ())) for other in used
            ]
            rules[name] = [Derived(Atom(name, ()), (), And((Atom("fluent", ()), *body)))]

        kinds, rest_on_themselves = strata_of(rules)
        parts = {
            name: frozenset(part)
            for part in nx.strongly_connected_components(graph)
            for name in part
        }
        assert kinds == parts, seed
        loops = {name for name in names if len(parts[name]) > 1 or graph.has_edge(name, name)}
        assert rest_on_themselves == loops, seed
        recursive += bool(loops)
    assert 50 < recursive < 290
