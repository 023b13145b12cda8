"""Open lists of the packed search: groups take turns member by member, lists by how often each was asked."""

from __future__ import annotations

import math

import pytest

from tamp.symbolic.search.packed import queues
from tamp.symbolic.search.packed.basics import (
    DETOUR,
    GOAL_ENTRY,
    GOAL_NODE,
    GROUPS,
    MEMBERS,
    PUSHED,
    SIZES,
)
from tests.symbolic.search.packed.room import Packed, operator, packed, task

GREEDY, BY_COST = True, False
OPERATORS = [operator(f"o{i}", "", "g", cost=float(i)) for i in range(6)]


def made(kinds: int = 1) -> Packed:
    names = ("ff", "landmarks")[:kinds]
    return packed(task(OPERATORS, "g"), names=names)


def add(
    one: Packed, key: float, orders: list[int], k: int = 0, base: int = 0, greedy: bool = BY_COST
) -> None:
    """A group: its members' operators are their orders."""
    first = int(one.ints[MEMBERS])
    for order in orders:
        queues.add_member(one.ints, one.reals, one.space, order, order, 10.0 + order)
    last = int(one.ints[MEMBERS])
    queues.add_group(one.ints, one.reals, one.space, k, key, 7, first, last, base, greedy)


def popped(one: Packed, k: int = 0, greedy: bool = BY_COST) -> list[int]:
    """The operators of all that is left in a list, in order."""
    found: list[int] = []
    while one.ints[SIZES + k]:
        parent, member = queues.pop(one.ints, one.reals, one.space, k, greedy)
        assert parent == 7
        word = int(one.ints[one.space.members + member])
        found.append((word & 0xFFFFFFFF) + GOAL_ENTRY)
        assert found[-1] == GOAL_ENTRY or word >> 32 == found[-1]
        if found[-1] >= 0:
            assert one.reals[one.space.member_cost + member] == 10.0 + found[-1]
    return found


def test_the_lowest_key_goes_first_and_a_group_in_its_order() -> None:
    one = made()
    add(one, 2.0, [0, 1, 2])
    add(one, 1.0, [3, 4])
    assert one.ints[SIZES] == 2 and one.ints[GROUPS] == 2
    assert popped(one) == [3, 4, 0, 1, 2]


def test_groups_of_one_key_are_merged_by_their_members_order() -> None:
    one = made()
    add(one, 1.0, [0, 3, 5])
    add(one, 1.0, [1, 2, 4])
    assert popped(one) == [0, 1, 2, 3, 4, 5]


def test_an_older_state_goes_first_and_by_its_detour_in_greedy_search() -> None:
    one = made()
    add(one, 1.0, [0, 5], base=100)
    add(one, 1.0, [1, 2], base=0)
    assert popped(one) == [1, 2, 0, 5]
    # greedy: an order counts as a step of detour, so the base of a state two steps on is compared
    add(one, 1.0, [0, 5], base=2 << DETOUR, greedy=GREEDY)
    add(one, 1.0, [1, 3], base=0, greedy=GREEDY)
    assert popped(one, greedy=GREEDY) == [1, 0, 3, 5]


def test_lists_are_apart() -> None:
    one = made(2)
    add(one, 1.0, [0], k=0)
    add(one, 1.0, [1], k=1)
    add(one, 1.0, [2], k=2)
    assert [popped(one, k) for k in range(4)] == [[0], [1], [2], []]


def turns(one: Packed, count: int, greedy: bool = GREEDY) -> list[int]:
    return [queues.turn(one.ints, one.reals, one.t, one.space, greedy) for _ in range(count)]


def test_lists_take_turns_but_for_empty_ones() -> None:
    one = made(2)
    assert turns(one, 2) == [-1, -1]
    add(one, 1.0, [0], k=0)
    assert turns(one, 2) == [0, 0]
    add(one, 1.0, [1], k=1)
    add(one, 1.0, [2], k=3)
    # 0 had two turns: the others catch up; of equals the preferred go first, then the first
    assert turns(one, 7) == [3, 1, 3, 1, 3, 0, 1]


def test_progress_gives_preferred_lists_turns_ahead() -> None:
    one = made(1)
    add(one, 1.0, [0], k=0)
    add(one, 1.0, [1], k=1)
    one.ints[SIZES + 2 + 1] = -3
    assert turns(one, 7) == [1, 1, 1, 1, 0, 1, 0]


@pytest.mark.parametrize(("key", "chosen"), [(2.0, 1), (2.1, 0)])
def test_a_preferred_operator_that_is_by_far_too_dear_waits(key: float, chosen: int) -> None:
    one = made(1)
    add(one, 1.0, [0], k=0)
    add(one, key, [1], k=1)
    assert turns(one, 1, BY_COST) == [chosen]
    other = made(1)
    add(other, 1.0, [0], k=0)
    add(other, key, [1], k=1)
    assert turns(other, 1, GREEDY) == [1]  # greedy keys are no costs


def test_a_priced_goal_waits_in_the_first_list_and_with_the_preferred_where_there_are_any() -> None:
    for preferred, expected in ((False, [0]), (True, [0, 1])):
        one = made(1)
        add(one, 1.0, [3], k=0)
        if preferred:
            add(one, 1.0, [4], k=1)
        queues.push_goal(one.ints, one.reals, one.t, one.space, 7, 5.0, 4.0, GREEDY)
        assert one.ints[GOAL_NODE] == 7 and one.ints[PUSHED] == 1
        assert [k for k in (0, 1) if GOAL_ENTRY in popped(one, k)] == expected


def collected(one: Packed, successors: list[tuple[float, float, float]]) -> int:
    """Successors by step, what is dearer, and what of it is paid; operator i is the i-th."""
    classes = 0
    for i, (step, dearer, paid) in enumerate(successors):
        classes = queues.collect(
            one.ints, one.reals, one.x, i, classes, i, i, 10.0 + i, step, dearer, paid
        )
    return classes


def test_successors_that_look_alike_are_one_class() -> None:
    one = made()
    alike = (1.0, 0.0, 0.0)
    assert collected(one, [alike, (1.0, 2.0, 0.0), alike, (1.0, 2.0, 2.0), (3.0, 0.0, 0.0)]) == 4
    x = one.x
    assert one.ints[x.class_size : x.class_size + 4].tolist() == [2, 1, 1, 1]
    assert one.ints[x.found_class : x.found_class + 5].tolist() == [0, 1, 0, 2, 3]


def pushed(
    one: Packed, successors: list[tuple[float, float, float]], preferred: int, weight: float
) -> None:
    """Push successors of the state 7, whose estimate is 4 and which costs 20."""
    classes = collected(one, successors)
    one.reals[one.space.values + 7 * one.t.heuristics] = 4.0
    one.reals[one.space.cost + 7] = 20.0
    queues.push(
        one.ints, one.reals, one.t, one.x, one.space, 7, len(successors), preferred, classes, 0,
        weight,
    )  # fmt: skip


def keys(one: Packed, k: int) -> list[tuple[float, int]]:
    """The keys of a list with the operators under them."""
    found: list[tuple[float, int]] = []
    while one.ints[SIZES + k]:
        key = float(one.reals[one.space.keys + k * one.space.groups])
        _, member = queues.pop(one.ints, one.reals, one.space, k, BY_COST)
        found.append((key, (int(one.ints[one.space.members + member]) & 0xFFFFFFFF) + GOAL_ENTRY))
    return found


def test_greedy_keys_are_estimates_and_what_guards_cost_that_the_estimate_has_not() -> None:
    one = made()
    pushed(one, [(0.0, 0.0, 0.0), (0.0, 3.0, 0.0), (0.0, 3.0, 3.0)], 0, math.inf)
    assert keys(one, 0) == [(4.0, 0), (4.0, 2), (7.0, 1)]
    assert keys(one, 1) == []


def test_with_a_weight_keys_are_costs_and_weighted_estimates() -> None:
    one = made()
    pushed(one, [(1.0, 0.0, 0.0), (2.0, 3.0, 0.0), (2.0, 3.0, 3.0)], 0, 2.0)
    # 20 + step + dearer + 2 * 4; where the relaxed plan pays the guard, it is not counted again
    assert keys(one, 0) == [(29.0, 0), (30.0, 2), (33.0, 1)]


@pytest.mark.parametrize(("weight", "key"), [(math.inf, 4.0), (2.0, 28.0)])
def test_preferred_successors_are_in_both_lists_unless_guards_make_them_dear(
    weight: float, key: float
) -> None:
    """Operator i costs i: a guard that costs more than the operator itself is dear."""
    one = made()
    alike = [(0.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 0.0)]
    pushed(one, alike, 3, weight)
    assert keys(one, 1) == [(key, 0), (key, 2)]
    assert sorted(i for _, i in keys(one, 0)) == [0, 1, 2, 3]
