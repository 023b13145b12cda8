"""The delete relaxation as rows: what becomes a relaxed operator, and what states share."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tamp.symbolic.search.heuristics import relaxation as module
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import axiom, facts, operator, task


def relaxed(
    instantiated: InstantiatedTask, price: dict[str, float] | None = None, *, steps: bool = True
) -> tuple[Successors, Relaxation]:
    s = Successors(instantiated, {(name,): cost for name, cost in (price or {}).items()})
    return s, Relaxation(s, steps=steps)


def rows(instantiated: InstantiatedTask) -> list[tuple[int, str, float, str]]:
    """Each relaxed operator: whose it is, what it needs, its cost, what it gives; absence with a minus."""
    s, made = relaxed(instantiated)
    size = len(s.facts)

    def named(listed: list[int]) -> str:
        return " ".join(
            s.facts[one][0] if one < size else f"-{s.facts[one - size][0]}" for one in listed
        )

    return [
        (owner, named(before), cost, named(effects))
        for owner, before, cost, effects in zip(
            made.owner_list, made.before, made.costs, made.effects, strict=True
        )
    ]


def test_conditional_effects_and_axioms_are_operators_of_their_own() -> None:
    way = operator("o", "a", "b", cost=2.0, when=[("c", "", "d", ""), ("e", "", "f", "")])
    made = task([way], "g b d f", "a c e", [axiom("g", "d f")])
    assert rows(made) == [
        (0, "a", 2.0, "b"), (0, "a c", 2.0, "d"), (0, "a e", 2.0, "f"), (-1, "d f", 0.0, "g"),
    ]  # fmt: skip


def test_an_operator_that_changes_only_on_a_condition_has_no_row_for_nothing() -> None:
    assert rows(task([operator("o", "a", "", when=[("c", "", "d", "")])], "d", "a c")) == [
        (0, "a c", 1.0, "d")
    ]
    assert rows(task([operator("idle", "a", "")], "a", "a")) == [(0, "a", 1.0, "")]


def test_deleting_gives_the_absence_that_somebody_needs_unless_it_is_added_as_well() -> None:
    ways = [
        operator("free", "a", "b", deleted="h u b"), operator("go", "b", "g", absent="h b"),
        operator("use", "u", "g"),
    ]  # fmt: skip
    assert rows(task(ways, "g", "a h u"))[0] == (0, "a", 1.0, "b -h")


@pytest.mark.parametrize(("steps", "costs"), [(True, [1.0, 3.0]), (False, [0.0, 2.0])])
def test_where_a_step_is_free_all_cost_one_more_if_steps_count(
    steps: bool, costs: list[float]
) -> None:
    ways = [operator("ab", "a", "b", cost=0.0), operator("bg", "b", "g", cost=2.0)]
    assert relaxed(task(ways, "g", "a"), steps=steps)[1].costs == costs
    assert relaxed(task(ways[1:], "g", "b"), steps=steps)[1].costs == [2.0]


def test_the_prices_of_a_rule_count_only_where_they_need_not_be_admissible() -> None:
    rule = replace(axiom("g", "a"), static=facts("dear"))
    made = task([operator("o", "b", "a")], "g", "b", [rule])
    assert relaxed(made, {"dear": 4.0})[1].costs == [1.0, 4.0]
    assert relaxed(made, {"dear": 4.0}, steps=False)[1].costs == [1.0, 0.0]


def test_an_operator_of_infinite_price_is_none() -> None:
    ways = [operator("o", "a", "g", static="never"), operator("p", "a", "g", cost=5.0)]
    assert relaxed(task(ways, "g", "a"), {"never": math.inf})[1].owner_list == [1]


def test_a_state_holds_its_facts_and_the_absences_that_the_goal_names() -> None:
    s, made = relaxed(task([operator("o", "a", "g", deleted="h")], "g", "a h", (), "h"))
    size = len(s.facts)
    absent = size + s.number["h",]
    assert made.goals == [s.number["g",], absent]
    assert made.holding(s.mask(facts("a h"))) == [s.number["a",], s.number["h",]]
    assert made.holding(s.mask(facts("a"))) == [s.number["a",], absent]
    assert made.removal[s.number["h",]] == 1.0 and made.removal[s.number["a",]] == math.inf


def test_states_that_violate_the_same_share_their_relaxed_task(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a, b, h and k the last two must not hold somewhere; there is room for two tasks."""
    ways = [operator("ab", "a", "b", deleted="h k"), operator("go", "b", "g", absent="h k")]
    s, made = relaxed(task(ways, "g", "a h"))
    one, same, other, third = (s.mask(facts(text)) for text in ("a h", "b h", "a", "a h k"))
    assert made.key(one) == made.key(same) != made.key(other)
    monkeypatch.setattr(module, "MAX_RELAXED_STATES", 2)
    first, plain = made.relaxed_state(one), made.relaxed_state(other)
    assert made.relaxed_state(same) is first and first is not plain
    assert first.facts == plain.facts + 1  # what waits for h to be gone
    assert made.relaxed_state(third).facts == plain.facts + 2
    assert made.relaxed_state(one) is not first


def test_explorations_sum_or_take_the_dearest_and_plans_count_each_operator_once() -> None:
    ways = [
        operator("ab", "a", "b", cost=2.0), operator("bc", "b", "c"), operator("cg", "b c", "g"),
    ]  # fmt: skip
    s, made = relaxed(task(ways, "g", "a"))
    additive = made.explore(s.initial, additive=True)
    assert additive.goal_costs == [2.0 + 3.0 + 1.0]
    assert made.explore(s.initial, additive=False).goal_costs == [3.0 + 1.0]
    cost, plan = made.plan(additive)
    assert (cost, sorted(plan)) == (4.0, [0, 1, 2])
