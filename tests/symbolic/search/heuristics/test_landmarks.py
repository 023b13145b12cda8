"""Fact landmarks: which facts every plan makes true, and which of them are still to come after a walk."""

from __future__ import annotations

import math

import pytest

from tamp.symbolic.search.heuristics.landmarks import Landmarks
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.successors import State, Successors
from tests.symbolic.search.packed.room import axiom, facts, operator, task


def names(instantiated: InstantiatedTask) -> str:
    """The landmarks, those that are the absence of a fact with a minus."""
    s = Successors(instantiated, {})
    size = len(s.facts)
    found = Landmarks(s).landmarks
    return " ".join(
        s.facts[one][0] if one < size else f"-{s.facts[one - size][0]}" for one in found
    )


def test_what_all_ways_have_in_common_is_a_landmark() -> None:
    """To d by b or by c, and from there to the goal."""
    ways = [
        operator("ab", "a", "b"), operator("ac", "a", "c"), operator("bd", "b", "d"),
        operator("cd", "c", "d"), operator("dg", "d", "g"),
    ]  # fmt: skip
    assert names(task(ways, "g", "a")) == "a d g"
    assert names(task(ways[1:], "g", "a")) == "a c d g"


def test_all_that_an_operator_needs_is_one_with_what_it_needs_itself() -> None:
    ways = [operator("ab", "a", "b"), operator("ac", "a", "c"), operator("go", "b c", "g")]
    assert names(task(ways, "g", "a")) == "a b c g"


class Walk:
    """Costs of the landmarks that are to come, state by state."""

    def __init__(self, instantiated: InstantiatedTask) -> None:
        self._s = Successors(instantiated, {})
        self.marks = Landmarks(self._s)

    def cost(self, state: str, parent: str | None = None) -> float:
        before: State | None = None if parent is None else self._s.mask(facts(parent))
        return self.marks.cost(self.marks.remaining(self._s.mask(facts(state)), before))


HIDDEN = [
    operator("key", "a", "k"), operator("free", "k", "", deleted="h"),
    operator("n", "a", "n", absent="h"),
]  # fmt: skip
"""h goes where k is, and has to be gone for n."""


def test_what_must_be_gone_is_a_landmark_and_a_rule_leads_on() -> None:
    made = task(HIDDEN, "g", "a h", [axiom("g", "n")])
    assert names(made) == "a g k n -h"
    walk = Walk(made)
    assert [walk.cost("a h"), walk.cost("a h k", "a h"), walk.cost("a k", "a h k")] == [
        3.0,
        2.0,
        1.0,
    ]


def test_a_landmark_counts_until_it_was_true_and_again_where_it_is_needed() -> None:
    """Costs of the cheapest achievers: b 2, c, a, d and g 1 each."""
    ways = [
        operator("ab", "a", "b", deleted="a", cost=2.0), operator("bc", "b", "c", deleted="b"),
        operator("ca", "c", "a d", deleted="c"), operator("dg", "a d", "g", deleted="d"),
        operator("dear", "a d", "g", deleted="d", cost=7.0),
    ]  # fmt: skip
    walk = Walk(task(ways, "g d", "a"))
    assert walk.cost("a") == 2.0 + 1.0 + 1.0 + 1.0
    assert walk.cost("b", "a") == 1.0 + 1.0 + 1.0 + 1.0  # c, d, g; and a, which the last step needs
    assert walk.cost("c", "b") == 1.0 + 1.0 + 1.0
    assert walk.cost("a d", "c") == 1.0
    assert walk.cost("a g", "a d") == 1.0  # d is a goal, and gone


def test_what_was_true_on_one_way_only_is_still_to_come() -> None:
    """p was there and got lost: who comes to a by another way has not had it."""
    ways = [
        operator("get", "a", "p", cost=3.0), operator("lose", "p", "", deleted="p"),
        operator("px", "p", "x"), operator("py", "p", "y"), operator("xg", "x", "g"),
        operator("yg", "y", "g"),
    ]  # fmt: skip
    walk = Walk(task(ways, "g", "a"))
    assert walk.cost("a") == 3.0 + 1.0
    assert walk.cost("a p", "a") == 1.0
    assert walk.cost("a", "a p") == 3.0 + 1.0

    other = Walk(task(ways, "g", "a"))
    assert other.cost("a p") == 1.0
    assert other.cost("a", "a p") == 1.0  # g rests on x or y, neither needs p in all cases
    assert other.cost("a") == 3.0 + 1.0


def test_what_some_first_achievers_need_is_not_needed_again() -> None:
    """q was there for h and got lost; g takes p as well."""
    ways = [
        operator("p", "a", "p"), operator("q", "a", "q", cost=3.0), operator("pg", "p", "g"),
        operator("qg", "q", "g"), operator("qh", "q", "h", deleted="q"),
    ]  # fmt: skip
    walk = Walk(task(ways, "g h", "a"))
    assert [walk.cost("a"), walk.cost("a q", "a"), walk.cost("a h", "a q")] == [5.0, 2.0, 1.0]


@pytest.mark.parametrize(("goal", "possible"), [("g", True), ("g z", False)])
def test_a_goal_out_of_reach_is_told(goal: str, possible: bool) -> None:
    marks = Landmarks(Successors(task([operator("ag", "a", "g")], goal, "a"), {}))
    assert marks.possible is possible
    assert math.isfinite(marks.cost(marks.remaining(0, None)))
