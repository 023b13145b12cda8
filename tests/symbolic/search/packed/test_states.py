"""States over words: derived facts, effects, the hash table, applicability, plans without idle steps."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest

from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import Guard
from tamp.symbolic.search.packed import states
from tamp.symbolic.search.successors import State
from tests.symbolic.search.packed.room import Packed, axiom, facts, operator, packed, task
from tests.symbolic.search.test_random_tasks import random_task


def closed(made: Packed, text: str) -> str:
    made.write(made.x.closed, facts(text))
    states.close_state(made.ints, made.t, made.x.closed)
    return made.named(made.read(made.x.closed))


def applied(made: Packed, index: int, text: str) -> str:
    """The state after an operator, without its derived facts."""
    state = made.write(made.x.rooms, facts(text))
    made.write(made.x.closed, made.s.closure(state))
    states.apply(made.ints, made.t, index, made.x.rooms, made.x.closed, made.x.after)
    assert made.read(made.x.rooms) == state
    return made.named(made.read(made.x.after))


def test_derived_facts_follow_in_a_stratum_in_any_order_and_negation_in_the_next() -> None:
    """c from b from a though written the other way round; n where c is not derived."""
    rules = [axiom("c", "b"), axiom("b", "c"), axiom("b", "a"), axiom("n", "", "c", stratum=1)]
    made = packed(task([operator("o", "n", "g")], "g n c b", axioms=rules))
    assert closed(made, "a") == "a b c"
    assert closed(made, "") == "n"
    assert closed(made, "g") == "g n"


def test_adding_wins_over_deleting() -> None:
    first = operator("o", "", "a", deleted="a b")
    made = packed(task([first], "a b c"))
    assert applied(made, 0, "a b c") == "a c"
    assert applied(made, 0, "") == "a"


def test_conditional_effects_look_at_the_state_before_and_adding_wins_among_all() -> None:
    when = [("a", "", "b", "c"), ("b", "", "d", ""), ("", "d", "c", "e"), ("e", "", "", "a b")]
    made = packed(task([operator("o", "", "e", when=when)], "a b c d e"))
    assert applied(made, 0, "a") == "a b c e"  # b was not there before, so no d
    assert applied(made, 0, "a c d") == "a b d e"  # d is there: c is only deleted
    assert applied(made, 0, "a b c d e") == "b d e"


def test_effects_reach_beyond_the_first_word() -> None:
    many = " ".join(f"f{i:03}" for i in range(150))
    made = packed(task([operator("o", "f149", "f100", deleted="f149 f070")], many))
    assert made.t.words == 3
    assert applied(made, 0, "f001 f070 f149") == "f001 f100"


def test_a_condition_of_an_effect_may_be_derived() -> None:
    one = operator("o", "", "", when=[("n", "", "b", "")])
    made = packed(task([one], "a b n", axioms=[axiom("n", "a")]))
    assert applied(made, 0, "a") == "a b"
    assert applied(made, 0, "") == ""


def applicable(made: Packed, state: State) -> list[int]:
    made.write(made.x.closed, state)
    count = states.applicable(made.ints, made.t, made.x, made.x.closed)
    return made.ints[made.x.applicable : made.x.applicable + count].tolist()


def test_operators_whose_conditions_hold() -> None:
    operators = [
        operator("two", "a b", "g"), operator("never", "z", "g"), operator("any", "", "g"),
        operator("not", "a", "g", absent="c"),
    ]  # fmt: skip
    made = packed(task(operators, "g a b c z"))
    for text, names in (("a b", {0, 2, 3}), ("a c", {2}), ("", {2}), ("a b c z", {0, 1, 2})):
        assert set(applicable(made, made.s.mask(facts(text)))) == names


@pytest.mark.parametrize("block", range(4))
def test_random_tasks_are_walked_as_plain_python_walks_them(block: int) -> None:
    steps = 0
    for seed in range(30 * block, 30 * block + 30):
        rng = Random(seed)
        made = packed(instantiate(random_task(rng)))
        state = made.s.initial
        for _ in range(8):
            made.write(made.x.closed, state)
            states.close_state(made.ints, made.t, made.x.closed)
            after = made.s.closure(state)
            assert made.read(made.x.closed) == after
            assert bool(states.covers(made.ints, made.t, made.x.closed)) is made.s.holds_goal(after)
            found = applicable(made, after)
            assert found == made.s.applicable(after)
            if not found:
                break
            index = rng.choice(found)
            made.write(made.x.rooms, state)
            states.apply(made.ints, made.t, index, made.x.rooms, made.x.closed, made.x.after)
            state = made.s.apply(index, state, after)
            assert made.read(made.x.after) == state
            steps += 1
    assert steps > 60


def test_the_goal_wants_facts_and_their_absence() -> None:
    made = packed(task([operator("o", "", "g")], "g a", goal_absent="b"))
    for text, holds in (("g a", True), ("g", False), ("g a b", False)):
        made.write(made.x.closed, facts(text))
        assert bool(states.covers(made.ints, made.t, made.x.closed)) is holds


def test_a_state_has_one_place_in_the_hash_table() -> None:
    """Two words a state, a table of 16 for ten states: places are taken, and found again."""
    words, table, first, mask = 2, 0, 16, 15
    ints = np.full(60, -1, dtype=np.int64)
    rng = Random(1)
    for node in range(10):
        ints[first + 2 * node : first + 2 * node + 2] = [rng.randrange(9), rng.randrange(1 << 62)]
    with np.errstate(over="ignore"):
        states.rehash(ints, words, first, table, mask, 10)
        assert sorted(ints[:16]) == [-1] * 6 + list(range(10))
        for node in range(10):
            ints[50:52] = ints[first + 2 * node : first + 2 * node + 2]
            place = states.place_of(ints, words, 50, first, table, mask)
            assert ints[table + place] == node
        ints[51] += 1  # a state that is not there
        assert ints[table + states.place_of(ints, words, 50, first, table, mask)] == -1


def test_shuffling_keeps_all_and_is_the_seeds_alone() -> None:
    orders: set[tuple[int, ...]] = set()
    with np.errstate(over="ignore"):
        for seed in range(1, 60):
            ints = np.arange(10, dtype=np.int64)
            after = states.shuffle(ints, np.int64(seed * 7919), 3, 5)
            again = np.arange(10, dtype=np.int64)
            assert states.shuffle(again, np.int64(seed * 7919), 3, 5) == after != seed * 7919
            assert (ints == again).all()
            assert (ints[:3] == [0, 1, 2]).all() and (ints[8:] == [8, 9]).all()
            assert sorted(ints[3:8]) == [3, 4, 5, 6, 7]
            orders.add(tuple(ints))
    assert len(orders) > 30


def test_a_step_costs_its_prices_and_is_refused_where_it_cannot_be_taken() -> None:
    guard = Guard(facts("c"), ("clear",))
    one = operator("o", "a", "b", deleted="a", cost=2.0, guards=(guard,), static="s")
    made = packed(task([one], "b a c"), {("clear",): 5.0, ("s",): 0.5})
    ints, reals, t, x = made.ints, made.reals, made.t, made.x
    for text, cost, after in (("a", 2.5, "b"), ("a c", 7.5, "b c"), ("c", -1.0, "c")):
        made.write(x.rooms, facts(text))
        assert states.take(ints, reals, t, x, x.rooms, 0, 0) == cost
        assert made.named(made.read(x.rooms)) == after


def eliminated(made: Packed, plan: list[int], initial: str) -> tuple[list[int], float]:
    places, kept = made.space.ties, made.space.items
    made.ints[places : places + len(plan)] = plan
    made.write(made.x.rooms, facts(initial))
    count, cost = states.eliminate(
        made.ints, made.reals, made.t, made.x, made.x.rooms, places, kept, len(plan)
    )
    return made.ints[kept : kept + count].tolist(), cost


def test_steps_that_the_goal_does_not_need_go() -> None:
    operators = [
        operator("idle", "a", "z", cost=3.0), operator("there", "a", "b", deleted="a"),
        operator("back", "b", "a", deleted="b"), operator("reach", "a", "g", cost=2.0),
        operator("after", "z", "y"),
    ]  # fmt: skip
    made = packed(task(operators, "g", "a"))
    assert eliminated(made, [0, 1, 2, 4, 3], "a") == ([3], 2.0)
    assert eliminated(made, [3], "a") == ([3], 2.0)
    assert eliminated(made, [1, 2, 1, 2, 3], "a") == ([3], 2.0)


def test_a_step_that_makes_others_dearer_when_it_goes_stays() -> None:
    """Clearing costs 1; without it the reach pays 5 for the guard."""
    guard = Guard(facts("c"), ("clear",))
    operators = [
        operator("clear", "c", "z", deleted="c"), operator("reach", "a", "g", guards=(guard,)),
    ]  # fmt: skip
    made = packed(task(operators, "g", "a c"), {("clear",): 5.0})
    assert eliminated(made, [0, 1], "a c") == ([0, 1], 2.0)
    cheap = packed(task(operators, "g", "a c"), {("clear",): 0.5})
    assert eliminated(cheap, [0, 1], "a c") == ([1], 1.5)


def followed(made: Packed, plan: list[int], initial: str, out: int) -> tuple[float, int, list[int]]:
    place = made.space.ties
    made.ints[place : place + len(plan)] = plan
    made.write(made.x.rooms, facts(initial))
    cost, end = states.follow(
        made.ints, made.reals, made.t, made.x, made.x.rooms, place, 0, len(plan), out
    )
    assert made.named(made.read(made.x.rooms)) == initial
    return cost, end, made.ints[place : place + len(plan)].tolist()


def test_a_plan_is_followed_past_what_does_not_apply() -> None:
    operators = [operator("no", "z", "y"), operator("ab", "a", "b"), operator("bg", "b", "g")]
    made = packed(task(operators, "g", "a"))
    assert followed(made, [0, 1, 2], "a", -1) == (2.0, -1, [0, 1, 2])
    assert followed(made, [0, 1, 2], "a", 0) == (2.0, 2, [1, 2, 2])
    assert followed(made, [0, 2], "a", -1)[0] == math.inf


def preferred(made: Packed, plan: list[int], state: str) -> list[int]:
    x = made.x
    bits = made.write(made.space.states, facts(state))
    closed = made.s.closure(bits)
    made.ints[x.is_applicable : x.is_applicable + made.t.operators] = 0
    for index in applicable(made, closed):
        made.ints[x.is_applicable + index] = 1
    made.ints[x.is_helpful : x.is_helpful + made.t.operators] = 0
    made.ints[x.plan : x.plan + len(plan)] = plan
    count = states.preferred(made.ints, made.t, x, made.space, 0, x.closed, len(plan))
    found = made.ints[x.helpful : x.helpful + count].tolist()
    assert {i for i in range(made.t.operators) if made.ints[x.is_helpful + i]} == set(found)
    return found


def test_preferred_operators_break_few_of_the_others_and_make_many_possible() -> None:
    operators = [
        operator("breaks", "a", "p", deleted="b"),  # takes what `makes` needs
        operator("makes", "b", "c"),  # makes `late` possible
        operator("plain", "a", "q"),
        operator("late", "c", "g"),
    ]
    made = packed(task(operators, "g p q", "a b"))
    assert preferred(made, [0, 1, 2, 3], "a b") == [1, 2, 0]
    assert preferred(made, [3], "a b") == []


def test_what_reaches_a_landmark_for_the_first_time_is_preferred_too() -> None:
    operators = [operator("ab", "a", "b"), operator("bg", "b", "g"), operator("idle", "a", "z")]
    made = packed(task(operators, "g", "a"), names=("ff", "landmarks"))
    x = made.x
    made.write(x.closed, facts("a"))
    count = states.applicable(made.ints, made.t, x, x.closed)
    made.ints[x.is_helpful : x.is_helpful + 3] = 0

    def found(marks: int) -> list[int]:
        made.ints[made.space.marks] = marks
        made.ints[x.is_helpful : x.is_helpful + 3] = 0
        total = states.achievers(made.ints, made.t, made.r, x, made.space, 0, 0, count)
        return made.ints[x.helpful : x.helpful + total].tolist()

    assert made.r.marks == 3  # a, b, g
    assert found(0b001) == [0]
    assert found(0b111) == []
