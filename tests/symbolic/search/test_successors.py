"""The task over integers: bits, what applies, what it costs, and what comes after."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import pytest

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Guard, InstantiatedTask
from tamp.symbolic.search.successors import Successors, bits
from tests.symbolic.search.packed.room import axiom, facts, operator, task
from tests.symbolic.search.test_prices import instances


def successors(instantiated: InstantiatedTask, price: dict[str, float] | None = None) -> Successors:
    return Successors(instantiated, {(name,): cost for name, cost in (price or {}).items()})


def named(s: Successors, state: int) -> str:
    return " ".join(s.facts[i][0] for i in bits(state))


def test_bits_are_told_from_the_lowest() -> None:
    assert list(bits(0b1010_0001 | 1 << 70)) == [0, 5, 7, 70]
    assert list(bits(0)) == []


def test_facts_that_no_condition_mentions_are_left_out() -> None:
    """z is only added, i only there; all kinds of conditions are looked at."""
    way = operator("o", "a", "z b", absent="n", when=[("c", "m", "z", "")])
    s = successors(task([way], "g", "a i", [axiom("d", "e", "f")], "h"))
    assert named(s, (1 << len(s.facts)) - 1) == "a c d e f g h m n"
    assert named(s, s.initial) == "a"
    assert s.mask(facts("z i")) == 0


def test_derived_facts_follow_in_rounds_and_then_the_next_stratum() -> None:
    rules = [axiom("c", "b"), axiom("b", "a"), axiom("n", "", "c", stratum=1)]
    s = successors(task([operator("o", "n", "g")], "g c", "a", rules))
    assert named(s, s.closure(s.mask(facts("a")))) == "a b c"
    assert named(s, s.closure(0)) == "n"


def test_what_applies_has_all_that_it_needs_and_nothing_that_must_not_be() -> None:
    ways = [
        operator("free", "", "x"), operator("not", "", "x", absent="b"),
        operator("both", "a b", "x"), operator("one", "a", "x", absent="c"),
        operator("dear", "a", "x", static="never"),
    ]  # fmt: skip
    s = successors(task(ways, "x", "a"), {"never": math.inf})

    def applicable(text: str) -> list[int]:
        return sorted(s.applicable(s.mask(facts(text))))

    assert applicable("") == [0, 1]
    assert applicable("a") == [0, 1, 3]
    assert applicable("b") == [0]
    assert applicable("a b") == [0, 2, 3]
    assert applicable("a b c") == [0, 2]
    assert s.alive == [0, 1, 2, 3]


def test_adding_wins_over_deleting_also_across_conditional_effects() -> None:
    when = [("a", "", "b", "c"), ("b", "", "d", ""), ("", "d", "c", "e")]
    s = successors(task([operator("o", "", "e", deleted="e a", when=when)], "a b c d e"))

    def after(text: str) -> str:
        state = s.mask(facts(text))
        return named(s, s.apply(0, state, s.closure(state)))

    assert after("a") == "b c e"  # b was not there before: no d
    assert after("a c d") == "b d e"
    assert after("b e") == "b c d e"


def test_conditional_effects_look_at_derived_facts_which_are_not_kept() -> None:
    s = successors(
        task([operator("o", "", "", when=[("n", "", "b", "")])], "b", "a", [axiom("n", "a")])
    )
    assert named(s, s.apply(0, s.initial, s.closure(s.initial))) == "a b"
    assert named(s, s.apply(0, s.initial, s.initial)) == "a"


def test_the_goal_wants_its_facts_and_none_of_the_others() -> None:
    s = successors(task([operator("o", "", "g")], "g", "", (), "h"))
    assert [s.holds_goal(s.mask(facts(text))) for text in ("g", "g h", "", "h")] == [
        True, False, False, False,
    ]  # fmt: skip


GUARDED = [
    operator("o", "a", "g", cost=1.0, static="s",
             guards=(Guard(facts("b"), ("x",)), Guard(facts("b c"), ("y",)), Guard(facts("d"), None))),
    operator("p", "a", "g", cost=1.0, guards=(Guard(facts("b"), ("z",)),)),
]  # fmt: skip


@pytest.mark.parametrize(
    ("state", "costs"),
    [
        ("a", [1.5, 1.0]),
        ("a b", [1.5 + 2.0, 1.0]),  # nothing is said of z: it is free
        ("a c", [1.5, 1.0]),
        ("a b c", [1.5 + 2.0 + 4.0, 1.0]),
        ("a d", [math.inf, 1.0]),
    ],
)
def test_a_step_costs_its_own_prices_and_those_of_triggered_guards(
    state: str, costs: list[float]
) -> None:
    s = successors(task(GUARDED, "g", "a"), {"s": 0.5, "x": 2.0, "y": 4.0})
    assert [s.step_cost(i, s.mask(facts(state))) for i in (0, 1)] == costs


def test_guards_are_told_where_their_facts_hold_and_with_what_they_cost() -> None:
    s = successors(task(GUARDED, "g", "a"), {"x": 2.0})
    both = s.mask(facts("b c"))
    assert s.guard_sets() == [both, *sorted(s.mask(facts(one)) for one in ("b", "d"))]
    assert [named(s, one) for one in s.triggered(s.mask(facts("a b d c")))] == [
        "b c",
        "b",
        "c",
        "d",
    ]
    assert s.penalties(s.mask(facts("b"))) == {0: 2.0}
    assert s.penalties(s.mask(facts("d"))) == {0: math.inf}
    assert s.penalties(both) == {}


def test_a_price_is_asked_for_once() -> None:
    asked: list[Fact] = []

    def price(fact: Fact) -> float:
        asked.append(fact)
        return 2.0

    ways = [operator("o", "a", "g", static="s"), operator("p", "a", "g", static="s t")]
    s = Successors(task(ways, "g", "a"), price)
    assert s.cost == [3.0, 5.0] and sorted(asked) == [("s",), ("t",)]


def test_the_goals_rules_have_prices_of_their_own() -> None:
    rules = [replace(axiom("g", "a"), static=facts("s t")), axiom("g", "b")]
    s = successors(task([operator("o", "a", "b")], "g", "a", rules), {"s": 1.0, "t": 0.5})
    assert s.axiom_cost == [1.5, 0.0]


@pytest.mark.parametrize("seed", range(3))
def test_guards_made_when_they_are_met_cost_what_listed_ones_do(seed: int) -> None:
    """A price that is asked for keeps them back; a list of prices has those made that matter."""
    _, prices, listed, assumed = instances(seed)
    at_hand = Successors(listed, prices)
    late = Successors(assumed, lambda fact: prices.get(fact, 0.0))
    early = Successors(assumed, prices)
    assert at_hand.lists_guards and early.lists_guards and not late.lists_guards

    def priced(s: Successors, facts: Iterable[Fact]) -> dict[str, float]:
        """What each operator costs; listed tests that were refused forbid it as facts that must not be."""
        state = s.mask(facts)
        costs = {i: math.inf if s.absent[i] & state else s.step_cost(i, state) for i in s.alive}
        return {str(s.operators[i]): cost for i, cost in costs.items()}

    poses = sorted(fact for fact in listed.reachable if fact[0] == "at-pose")
    free = priced(at_hand, ())
    told = 0
    for start in range(len(poses)):
        state = poses[start : start + 2]
        wanted = priced(at_hand, state)
        assert priced(early, state) == wanted == priced(late, state)
        told += sum(wanted[name] > free[name] for name in free)
    assert told > 5
