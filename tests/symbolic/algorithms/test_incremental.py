"""The incremental algorithm's own decisions: what a level draws, when it ends, and what needs no draw."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tamp.stream import Call
from tamp.symbolic.algorithms import incremental as module
from tamp.symbolic.algorithms.incremental import (
    DRAWS_PER_LEVEL,
    plan_incrementally,
    start_incremental,
)
from tamp.symbolic.algorithms.planning_run import Run
from tamp.symbolic.algorithms.result import Outcome, StreamTask
from tamp.system.deadline import Deadline, OutOfTime
from tests.symbolic.algorithms.binding.shelf import DOMAIN, STREAMS
from tests.symbolic.algorithms.toys import stream_task


def problem(
    goal: str,
    poses: Callable[..., Iterator[int]],
    clear: Callable[[str, int], bool] = lambda cup, pose: True,
    cups: str = "tea mug",
    domain: str = DOMAIN,
) -> StreamTask:
    functions: dict[str, Callable[..., Any]] = {
        "sample-pose": poses,
        "test-clear": lambda cup, pose, call: clear(cup, pose),
    }
    objects = {name: ("cup",) for name in cups.split()}
    return stream_task(domain, STREAMS, functions, objects, "", goal)


def started(made: StreamTask, seconds: float = 20.0, pruned: bool = True) -> Run:
    return start_incremental(
        made, random.Random, Deadline(seconds), lambda effort: None, pruned=pruned
    )


def endless(cup: str, call: Call) -> Iterator[int]:
    number = 0
    while True:
        yield (number := number + 1)


def four(cup: str, call: Call) -> Iterator[int]:
    yield from range(1, 5)


def test_a_level_draws_some_values_of_each_call_and_tests_those_that_were_there() -> None:
    """Two cups: two poses each, and in the next level these are tested, and two more are drawn."""
    tested: list[tuple[str, int]] = []

    def clear(cup: str, pose: int) -> bool:
        tested.append((cup, pose))
        return pose == 3

    levels: list[tuple[int, int]] = []
    run = started(problem("(and (put tea) (put mug))", endless, clear))
    run.progress = lambda effort: levels.append((run.binder.draws, len(tested)))
    result = plan_incrementally(run)
    assert result.outcome is Outcome.SOLVED
    assert [action.name for action in result.actions] == ["put", "put"]
    each = 2 * DRAWS_PER_LEVEL
    assert levels == [(each, 0), (3 * each, each)]
    assert run.binder.draws == 5 * each and len(tested) == 2 * each
    assert {result.objects.values[action.arguments[1]] for action in result.actions} == {3}


def test_where_all_values_are_drawn_there_is_no_plan() -> None:
    """Four poses, the try that finds the end, and four tests."""
    run = started(problem("(put tea)", four, lambda cup, pose: False, cups="tea"))
    result = plan_incrementally(run)
    assert result.outcome is Outcome.INFEASIBLE
    assert run.binder.draws == 4 + 1 + 4


def test_a_call_that_gives_nothing_is_known_to_give_nothing() -> None:
    ahead: list[bool] = []

    def nothing(cup: str, call: Call) -> Iterator[int]:
        ahead.append(call.ahead)
        yield from ()

    run = started(problem("(put tea)", nothing, cups="tea"))
    assert plan_incrementally(run).outcome is Outcome.INFEASIBLE
    assert list(run.knowledge.exhausted_calls) == [("sample-pose", ("tea",))]
    assert run.binder.draws == 1 and ahead == [True]  # it is told that no plan asks yet


@pytest.mark.parametrize("most", [1, DRAWS_PER_LEVEL + 1, 20])
def test_no_level_is_begun_after_so_many_draws(most: int) -> None:
    run = started(problem("(put tea)", endless, lambda cup, pose: False, cups="tea"))
    assert plan_incrementally(run, most).outcome is Outcome.EXHAUSTED
    draws = [2, 2 + 2 + 2, 2 + 4 + 4, 2 + 4 + 4 + 4, 2 + 4 * 4, 2 + 4 * 5]
    assert run.binder.draws == next(count for count in draws if count >= most)


def test_the_end_of_the_time_is_a_result_or_goes_to_who_asked_for_some_draws() -> None:
    made = problem("(put tea)", endless, lambda cup, pose: False, cups="tea")
    assert plan_incrementally(started(made, 0.0)).outcome is Outcome.TIMEOUT
    with pytest.raises(OutOfTime):
        plan_incrementally(started(made, 0.0), 100)

    def interrupted(run: Run) -> bool:
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_sample_level", interrupted)
        for most in (None, 100):
            assert plan_incrementally(started(made), most).outcome is Outcome.INTERRUPTED


def test_streams_that_nothing_asks_for_are_left_out_unless_they_are_wanted() -> None:
    domain = DOMAIN.replace("(:predicates", "(:predicates (glance ?c - cup ?p - pose)")
    look = ":inputs (?c) :domain (cup ?c) :outputs (?p) :certified (glance ?c ?p)"
    functions = {
        "sample-pose": four, "test-clear": lambda cup, pose, call: True, "look": four,
    }  # fmt: skip
    streams = STREAMS.replace("(:stream test", f"(:stream look {look}) (:stream test")
    made = stream_task(domain, streams, functions, {"tea": ("cup",)}, "", "(put tea)")
    for pruned, names in ((True, ["sample-pose", "test-clear"]), (False, [*functions])):
        run = started(made, pruned=pruned)
        assert {stream.name for stream in run.task.streams} == {*names}
        assert plan_incrementally(run).outcome is Outcome.SOLVED


ONE_HAND = DOMAIN.replace(
    ":effect (and (at ?c ?p) (put ?c))",
    ":effect (and (at ?c ?p) (put ?c) (forall (?d - cup) (when (not (= ?c ?d)) (not (put ?d)))))",
)
"""The cup that is put last is the only one that is put."""


def test_goals_that_exclude_each_other_are_told_before_anything_is_drawn() -> None:
    run = started(problem("(and (put tea) (put mug))", endless, domain=ONE_HAND))
    assert plan_incrementally(run).outcome is Outcome.INFEASIBLE
    assert run.binder.draws == 0

    told = started(problem("(and (put tea) (put mug))", endless, domain=ONE_HAND))
    assert plan_incrementally(told, 4).outcome is Outcome.EXHAUSTED  # who asks for draws gets them
    assert told.binder.draws >= 4


WET_AND_DRY = """
(define (domain laundry)
  (:requirements :typing)
  (:types cup pose)
  (:predicates (pose ?c - cup ?p - pose) (clear ?c - cup ?p - pose) (wet ?p - pose) (dry ?p - pose))
  (:action wash :parameters (?c - cup ?p - pose) :precondition (pose ?c ?p)
    :effect (and (wet ?p) (not (dry ?p))))
  (:action hang :parameters (?c - cup ?p - pose) :precondition (pose ?c ?p)
    :effect (and (dry ?p) (not (wet ?p)))))
"""


@pytest.mark.parametrize("count", [1, 2])
def test_goals_that_only_a_second_value_of_a_call_reconciles_are_sampled(count: int) -> None:
    """One place is not wet and dry; that there is another one only drawing tells."""
    goal = "(and (exists (?p - pose) (wet ?p)) (exists (?p - pose) (dry ?p)))"

    def poses(cup: str, call: Call) -> Iterator[int]:
        yield from range(count)

    run = started(problem(goal, poses, cups="tea", domain=WET_AND_DRY))
    result = plan_incrementally(run)
    assert result.outcome is (Outcome.SOLVED if count == 2 else Outcome.INFEASIBLE)
    assert run.binder.draws > 0
