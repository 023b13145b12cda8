"""Joins and fixpoints against their definition: every assignment tried, rules applied until nothing changes."""

from __future__ import annotations

import itertools

from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.instantiation.datalog import (
    Relations,
    Row,
    Rule,
    RuleBody,
    fixpoint,
    join,
)

OBJECTS = ("a", "b", "c")
TERMS = ("?x", "?y", "?z", "a")
VARIABLES = ("?x", "?y", "?z")

binary = st.builds(
    lambda name, terms: Atom(name, terms),
    st.sampled_from(["p", "q"]),
    st.tuples(st.sampled_from(TERMS), st.sampled_from(TERMS)),
)
rows = st.sets(st.tuples(st.sampled_from(OBJECTS), st.sampled_from(OBJECTS)), max_size=7)
equality = st.tuples(st.sampled_from(TERMS), st.sampled_from(TERMS), st.booleans())


def relations_of(**facts: set[Row]) -> Relations:
    made = Relations()
    for name, found in facts.items():
        made.add(name, sorted(found))
    return made


def by_hand(facts: dict[str, set[Row]], body: RuleBody) -> set[Row]:
    """All assignments to the variables that make the body hold."""
    everything = Atom("all", VARIABLES)
    found: set[Row] = set()
    for values in itertools.product(OBJECTS, repeat=3):
        binding = dict(zip(everything.terms, values, strict=True))

        def fill(terms: tuple[str, ...], binding: dict[str, str] = binding) -> Row:
            return tuple(binding.get(term, term) for term in terms)

        if (
            all(fill(atom.terms) in facts[atom.predicate] for atom in body.positive)
            and not any(fill(atom.terms) in facts[atom.predicate] for atom in body.negative)
            and all(
                (fill((left,)) == fill((right,))) is same for left, right, same in body.equalities
            )
        ):
            found.add(values)
    return found


@settings(max_examples=150, deadline=None)
@given(rows, rows, st.lists(binary, max_size=3), st.lists(binary, max_size=1), st.lists(equality))
def test_a_join_gives_all_assignments_that_satisfy_the_body(
    p: set[Row],
    q: set[Row],
    positive: list[Atom],
    negative: list[Atom],
    equalities: list[tuple[str, str, bool]],
) -> None:
    domain = {(name,) for name in OBJECTS}
    facts = {"p": p, "q": q, "object": domain}
    typed = tuple(Atom("object", (variable,)) for variable in VARIABLES)
    body = RuleBody((*positive, *typed), tuple(negative), tuple(equalities))
    found = join(relations_of(**facts), body, (), [()], VARIABLES)
    assert set(found) == by_hand(facts, body)
    assert len(found) == len(set(found))


def closure(edges: set[Row]) -> set[Row]:
    found = set(edges)
    while True:
        more = {(a, d) for a, b in found for c, d in found if b == c} - found
        if not more:
            return found
        found |= more


def path_rules() -> list[Rule]:
    step = Rule(
        ("?x", "?y"), RuleBody((Atom("edge", ("?x", "?y")),)), (Atom("path", ("?x", "?y")),)
    )
    chain = (Atom("path", ("?x", "?y")), Atom("edge", ("?y", "?z")))
    return [step, Rule(VARIABLES, RuleBody(chain), (Atom("path", ("?x", "?z")),))]


@settings(max_examples=80, deadline=None)
@given(rows, rows)
def test_what_comes_later_leads_to_the_same_as_all_at_once(
    first: set[Row], later: set[Row]
) -> None:
    relations, rules = relations_of(edge=first), path_rules()
    fixpoint(relations, rules)
    assert set(relations.rows("path")) == closure(first)

    new = relations.add("edge", sorted(later))
    assert set(new) == later - first
    fixpoint(relations, rules, {"edge": new})
    assert set(relations.rows("path")) == closure(first | later)


def test_a_rule_keeps_the_bindings_that_satisfied_its_body() -> None:
    relations, rules = relations_of(edge={("a", "b"), ("b", "c")}), path_rules()
    fixpoint(relations, rules)
    assert list(rules[0].rows) == [("a", "b"), ("b", "c")]
    assert list(rules[1].rows) == [("a", "b", "c")]


def test_constants_and_repeated_variables_pick_rows() -> None:
    relations = relations_of(edge={("a", "a"), ("a", "b"), ("b", "b")})
    assert relations.index(Atom("edge", ("?x", "?x")), [], [0])[()] == [("a",), ("b",)]
    assert relations.index(Atom("edge", ("a", "?y")), [1], [1])["b"] == [("b",)]
    relations.add("edge", [("c", "c")])  # an index that was built is kept up to date
    assert relations.index(Atom("edge", ("?x", "?x")), [], [0])[()] == [("a",), ("b",), ("c",)]
