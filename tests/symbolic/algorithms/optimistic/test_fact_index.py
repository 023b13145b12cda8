"""Joins over facts against brute force, and unification by cases."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from tamp.symbolic.algorithms.optimistic.fact_index import FactIndex, unify
from tamp.symbolic.pddl.structs import Atom, Fact

NAMES = ("a", "b", "c")
VARIABLES = ("?x", "?y", "?z")


def brute(
    atoms: list[Atom], facts: set[Fact], binding: dict[str, str]
) -> set[tuple[tuple[str, str], ...]]:
    """All bindings of the atoms' variables under which each atom is a fact."""
    free = sorted(
        {term for atom in atoms for term in atom.terms if term[0] == "?"} - binding.keys()
    )
    found = set()
    for values in product(NAMES, repeat=len(free)):
        full = {**binding, **dict(zip(free, values, strict=True))}
        if all(
            (atom.predicate, *(full.get(term, term) for term in atom.terms)) in facts
            for atom in atoms
        ):
            found.add(tuple(sorted(full.items())))
    return found


def test_random_joins() -> None:
    answers = 0
    for seed in range(300):
        random = Random(seed)
        facts = {
            (
                random.choice(("p", "q")),
                *(random.choice(NAMES) for _ in range(random.randint(1, 2))),
            )
            for _ in range(random.randint(0, 20))
        }
        index = FactIndex()
        for fact in sorted(facts):
            index.add(fact)
        atoms = [
            Atom(
                random.choice(("p", "q")),
                tuple(random.choice((*VARIABLES, "a")) for _ in range(random.randint(1, 2))),
            )
            for _ in range(random.randint(0, 3))
        ]
        binding = {"?x": random.choice(NAMES)} if random.random() < 0.5 else {}
        found = [tuple(sorted(one.items())) for one in index.join(atoms, dict(binding))]
        assert len(found) == len(set(found)), "each answer once"
        assert set(found) == brute(atoms, facts, binding), seed
        answers += len(found)
    assert answers > 300


def test_facts_may_be_added_while_a_join_is_gone_through() -> None:
    index = FactIndex()
    index.add(("p", "a"))
    found = []
    for binding in index.join([Atom("p", ("?x",))], {}):
        found.append(binding["?x"])
        index.add(("p", f"{binding['?x']}a"))
    assert found == ["a"]


@pytest.mark.parametrize(
    ("terms", "fact", "binding", "expected"),
    [
        (("?x", "?y"), ("p", "a", "b"), {}, {"?x": "a", "?y": "b"}),
        (("?x", "?x"), ("p", "a", "a"), {}, {"?x": "a"}),
        (("?x", "?x"), ("p", "a", "b"), {}, None),
        (("a", "?y"), ("p", "a", "b"), {}, {"?y": "b"}),
        (("b", "?y"), ("p", "a", "b"), {}, None),
        (("?x", "?y"), ("p", "a", "b"), {"?x": "a", "?z": "c"}, {"?x": "a", "?y": "b", "?z": "c"}),
        (("?x", "?y"), ("p", "a", "b"), {"?x": "c"}, None),
        (("?x",), ("p", "a", "b"), {}, None),
        (("?x", "?y"), ("q", "a", "b"), {}, None),
        ((), ("p",), {}, {}),
    ],
)
def test_unification(
    terms: tuple[str, ...], fact: Fact, binding: dict[str, str], expected: dict[str, str] | None
) -> None:
    before = dict(binding)
    assert unify(Atom("p", terms), fact, binding) == expected
    assert binding == before
