"""Heuristics over packed states: by hand, and the numbers that the plain ones give."""

from __future__ import annotations

import math
from random import Random

import pytest

from tamp.symbolic.search.heuristics import registry
from tamp.symbolic.search.heuristics.landmarks import Landmarks
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import Guard
from tamp.symbolic.search.packed import estimates
from tamp.symbolic.search.packed.basics import FORGIVING
from tamp.symbolic.search.successors import State
from tests.symbolic.search.packed.room import Packed, facts, operator, packed, task
from tests.symbolic.search.test_prices import instances
from tests.symbolic.search.test_random_tasks import random_task


def explored(made: Packed, state: State | str) -> None:
    """Set up and explore the relaxation of a state."""
    bits = made.s.mask(facts(state)) if isinstance(state, str) else state
    made.write(made.x.closed, made.s.closure(bits))
    parts = made.ints, made.reals, made.t
    estimates.trigger(*parts, made.x, made.x.closed)
    estimates.relax(*parts, made.r, made.x, made.x.closed)
    estimates.explore(*parts, made.r, made.x, made.x.closed)


def ff(made: Packed, state: State | str) -> tuple[float, list[int]]:
    explored(made, state)
    cost, length = estimates.relaxed_plan(made.ints, made.reals, made.t, made.r, made.x)
    return cost, made.ints[made.x.plan : made.x.plan + length].tolist()


CHAIN = [
    operator("ab", "a", "b", cost=2.0), operator("bc", "b", "c"), operator("cg", "b c", "g"),
    operator("ag", "a", "g", cost=9.0),
]  # fmt: skip


def test_a_relaxed_plan_takes_each_operator_once() -> None:
    made = packed(task(CHAIN, "g", "a"))
    assert ff(made, "a") == (4.0, [0, 1, 2])
    assert ff(made, "b") == (2.0, [1, 2])
    assert ff(made, "g") == (0.0, [])
    assert ff(made, "c") == (math.inf, [])


def test_hadd_sums_what_a_precondition_costs() -> None:
    """By hadd b is counted twice for g (2 + 3 + 1 = 6), so that a way of 5 seems the better one."""
    operators = [*CHAIN[:3], operator("ag", "a", "g", cost=5.0)]
    made = packed(task(operators, "g", "a"))
    assert ff(made, "a") == (5.0, [3])
    reached = {
        fact[0]: float(made.reals[made.x.reached + i]) for i, fact in enumerate(made.s.facts)
    }
    assert reached == {"a": 0.0, "b": 2.0, "c": 3.0, "g": 5.0}


def test_what_must_not_hold_waits_for_what_deletes_it() -> None:
    operators = [
        operator("free", "a", "z", deleted="h", cost=3.0), operator("reach", "a", "g", absent="h"),
    ]  # fmt: skip
    made = packed(task(operators, "g", "a h"))
    assert ff(made, "a h") == (4.0, [0, 1])
    assert ff(made, "a") == (1.0, [1])
    never = packed(task(operators[1:], "g", "a h"))
    assert ff(never, "a h") == (math.inf, [])


def test_a_goal_that_must_not_hold() -> None:
    made = packed(task([operator("free", "a", "", deleted="h", cost=3.0)], "", "a h", (), "h"))
    assert ff(made, "a h") == (3.0, [0])
    assert ff(made, "a") == (0.0, [])


@pytest.mark.parametrize(
    ("price", "cost", "plan", "paid"),
    [(2.0, 3.0, [1], 2.0), (5.0, 4.0, [0, 1], 0.0), (math.inf, 4.0, [0, 1], 0.0)],
)
def test_a_triggered_guard_is_paid_for_or_its_facts_removed_whichever_is_cheaper(
    price: float, cost: float, plan: list[int], paid: float
) -> None:
    """Removing c costs 3 alone."""
    guard = Guard(facts("c"), None if price == math.inf else ("clear",))
    operators = [
        operator("clear", "a", "z", deleted="c", cost=3.0),
        operator("reach", "a", "g", guards=(guard,)),
    ]
    prices = {} if price == math.inf else {("clear",): price}
    made = packed(task(operators, "g", "a c"), prices)
    assert ff(made, "a c") == (cost, plan)
    assert estimates.paid(made.ints, made.reals, made.r, made.x, 1) == paid
    assert ff(made, "a") == (1.0, [1])
    assert estimates.paid(made.ints, made.reals, made.r, made.x, 1) == 0.0


def test_a_guards_price_is_paid_where_removing_its_facts_takes_other_steps_first() -> None:
    """Removing costs 1, but only from y, which costs 9: the relaxed plan pays the 5."""
    guard = Guard(facts("c"), ("clear",))
    operators = [
        operator("clear", "y", "z", deleted="c"), operator("reach", "a", "g", guards=(guard,)),
        operator("far", "a", "y", cost=9.0),
    ]  # fmt: skip
    made = packed(task(operators, "g", "a c"), {("clear",): 5.0})
    assert ff(made, "a c") == (6.0, [1])
    assert estimates.paid(made.ints, made.reals, made.r, made.x, 1) == 5.0


@pytest.mark.parametrize(
    ("goal", "cost", "plan", "paid"), [("g", 6.0, [1], 5.0), ("g z", 11.0, [0, 1, 2], 0.0)]
)
def test_a_guard_is_forgiven_whose_facts_the_plan_removes_for_another_goal(
    goal: str, cost: float, plan: list[int], paid: float
) -> None:
    """To remove c for the guard's sake is too dear; for z the plan has it anyway."""
    guard = Guard(facts("c"), ("clear",))
    operators = [
        operator("clear", "y", "z", deleted="c"), operator("reach", "a", "g", guards=(guard,)),
        operator("far", "a", "y", cost=9.0),
    ]  # fmt: skip
    made = packed(task(operators, goal, "a c"), {("clear",): 5.0})
    assert ff(made, "a c") == (cost + 5.0 - paid, plan)
    made.ints[FORGIVING] = 1
    assert ff(made, "a c") == (cost, plan)
    assert estimates.paid(made.ints, made.reals, made.r, made.x, 1) == paid


def test_triggered_guards_add_up_and_are_taken_back() -> None:
    one, two = Guard(facts("c"), ("one",)), Guard(facts("c d"), ("two",))
    made = packed(
        task([operator("reach", "a", "g", guards=(one, two))], "g", "a"),
        {("one",): 2.0, ("two",): 4.0},
    )
    extras = {"c": 2.0, "c d": 6.0, "d": 0.0, "": 0.0}
    for text in ("c d", "c", "d", "c d", ""):
        made.write(made.x.closed, facts(text))
        estimates.trigger(made.ints, made.reals, made.t, made.x, made.x.closed)
        assert made.reals[made.x.extras] == extras[text]


@pytest.mark.parametrize("block", range(4))
def test_random_tasks_get_the_numbers_of_plain_python(block: int) -> None:
    finite = 0
    for seed in range(25 * block, 25 * block + 25):
        rng = Random(seed)
        made = packed(instantiate(random_task(rng)))
        finite += compared(made, rng)
    assert finite > 40


def test_priced_guards_get_the_numbers_of_plain_python() -> None:
    finite = 0
    for seed in range(4):
        _, prices, listed, _ = instances(seed)
        finite += compared(packed(listed, prices), Random(seed), 4)
    assert finite > 8


def compared(made: Packed, rng: Random, steps: int = 6) -> int:
    """Walk at random, and compare costs, supporters and relaxed plans; count the finite ones."""
    state, finite, estimate = made.s.initial, 0, registry.ff(made.s)
    for _ in range(steps):
        after = made.s.closure(state)
        found, chosen = ff(made, state)
        plain = estimate(after)
        assert (found, sorted(chosen)) == (plain.value, sorted(plain.plan))
        if plain.paid is not None:
            finite += 1
            for index in plain.plan:
                expected = plain.paid(index)
                assert estimates.paid(made.ints, made.reals, made.r, made.x, index) == expected
        steps_on = made.s.applicable(after)
        if not steps_on:
            break
        state = made.s.apply(rng.choice(steps_on), state, after)
    return finite


def landmark_costs(made: Packed, walk: list[str]) -> list[float]:
    """What the landmarks cost in the states of a walk, each the parent of the next."""
    costs: list[float] = []
    for node, text in enumerate(walk):
        made.write(made.x.closed, made.s.closure(made.s.mask(facts(text))))
        costs.append(
            estimates.landmarks(
                made.ints, made.reals, made.r, made.x, made.space, made.x.closed, node, node - 1
            )
        )
    return costs


def test_landmarks_count_until_they_were_there_and_again_where_needed() -> None:
    operators = [
        operator("ab", "a", "b", deleted="a", cost=2.0), operator("bc", "b", "c", deleted="b"),
        operator("ca", "c", "a d", deleted="c"), operator("dg", "a d", "g", deleted="d"),
    ]  # fmt: skip
    task_ = task(operators, "g d", "a")
    made = packed(task_, names=("landmarks",))
    # b 2, c 1, d 1, g 1 (a: ca makes it again for 1 where it is needed)
    assert landmark_costs(made, ["a"]) == [5.0]
    walk = ["a", "b", "c", "a d", "a g"]
    plain = Landmarks(made.s)
    expected: list[float] = []
    before: State | None = None
    for text in walk:
        closed = made.s.mask(facts(text))
        expected.append(plain.cost(plain.remaining(closed, before)))
        before = closed
    assert landmark_costs(made, walk) == expected
    assert expected[-1] == 1.0  # d, a goal, is gone again
