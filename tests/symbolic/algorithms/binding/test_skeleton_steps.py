"""Steps of a skeleton from an instantiated plan; what binding learned as guards of the next search."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.errors import InputError
from tamp.stream import Rejection
from tamp.symbolic.algorithms.binding.skeleton import Step, Usage
from tamp.symbolic.algorithms.binding.skeleton_steps import NOGOOD_PREDICATE, to_steps, with_nogoods
from tamp.symbolic.algorithms.experience.stream_statistics import PRICE_PER_FAILURE, Experience
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Guard, InstantiatedTask, Operator
from tamp.symbolic.search.search import Plan, search
from tests.symbolic.search.packed.room import axiom, facts, operator, task

HIT = Rejection("hits the box")


def two_ways() -> InstantiatedTask:
    """A short way over a static fact, and one of two operators that needs none."""
    return task(
        [
            operator("around", "a", "b"), operator("on", "b", "g"),
            operator("short", "a", "g", static="reach"),
        ],
        "g", "a c",
    )  # fmt: skip


def learned(*failures: tuple[str, str, int]) -> Experience:
    experience = Experience()
    for fact, present, times in failures:
        for _ in range(times):
            experience.record_nogood((fact,), facts(present), HIT)
    return experience


def names(instantiated: InstantiatedTask, prices: dict[Fact, float]) -> list[str]:
    found = search(instantiated, search="astar", heuristic="blind", price=prices)
    assert found.plan is not None
    return [one.name for one in found.plan.operators]


def test_without_anything_learned_the_task_is_as_it_was() -> None:
    instantiated = two_ways()
    assert with_nogoods(instantiated, Experience()) == (instantiated, {})


@pytest.mark.parametrize(
    ("present", "times", "way"),
    [("c", 2, ["short"]), ("c", 3, ["around", "on"]), ("c a", 3, ["around", "on"]), ("d", 9, ["short"])],
)  # fmt: skip
def test_a_way_that_failed_is_dearer_while_what_was_to_blame_is_there(
    present: str, times: int, way: list[str]
) -> None:
    """The short way saves 1: 2 failures cost 0.8, 3 cost 1.2; nothing where d, which is not there, was to blame."""
    guarded, prices = with_nogoods(two_ways(), learned(("reach", present, times)))
    assert sorted(prices.values()) == [pytest.approx(PRICE_PER_FAILURE * times)]
    assert names(guarded, prices) == way


def test_prices_of_several_lessons_add_up_and_each_is_one_of_its_own() -> None:
    """Of the same fact under two conditions, both there: 0.8 + 0.8 > 1."""
    guarded, prices = with_nogoods(two_ways(), learned(("reach", "c", 2), ("reach", "a", 2)))
    assert len(prices) == 2
    assert names(guarded, prices) == ["around", "on"]


def test_only_operators_that_rest_on_the_fact_are_guarded_beside_their_own_guards() -> None:
    own = Guard(facts("d"), ("clear",))
    instantiated = two_ways()
    instantiated = replace(
        instantiated,
        operators=tuple(replace(one, guards=(own,)) for one in instantiated.operators),
    )
    guarded, prices = with_nogoods(instantiated, learned(("reach", "c", 1), ("other", "c", 1)))
    by_name = {one.name: one for one in guarded.operators}
    assert by_name["around"].guards == (own,) == by_name["on"].guards
    first, second = by_name["short"].guards
    assert first == own
    assert second.facts == facts("c")
    assert second.waived_by in prices
    assert second.waived_by[0] == NOGOOD_PREDICATE


def test_no_pddl_name_is_the_nogoods() -> None:
    with pytest.raises(InputError):
        parse_domain(f"(define (domain d) (:predicates ({NOGOOD_PREDICATE} ?x)))")


def steps_of(
    instantiated: InstantiatedTask, *operators: Operator, prices: dict[Fact, float] | None = None
) -> tuple[Step, ...]:
    return to_steps(instantiated, Plan(operators, 0.0), prices or {})[0]


def test_a_step_tells_the_state_before_it_and_what_it_changes() -> None:
    """Deleted is only what was there, added also what was; costs are the action's own."""
    first = operator("go", "a", "b", deleted="a z", cost=2.0, static="s")
    last = operator("take", "b", "g b", cost=3.0)
    one, two = steps_of(task([first, last], "g", "a y"), first, last)
    assert (one.state, two.state) == (facts("a y"), facts("b y"))
    assert (one.read, two.read) == (facts("a"), facts("b"))
    assert (one.added, one.deleted, one.static) == (facts("b"), facts("a"), facts("s"))
    assert (two.added, two.deleted, two.static) == (facts("g b"), facts(""), facts(""))
    assert (one.cost, two.cost) == (2.0, 3.0)


def test_tests_that_the_state_asks_for_are_usages_and_nogoods_are_none() -> None:
    """A guard whose facts are not there asks for nothing."""
    guards = [
        Guard(facts("c"), ("clear-c",)), Guard(facts("b a"), ("clear-ba",)), Guard(facts("e"), ("clear-e",)),
    ]  # fmt: skip
    reach = operator("reach", "a", "g", guards=guards, static="reach")
    guarded, prices = with_nogoods(task([reach], "g", "a b c"), learned(("reach", "a", 1)))
    (step,) = steps_of(guarded, *guarded.operators, prices=prices)
    assert step.usages == (Usage(("clear-ba",), facts("a b")), Usage(("clear-c",), facts("c")))
    assert step.static == facts("reach")


def test_what_is_derived_counts_with_what_it_is_derived_from_most_cheaply() -> None:
    rules = [
        replace(axiom("done", "a"), static=facts("dear")),
        replace(axiom("done", "c"), static=facts("cheap")),
    ]
    reach = operator("reach", "done", "g", static="s")
    instantiated = task([reach], "g", "a c", rules)
    prices: dict[Fact, float] = {("dear",): 5.0, ("cheap",): 1.0}
    (step,) = steps_of(instantiated, reach, prices=prices)
    assert (step.derived, step.static, step.read) == (facts("cheap"), facts("cheap s"), facts("c"))
    (other,) = steps_of(instantiated, reach, prices={("cheap",): 9.0})
    assert (other.derived, other.read) == (facts("dear"), facts("a"))


def test_a_plan_that_does_not_hold_is_no_skeleton() -> None:
    first, last = operator("go", "a", "b", deleted="a"), operator("take", "b", "g")
    with pytest.raises(ValueError, match="not applicable"):
        steps_of(task([first, last], "g", "a"), last)
    with pytest.raises(ValueError, match="goal"):
        steps_of(task([first, last], "g", "a"), first)
