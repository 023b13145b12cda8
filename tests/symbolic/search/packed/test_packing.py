"""Tasks as compressed rows and sparse masks: what is written where, on tasks small enough to see."""

from __future__ import annotations

import math
from random import Random
from typing import Any

import pytest

from tamp.symbolic.search.operators import Guard, Operator
from tamp.symbolic.search.packed.packing import (
    MOST_BUCKETS,
    CsrLists,
    Keys,
    effects_of,
    pairs_of,
    signed,
    touched,
    words_of,
)
from tests.symbolic.search.packed.room import Packed, axiom, facts, operator, packed, task


def row(made: Packed, starts: int, i: int, *columns: int) -> list[tuple[int, ...]]:
    """Row i of compressed rows of several columns."""
    first, last = made.ints[starts + i : starts + i + 2].tolist()
    return list(zip(*(made.ints[c + first : c + last].tolist() for c in columns), strict=True))


def names(made: Packed, words: list[tuple[int, ...]], column: int) -> str:
    """The facts of a sparse mask."""
    state = sum((one[column] & (1 << 64) - 1) << 64 * one[0] for one in words)
    return made.named(state)


def test_rows_are_columns_and_where_each_row_begins() -> None:
    rows = CsrLists([[(1, "a"), (2, "b")], [], [(3, "c")]], 2)
    assert rows.starts == [0, 2, 2, 3]
    assert rows.columns == ([1, 2, 3], ["a", "b", "c"])
    assert CsrLists([], 2).starts == [0] and CsrLists([[]], 2).columns == ([], [])


def test_words_have_a_sign() -> None:
    assert signed(5) == 5 and signed(1 << 63) == -(1 << 63) and signed((1 << 64) - 1) == -1
    assert words_of(1 << 63 | 3 << 64, 2) == [-(1 << 63), 3]


def test_a_sparse_mask_has_the_words_where_either_set_has_bits() -> None:
    assert pairs_of(0, 0) == []
    assert pairs_of(1 << 2, 1 << 130 | 1) == [(0, 4, 1), (2, 0, 4)]
    assert pairs_of(1 << 63, 0) == [(0, -(1 << 63), 0)]


def test_effects_keep_all_but_what_is_deleted() -> None:
    every = (1 << 70) - 1
    ((word, keep, add),) = effects_of(~(1 << 3), 1 << 5, every)
    assert (word, keep, add) == (0, ~(1 << 3), 1 << 5)
    assert effects_of(~0, 1 << 65, every) == [(1, -1, 2)]
    assert effects_of(~0, 0, every) == []
    assert effects_of(~(1 << 90), 0, every) == []  # no fact of the task


def test_touched_words_share_a_bit_62_apart() -> None:
    assert touched(0) == 0
    assert touched(1 | 1 << 64) == 0b11
    assert touched(1 << 64 * 62) == 1 and touched(1 << 64 * 63) == 2


def test_conditions_and_effects_of_an_operator() -> None:
    one = operator(
        "o", "a b", "c", absent="d", deleted="a", cost=2.0, when=[("b", "e", "f", "g")], static="s"
    )
    made = packed(task([one, operator("p")], "c f g d e"), {("s",): 0.5})
    t = made.t
    need = row(made, t.pre_starts, 0, t.pre_words, t.pre_need, t.pre_absent)
    assert names(made, need, 1) == "a b" and names(made, need, 2) == "d"
    ((_, keep, add),) = row(made, t.eff_starts, 0, t.eff_words, t.eff_keep, t.eff_add)
    assert made.named(~keep) == "a" and made.named(add) == "c"
    assert made.ints[t.con_starts : t.con_starts + 3].tolist() == [0, 1, 1]
    when = row(made, t.con_pre_starts, 0, t.con_pre_words, t.con_pre_need, t.con_pre_absent)
    assert names(made, when, 1) == "b" and names(made, when, 2) == "e"
    ((_, keep, add),) = row(
        made, t.con_eff_starts, 0, t.con_eff_words, t.con_eff_keep, t.con_eff_add
    )
    assert made.named(~keep) == "g" and made.named(add) == "f"
    assert made.reals[t.costs : t.costs + 2].tolist() == [2.5, 1.0]
    assert made.reals[t.own : t.own + 2].tolist() == [2.0, 1.0]
    assert made.ints[t.pre_touched : t.pre_touched + 2].tolist() == [1, 0]
    assert made.ints[t.eff_touched : t.eff_touched + 2].tolist() == [1, 0]


def test_a_conditional_effect_counts_among_what_an_operator_touches() -> None:
    many = " ".join(f"f{i:03}" for i in range(130))
    one = operator("o", "f000", "", when=[("f000", "", "f070", "f129")])
    made = packed(task([one], many))
    assert made.ints[made.t.pre_touched] == 0b001
    assert made.ints[made.t.eff_touched] == 0b110


def test_axioms_lie_by_strata() -> None:
    rules = [axiom("n", "a"), axiom("m", "n", "b", stratum=1), axiom("m", "m", stratum=1)]
    made = packed(task([operator("o", "m n", "g")], "g a b", axioms=rules))
    t, size = made.t, len(made.s.facts)
    assert t.strata == 2 and made.ints[t.strata_starts : t.strata_starts + 3].tolist() == [0, 1, 3]
    assert made.ints[t.recursive : t.recursive + 2].tolist() == [0, 1]
    heads = [
        made.named(int(made.ints[t.ax_bit + k]) << 64 * int(made.ints[t.ax_word + k]))
        for k in range(3)
    ]
    assert heads == ["n", "m", "m"]
    assert made.named(made.read(t.derived)) == "m n" and size < 64


def test_guards_with_their_facts_and_whom_they_make_dearer() -> None:
    one, two = Guard(facts("c"), ("clear",)), Guard(facts("c d"), None)
    operators = [
        operator("o", "a", "g", guards=(one, two)), operator("p", "a", "g", guards=(one,)),
        operator("q", "a", "g"),
    ]  # fmt: skip
    made = packed(task(operators, "g"), {("clear",): 3.0})
    t = made.t
    assert made.ints[t.guarded : t.guarded + 3].tolist() == [1, 1, 0]
    found: dict[str, list[Any]] = {}
    for number in range(t.guards):
        named = made.named(
            sum(1 << fact for (fact,) in row(made, t.guard_starts, number, t.guard_facts))
        )
        first, last = made.ints[t.fine_starts + number : t.fine_starts + number + 2].tolist()
        owners = made.ints[t.fines + first : t.fines + last].tolist()
        prices = made.reals[t.fine_prices + first : t.fine_prices + last].tolist()
        found[named] = list(zip(owners, prices, strict=True))
    assert found == {"c d": [(0, math.inf)], "c": [(0, 3.0), (1, 3.0)]}


@pytest.mark.parametrize(("price", "held"), [(2.0, False), (5.0, True)])
def test_keys_are_what_operators_wait_for_and_rises_what_they_pay(price: float, held: bool) -> None:
    """Removing c costs 3: a price below raises the operator's cost, one above makes it wait."""
    guard = Guard(facts("c"), ("clear",))
    operators = [
        operator("clear", "a", "z", deleted="c", cost=3.0),
        operator("reach", "a", "g", absent="h", guards=(guard,)),
    ]
    made = packed(task(operators, "g", "a c h"), {("clear",): price})
    keys = Keys(made.s, made.relaxation)
    bit = made.s.mask
    waiting = {(bit(facts("h")), math.inf)} | ({(bit(facts("c")), price)} if held else set())
    assert keys.members.keys() == waiting
    assert keys.rises == [[] if held else [(1, price)]]
    assert keys.held == ({1: [(0, (bit(facts("c")), price))]} if held else {})
    assert sorted(keys.number.values()) == list(range(len(waiting)))


@pytest.mark.parametrize(("cost", "buckets"), [(2.0, MOST_BUCKETS), (2.5, 0)])
def test_whole_costs_go_to_buckets(cost: float, buckets: int) -> None:
    made = packed(task([operator("o", "a", "g", cost=cost)], "g", "a"))
    assert made.r.buckets == buckets


def test_landmarks_with_weights_and_what_they_need() -> None:
    operators = [operator("ab", "a", "b", cost=2.0), operator("bg", "b", "g", cost=3.0)]
    made = packed(task(operators, "g", "a"), names=("landmarks",))
    r = made.r
    assert (r.marks, r.mark_words) == (3, 1)
    found = [made.s.facts[i][0] for i in made.ints[r.mark_facts : r.mark_facts + 3]]
    assert found == ["a", "b", "g"]
    assert made.reals[r.mark_weights : r.mark_weights + 3].tolist() == [0.0, 2.0, 3.0]
    assert made.ints[r.mark_goal : r.mark_goal + 3].tolist() == [0, 0, 1]
    assert made.ints[r.mark_absent : r.mark_absent + 3].tolist() == [0, 0, 0]
    assert [row(made, r.mark_starts, k, r.mark_needs) for k in range(3)] == [[], [(0,)], [(1,)]]
    assert packed(task(operators, "g", "a")).r.marks == 0


@pytest.mark.parametrize("seed", range(20))
def test_words_are_those_of_the_state(seed: int) -> None:
    rng = Random(seed)
    one, other = (
        rng.getrandbits(200) & rng.getrandbits(200),
        rng.getrandbits(200) & rng.getrandbits(130),
    )
    rebuilt = [0, 0]
    for w, a, b in pairs_of(one, other):
        for k, word in enumerate((a, b)):
            assert -(1 << 63) <= word < 1 << 63
            rebuilt[k] |= (word & (1 << 64) - 1) << 64 * w
    assert rebuilt == [one, other]
    assert sum((word & (1 << 64) - 1) << 64 * w for w, word in enumerate(words_of(one, 4))) == one
    assert signed((1 << 64) - 1) == -1


@pytest.mark.parametrize(
    ("idle", "price"),
    [
        (operator("idle", "", "g", static="s", guards=[Guard(facts("x"), None)]), {("s",): math.inf}),
        (operator("idle", guards=[Guard(facts("x"), None)], when=[("x", "", "", "z")]), {}),
    ],
    ids=["too dear for ever", "of effects that nobody reads"],
)  # fmt: skip
def test_a_guard_before_what_no_estimate_counts_is_left_out(
    idle: Operator, price: dict[tuple[str, ...], float]
) -> None:
    """Plain Python leaves it out, too; packing ended with a KeyError."""
    made = packed(task([idle, operator("live", "", "g", cost=2.0)], initial="x"), price)
    assert made.t.operators == 2
