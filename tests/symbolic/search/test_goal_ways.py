"""The ways in which a goal can hold, against the closure of every state over a few fluents."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search import goal_ways as module
from tamp.symbolic.search.goal_ways import MAX_ALTERNATIVES, Way, goal_parts
from tamp.symbolic.search.operators import Axiom, Goal, InstantiatedTask, Meaning

FLUENTS: list[Fact] = [("a",), ("b",), ("c",)]
DERIVED: list[Fact] = [("p",), ("q",), ("r",)]


def facts(words: Iterable[str]) -> frozenset[Fact]:
    return frozenset((word,) for word in words)


def axiom(head: str, positive: str = "", negative: str = "") -> Axiom:
    return Axiom((head,), facts(positive.split()), facts(negative.split()))


def task(goal: Goal, *axioms: Axiom, meanings: tuple[str, ...] = ()) -> InstantiatedTask:
    return InstantiatedTask(
        frozenset(), goal, (), axioms, frozenset(), dict.fromkeys(meanings, Meaning(""))
    )


def closure(state: frozenset[Fact], axioms: Iterable[Axiom]) -> frozenset[Fact]:
    """What holds in a state; the rules come in an order in which each asks of earlier heads only."""
    holds = set(state)
    for rule in axioms:
        if rule.positive <= holds and not rule.negative & holds:
            holds.add(rule.head)
    return frozenset(holds)


def is_so(way: Way, state: frozenset[Fact]) -> bool:
    return all((fact in state) == wanted for fact, wanted in way)


def states() -> Iterable[frozenset[Fact]]:
    return (frozenset(chosen) for n in range(4) for chosen in itertools.combinations(FLUENTS, n))


def ways(goal: Goal, *axioms: Axiom, meanings: tuple[str, ...] = ()) -> list[set[Way]]:
    return [set(part.ways) for part in goal_parts(task(goal, *axioms, meanings=meanings))]


def test_a_fluent_holds_by_itself() -> None:
    assert ways(Goal(facts("a"), facts("b"))) == [
        {frozenset({(("a",), True)})},
        {frozenset({(("b",), False)})},
    ]


def test_a_rule_opens_into_its_body_and_two_rules_into_two_ways() -> None:
    found = ways(Goal(facts("p")), axiom("p", "a", "b"), axiom("p", "c"))
    assert found == [{frozenset({(("a",), True), (("b",), False)}), frozenset({(("c",), True)})}]


def test_what_denies_a_disjunction_denies_all_of_it() -> None:
    (found,) = ways(Goal(frozenset(), facts("p")), axiom("p", "a"), axiom("p", "b c"))
    assert found == {
        frozenset({(("a",), False), (("b",), False)}),
        frozenset({(("a",), False), (("c",), False)}),
    }


def test_ways_that_contradict_themselves_are_none() -> None:
    assert ways(Goal(facts("p")), axiom("q", "a"), axiom("p", "q b", "a")) == [set()]


def test_a_part_made_up_for_the_goal_is_taken_apart() -> None:
    parts = goal_parts(task(Goal(facts(["and"])), axiom("and", "a b", "c"), meanings=("and",)))
    assert [part.literal for part in parts] == [(("a",), True), (("b",), True), (("c",), False)]
    (whole,) = goal_parts(task(Goal(facts(["and"])), axiom("and", "a b", "c")))
    assert whole.literal == (("and",), True)  # a derived fact of the user's keeps its name


def test_a_universal_part_denied_is_taken_apart_by_its_rules() -> None:
    parts = goal_parts(
        task(
            Goal(frozenset(), facts(["some"])),
            axiom("some", "a"),
            axiom("some", "", "b"),
            meanings=("some",),
        )
    )
    assert [part.literal for part in parts] == [(("a",), False), (("b",), True)]


@pytest.mark.parametrize(
    ("wanted", "rules"),
    [
        (True, (axiom("made", "a"), axiom("made", "b"))),  # a choice: neither is a conjunct
        (False, (axiom("made", "a b"),)),  # one of the two is to be false, which one is open
        (True, ()),
    ],
)
def test_what_is_no_conjunction_is_not_taken_apart(wanted: bool, rules: tuple[Axiom, ...]) -> None:
    made = facts(["made"])
    goal = Goal(made) if wanted else Goal(frozenset(), made)
    (part,) = goal_parts(task(goal, *rules, meanings=("made",)))
    assert part.literal == (("made",), wanted)


def test_rules_in_circles_say_nothing() -> None:
    assert ways(Goal(facts("p")), axiom("p", "q"), axiom("q", "p")) == [{frozenset()}]


def test_too_many_ways_say_nothing() -> None:
    many = [axiom("p", f"x{i}") for i in range(MAX_ALTERNATIVES + 1)]
    assert ways(Goal(facts("p")), *many) == [{frozenset()}]
    assert len(ways(Goal(facts("p")), *many[:-1])[0]) == MAX_ALTERNATIVES


@st.composite
def rules(draw: st.DrawFn) -> list[Axiom]:
    """Axioms whose bodies ask of fluents and of heads before theirs."""
    made: list[Axiom] = []
    for index, head in enumerate(DERIVED):
        known = FLUENTS + DERIVED[:index]
        for _ in range(draw(st.integers(0, 2))):
            body = draw(st.lists(st.tuples(st.sampled_from(known), st.booleans()), max_size=3))
            positive, negative = (
                frozenset(fact for fact, sign in body if sign is wanted) for wanted in (True, False)
            )
            made.append(Axiom(head, positive, negative))
    return made


@given(rules(), st.sampled_from(FLUENTS + DERIVED), st.booleans())
@settings(max_examples=150)
def test_a_literal_holds_just_where_one_of_its_ways_does(
    axioms: list[Axiom], fact: Fact, wanted: bool
) -> None:
    goal = Goal(
        frozenset({fact}) if wanted else frozenset(), frozenset() if wanted else frozenset({fact})
    )
    (part,) = goal_parts(task(goal, *axioms))
    without_rules = fact in DERIVED and not any(rule.head == fact for rule in axioms)
    if without_rules:  # it is then a fluent like any other
        assert part.ways == (frozenset({(fact, wanted)}),)
        return
    for state in states():
        # Derived facts without any rule are fluents as well, and false in these states.
        assert ((fact in closure(state, axioms)) == wanted) == any(
            is_so(way, state) for way in part.ways
        )


@pytest.mark.parametrize("order", [("a", "b"), ("b", "a")])
def test_parts_come_in_one_order(order: tuple[str, ...]) -> None:
    parts = goal_parts(task(Goal(facts(order), facts(["c"]))))
    assert [part.literal for part in parts] == [(("a",), True), (("b",), True), (("c",), False)]


def test_all_choices_of_a_goal_are_opened_with_work_that_is_bounded_as_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Sixty rules of an auxiliary goal, each with a part whose ways double thirty times over."""
    monkeypatch.setattr(module, "MOST_WORK", 500)
    asked: list[Fact] = []
    opened = module._Opener.ways

    def counted(self: module._Opener, literal: module.Literal, *above: frozenset[Fact]) -> object:
        asked.append(literal[0])
        return opened(self, literal, *above)

    monkeypatch.setattr(module._Opener, "ways", counted)
    doubling = [axiom(f"p{k}", f"p{k + 1} {also}") for k in range(30) for also in ("a", "b")]
    choices = [axiom("goal", f"p{k % 5} q{k}") for k in range(60)]
    reached = [axiom(f"q{k}", "c") for k in range(60)]
    (part,) = goal_parts(
        task(Goal(facts(["goal"]), facts([])), *doubling, *choices, *reached, meanings=("goal",))
    )
    assert len(part.choices) == 60
    assert len(asked) < 10 * 500
