"""The packed search's arrays: what lies where, and that it is all still there after they have grown."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from tamp.symbolic.search.packed import basics, states
from tamp.symbolic.search.packed.arrays import Space
from tamp.symbolic.search.packed.compiled import KINDS, PARTS, Arena
from tests.symbolic.search.packed.room import Packed, facts, operator, packed, task

MANY = " ".join(f"f{i:03}" for i in range(70))
"""Facts of two words."""


def made(rooms: tuple[int, int, int]) -> Packed:
    way = operator("o", "a", f"g {MANY}")
    return packed(task([way], f"g {MANY}", "a"), names=("ff", "landmarks"), rooms=rooms)


def test_numbers_are_placed_one_behind_the_other_behind_the_counters() -> None:
    arena = Arena(3, 2)
    assert [arena.integers([7, 8]), arena.integers([]), arena.integers([9])] == [3, 5, 5]
    assert [arena.room(0, 4, -1), arena.integers([1])] == [6, 10]
    assert [arena.reals([0.5]), arena.room(1, 2), arena.reals([1.5])] == [2, 3, 5]


def lengths(one: Packed, space: Space) -> dict[str, int]:
    """How many numbers each growing part has: of two words a state, two heuristics, four lists."""
    wide = {"states": one.t.words, "values": 2, "marks": one.r.mark_words}
    lists = dict.fromkeys(("ties", "items", "keys"), 4 * space.groups)
    members = dict.fromkeys(("members", "member_cost"), space.pool)
    groups = dict.fromkeys(("group_parent", "group_next", "group_end", "group_base"), space.groups)
    found = {name: space.nodes * wide.get(name, 1) for names in PARTS for name in names}
    return {**found, **lists, **members, **groups}


def test_the_growing_parts_lie_behind_all_others_and_none_upon_another() -> None:
    one = made((5, 7, 11))
    assert one.t.words == 2 and one.r.mark_words == 2
    sizes = lengths(one, one.space)
    for array, names in zip((one.ints, one.reals), PARTS, strict=True):
        ranges = sorted((getattr(one.space, name), sizes[name]) for name in names)
        assert len(array) == sum(ranges[-1])
        assert all(at + size == after for (at, size), (after, _) in pairwise(ranges))
    assert one.x.closed < one.space.table < one.space.states


def test_the_hash_table_is_a_power_of_two_and_at_most_half_full() -> None:
    for nodes, size in ((1, 4), (3, 8), (4, 16), (7, 16), (8, 32)):
        one = made((nodes, 7, 11))
        assert one.space.mask == size - 1
        table = one.ints[one.space.table : one.space.table + size]
        assert table.tolist() == [-1] * size  # and no state has been there
        evaluated = one.ints[one.space.evaluated : one.space.evaluated + nodes]
        assert evaluated.tolist() == [0] * nodes


def written(one: Packed, name: str, space: Space, arrays: tuple[Any, Any]) -> list[list[float]]:
    """A part's lists, each as long as what is in it: two states, three groups, five members."""
    array = arrays[0] if name in PARTS[0] else arrays[1]
    at, all_ = getattr(space, name), lengths(one, space)[name]
    if name in ("ties", "items", "keys"):
        sizes = (2, 0, 1, 3)
        return [array[at + k * space.groups :][:size].tolist() for k, size in enumerate(sizes)]
    if name.startswith(("group", "member")):
        return [array[at:][: 3 if name.startswith("group") else 5].tolist()]
    return [array[at:][: 2 * all_ // space.nodes].tolist()]


def test_what_was_in_the_arrays_is_there_when_they_have_grown() -> None:
    one = made((3, 4, 6))
    rng = np.random.default_rng(0)
    for array, start, kind in ((one.ints, one.space.states, 0), (one.reals, one.space.cost, 1)):
        array[start:] = rng.integers(1, 10**9, len(array) - start).astype(KINDS[kind])
    one.ints[[basics.NODES, basics.GROUPS, basics.MEMBERS]] = 2, 3, 5
    one.ints[basics.SIZES : basics.SIZES + 4] = 2, 0, 1, 3
    parts = [name for names in PARTS for name in names]
    before = {name: written(one, name, one.space, (one.ints, one.reals)) for name in parts}
    placed = one.ints[: one.space.table].tolist(), one.reals[: one.space.cost].tolist()

    arrays = [one.ints, one.reals]
    space = one.arena.grow(one.t, one.r, one.space, arrays, (6, 9, 12))

    assert space[:3] == (6, 9, 12)
    assert (arrays[0][: space.table].tolist(), arrays[1][: space.cost].tolist()) == placed
    grown = arrays[0], arrays[1]
    assert {name: written(one, name, space, grown) for name in parts} == before
    assert arrays[0][space.evaluated + 2 : space.evaluated + 6].tolist() == [0] * 4


def test_closed_states_are_found_again_in_the_larger_table() -> None:
    one = made((3, 4, 6))
    for node, text in enumerate(("a", f"a g {MANY}")):
        one.write(one.space.states + node * one.t.words, facts(text))
    one.ints[basics.NODES] = 2
    arrays = [one.ints, one.reals]
    space = one.arena.grow(one.t, one.r, one.space, arrays, (9, 4, 6))
    with np.errstate(over="ignore"):
        for node in range(2):
            state = space.states + node * one.t.words
            place = states.place_of(
                arrays[0], one.t.words, state, space.states, space.table, space.mask
            )
            assert arrays[0][space.table + place] == node
    assert sorted(arrays[0][space.table : space.table + space.mask + 1])[-3:] == [-1, 0, 1]
