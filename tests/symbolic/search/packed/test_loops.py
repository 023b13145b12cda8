"""The loop of the packed search, step by step: states are closed once, and why it stops is said."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.symbolic.search.packed import basics, loops
from tests.symbolic.search.packed.room import Packed, facts, operator, packed, task

NO_LIMIT = 1 << 62
CHAIN = [
    operator("ab", "a", "b", deleted="a", cost=2.0), operator("bg", "b", "g", cost=3.0),
    operator("ag", "a", "g", deleted="a", cost=9.0), operator("back", "b", "a", deleted="b"),
]  # fmt: skip


def begun(made: Packed) -> Packed:
    """With the initial state in the first list, as `PackedSearch` begins."""
    ints, space = made.ints, made.space
    ints[basics.GOAL_NODE], ints[basics.BOOST] = -1, 1000
    ints[basics.LIMIT] = ints[basics.UNTIL] = ints[basics.ENDURANCE] = NO_LIMIT
    made.reals[: made.t.heuristics] = math.inf
    ints[space.members], made.reals[space.member_cost] = -1 - basics.GOAL_ENTRY, 0.0
    ints[basics.MEMBERS], ints[basics.GROUPS] = 1, made.t.heuristics
    for k in range(made.t.heuristics):
        ints[space.group_parent + k], ints[space.group_base + k] = -1, 0
        ints[space.group_next + k], ints[space.group_end + k] = 0, 1
        at = k * space.groups
        made.reals[space.keys + at] = ints[space.ties + at] = 0
        ints[space.items + at], ints[basics.SIZES + k] = k, 1
    return made


def run(made: Packed, weight: float = math.inf, below: float = math.inf) -> int:
    with np.errstate(over="ignore"):
        return loops.run(made.ints, made.reals, made.t, made.r, made.x, made.space, weight, below)


def way(made: Packed, node: int) -> list[int]:
    """The operators on the way to a closed state."""
    found: list[int] = []
    while made.ints[made.space.parent + node] >= 0:
        found.append(int(made.ints[made.space.operator + node]))
        node = int(made.ints[made.space.parent + node])
    return found[::-1]


@pytest.mark.parametrize(("weight", "plan"), [(math.inf, [0, 1]), (1.0, [0, 1])])
def test_a_goal_state_stops_the_loop_with_its_way_and_cost(weight: float, plan: list[int]) -> None:
    made = begun(packed(task(CHAIN, "g", "a"), names=("ff", "landmarks")))
    assert run(made, weight) == loops.GOAL
    node = int(made.ints[basics.AT])
    assert way(made, node) == plan
    assert made.reals[made.space.cost + node] == 5.0
    assert made.ints[basics.EXPANDED] == 2 and made.ints[basics.EVALUATED] == 2


def test_where_nothing_is_left_it_says_so() -> None:
    made = begun(packed(task([operator("ab", "a", "b"), operator("yg", "y", "g")], "g", "a y")))
    made.write(made.t.initial, facts("a"))
    assert run(made) == loops.EXHAUSTED
    assert made.ints[basics.EXPANDED] == 0 and made.ints[basics.EVALUATED] == 1


@pytest.mark.parametrize(
    ("place", "why"), [(basics.LIMIT, loops.LIMITED), (basics.UNTIL, loops.PAUSE)]
)
def test_a_limit_of_states_stops_it(place: int, why: int) -> None:
    made = begun(packed(task(CHAIN, "g", "a")))
    made.ints[place] = 1
    assert run(made) == why
    assert made.ints[basics.EXPANDED] == 1
    if why == loops.PAUSE:  # and on it goes
        made.ints[place] = NO_LIMIT
        assert run(made) == loops.GOAL


@pytest.mark.parametrize("rooms", [(2, 200, 200), (40, 7, 200), (40, 200, 8)])
def test_where_the_arrays_are_full_it_asks_for_more(rooms: tuple[int, int, int]) -> None:
    assert run(begun(packed(task(CHAIN, "g", "a"), rooms=rooms))) == loops.GROW


def test_own_costs_below_a_bound_only() -> None:
    """The way costs 5: below 5 there is none, the dear one is no help."""
    for below, why in ((5.0, loops.EXHAUSTED), (5.5, loops.GOAL)):
        made = begun(packed(task(CHAIN, "g", "a")))
        assert run(made, below=below) == why


def closed(made: Packed, text: str, parent: int, reached: float, i: int, *, greedy: bool) -> int:
    with np.errstate(over="ignore"):
        node = loops.arrive(
            made.ints, made.reals, made.t, made.x, made.space, i, parent, reached, greedy
        )
    if node >= 0:
        assert made.named(made.read(made.space.states + node * made.t.words)) == text
    return node


def test_a_state_is_closed_once_and_opened_again_only_when_it_is_cheaper() -> None:
    made = packed(task([*CHAIN, operator("too", "a", "b", deleted="a")], "g", "a"))
    root = closed(made, "a", -1, 0.0, -1, greedy=False)
    first = closed(made, "b", root, 2.0, 0, greedy=False)
    assert (root, first, int(made.ints[basics.NODES])) == (0, 1, 2)
    assert closed(made, "b", root, 2.0, 4, greedy=False) == -1
    assert closed(made, "b", root, 1.0, 4, greedy=True) == -1
    assert closed(made, "b", root, 1.0, 4, greedy=False) == first
    space = made.space
    assert made.reals[space.cost + first] == 1.0 and made.ints[space.operator + first] == 4
    assert made.reals[space.spent + first] == 1.0 and made.ints[basics.NODES] == 2


def test_a_conditional_effect_looks_at_the_parent_with_its_derived_facts() -> None:
    from tests.symbolic.search.packed.room import axiom

    one = operator("o", "a", "", when=[("n", "", "b", "")])
    made = packed(task([one], "b", "a", axioms=[axiom("n", "a")]))
    root = closed(made, "a", -1, 0.0, -1, greedy=True)
    assert closed(made, "a b", root, 1.0, 0, greedy=True) == 1


def test_progress_is_a_root_of_its_own_else_the_detour_grows() -> None:
    made = packed(task(CHAIN, "g", "a"))
    space = made.space
    values = [5.0, 5.0, 4.0, 4.5]  # of node 0 and, each from the one before, 1, 2, 3
    for node, value in enumerate(values):
        made.reals[space.values + node] = value
        loops.place(made.ints, made.reals, made.t, space, node, node - 1, 2)
    assert made.ints[space.root : space.root + 4].tolist() == [0, 0, 2, 2]
    assert made.ints[space.detour : space.detour + 4].tolist() == [0, 3, 0, 3]


def test_progress_gives_the_preferred_lists_a_boost_and_is_noted() -> None:
    made = begun(packed(task(CHAIN, "g", "a")))
    made.ints[basics.UNTIL] = 1
    run(made)
    assert made.ints[basics.PROGRESS] == 1
    turns = basics.SIZES + 2
    assert made.ints[turns : turns + 2].tolist() == [1, -1000]
    assert made.reals[0] == 5.0  # the new low


def test_a_state_that_comes_again_keeps_its_values() -> None:
    made = packed(task(CHAIN, "g", "a"), names=("landmarks", "ff"))
    made.write(made.x.closed, facts("a"))
    parts = made.ints, made.reals, made.t, made.r, made.x, made.space
    length = loops.evaluate(*parts, 0, -1)
    assert length == 2 and made.ints[basics.EVALUATED] == 1
    before = made.reals[made.space.values]
    made.ints[made.space.marks] = -1  # as if all had been there
    loops.evaluate(*parts, 0, -1)
    assert made.ints[basics.EVALUATED] == 1 and made.reals[made.space.values] == before
