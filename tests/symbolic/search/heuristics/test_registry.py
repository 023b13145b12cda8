"""Each heuristic's value by hand, on one task where no two of them say the same."""

from __future__ import annotations

import math

import pytest

from tamp.symbolic.search.heuristics.registry import ADMISSIBLE, HEURISTICS, Estimate
from tamp.symbolic.search.operators import Guard
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import facts, operator, task

WAYS = [
    operator("ab", "a", "b", cost=2.0), operator("bc", "b", "c", cost=1.5),
    operator("cg", "b c", "g", cost=1.0), operator("ag", "a", "g", cost=9.0),
    operator("ah", "a", "h", cost=0.5),
]  # fmt: skip
"""The goal is g and h. From a: b costs 2, c 3.5, g by cg 1 and what b and c cost, h 0.5."""


def estimate(name: str, state: str) -> Estimate:
    s = Successors(task(WAYS, "g h", "a"), {})
    return HEURISTICS[name](s)(s.mask(facts(state)))


@pytest.mark.parametrize(
    ("name", "start", "near", "goal", "dead"),
    [
        ("ff", 2 + 1.5 + 1 + 0.5, 1.5 + 1, 0.0, math.inf),
        ("hadd", (2 + 3.5 + 1) + 0.5, 1.5 + 1, 0.0, math.inf),
        ("hmax", 3.5 + 1, 1.5 + 1, 0.0, math.inf),
        ("lmcut", 2 + 1.5 + 1 + 0.5, 1.5 + 1, 0.0, math.inf),
        ("blind", 0.5, 0.5, 0.0, 0.5),
        ("landmarks", 1 + 0.5, 1.0, 0.0, 1.0),  # a was there first, so no state is dead to it
    ],
)
def test_values(name: str, start: float, near: float, goal: float, dead: float) -> None:
    found = [estimate(name, state).value for state in ("a", "b h", "g h", "c h")]
    assert found == pytest.approx([start, near, goal, dead])


def test_the_relaxed_plan_of_ff_is_told_and_others_tell_none() -> None:
    assert sorted(estimate("ff", "a").plan) == [0, 1, 2, 4]
    assert estimate("ff", "c h").plan == ()  # a dead end
    assert all(estimate(name, "a").plan == () for name in HEURISTICS if name != "ff")


def test_ff_says_which_prices_of_guards_its_value_contains() -> None:
    """Removing c costs 5 and paying for it 2: the price is in the value."""
    guarded = operator("go", "a", "g", guards=(Guard(facts("c"), ("clear",)),))
    made = task([guarded, operator("remove", "c", "", deleted="c", cost=5.0)], "g", "a c")
    s = Successors(made, {("clear",): 2.0})
    found = HEURISTICS["ff"](s)(s.initial)
    assert found.value == 1.0 + 2.0 and found.paid is not None
    assert [found.paid(i) for i in (0, 1)] == [2.0, 0.0]


def test_steps_that_cost_nothing_count_as_one_where_estimates_need_not_be_admissible() -> None:
    s = Successors(task([operator("ag", "a", "g", cost=0.0)], "g", "a"), {})
    values = {name: made(s)(s.initial).value for name, made in HEURISTICS.items()}
    assert values == {
        "ff": 1.0,
        "hadd": 1.0,
        "landmarks": 1.0,
        "hmax": 0.0,
        "lmcut": 0.0,
        "blind": 0.0,
    }
    assert {name for name, value in values.items() if value == 0.0} == ADMISSIBLE


def test_a_goal_that_nothing_reaches_is_infinite_to_landmarks() -> None:
    s = Successors(task([operator("ag", "a", "g")], "g z", "a"), {})
    assert HEURISTICS["landmarks"](s)(s.initial).value == math.inf
