"""The adaptive loop's own decisions: how long a round is, what it learns, and how it ends."""

from __future__ import annotations

import random
from typing import Any

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms import adaptive as module
from tamp.symbolic.algorithms.adaptive import (
    FIRST_TRIES,
    NODE_DRAWS,
    ROUND_DRAWS,
    ROUNDS_BEFORE_ALL_OBJECTS,
    draws_of_round,
    plan_adaptively,
    start_adaptive,
    update_knowledge,
)
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.planning_run import Run, search_plan
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.deadline import Deadline, OutOfTime
from tests.symbolic.algorithms.binding.shelf import planned


@pytest.mark.parametrize(
    ("nodes", "rounds", "tries", "draws"),
    [
        (0, 0, FIRST_TRIES, ROUND_DRAWS),
        (ROUND_DRAWS // NODE_DRAWS, 0, FIRST_TRIES, ROUND_DRAWS),
        (ROUND_DRAWS // NODE_DRAWS + 1, 0, FIRST_TRIES, ROUND_DRAWS + NODE_DRAWS),
        (2, 3, FIRST_TRIES + 3, 4 * ROUND_DRAWS),
        (100, 1, FIRST_TRIES + 1, 2 * 100 * NODE_DRAWS),
    ],
)
def test_rounds_grow_with_the_skeleton_and_from_one_to_the_next(
    nodes: int, rounds: int, tries: int, draws: int
) -> None:
    calls: Any = (None,) * nodes
    assert draws_of_round(Skeleton((), (), calls, (), rounds)) == (tries, draws)


def test_a_run_takes_the_goals_objects_and_excludes_others_of_their_kind() -> None:
    run, _ = planned("(put tea)")
    again = start_adaptive(run.task.problem, random.Random, Deadline(), lambda effort: None)
    assert again.knowledge.excluded_objects == frozenset(), "they stand nowhere yet"
    assert again.optimistic.facts.instances and not again.skeletons


def test_a_round_in_vain_is_counted_and_what_ended_is_left_out() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert run.binder.bind(skeleton, 8, 100) is None
    before = run.optimistic
    update_knowledge(run, skeleton)
    assert skeleton.rounds == 1
    assert run.effort.draws == run.binder.draws == 9, (
        "four poses, their tests, and one try that finds no more"
    )
    assert ("sample-pose", ("tea",)) in run.knowledge.enumerated_calls
    assert run.optimistic is not before
    assert all(one.call != ("sample-pose", ("tea",)) for one in run.optimistic.facts.instances)
    assert search_plan(run) is None, "each pose is known, and none is clear"


def test_nothing_new_leaves_the_optimistic_task_alone() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert run.binder.bind(skeleton, 2, 100) is None
    before = run.optimistic
    update_knowledge(run, skeleton)
    assert run.optimistic is before and skeleton.rounds == 1


@pytest.mark.parametrize("rounds", range(1, ROUNDS_BEFORE_ALL_OBJECTS + 1))
def test_excluded_objects_come_back_when_something_fails_at_them_or_after_some_rounds(
    rounds: int,
) -> None:
    run, skeleton = planned("(put tea)")
    run.knowledge.excluded_objects = frozenset({"mug", "cup"})
    skeleton.rounds = rounds - 1
    run.knowledge.experience.record(("clear", "mug", "#p7"), Rejection("no"))
    update_knowledge(run, skeleton)
    left = {"cup"} if rounds < ROUNDS_BEFORE_ALL_OBJECTS else set()
    assert run.knowledge.excluded_objects == left


def test_facts_found_besides_change_the_task() -> None:
    run, skeleton = planned("(put tea)")
    before = run.optimistic
    run.streams.wild["pose", "tea", "tea"] = None
    update_knowledge(run, skeleton)
    assert run.optimistic is not before and ("pose", "tea", "tea") in run.knowledge.certified_facts


@pytest.mark.parametrize(
    ("error", "outcome"), [(OutOfTime, Outcome.TIMEOUT), (KeyboardInterrupt, Outcome.INTERRUPTED)]
)
def test_time_and_the_user_end_a_run_at_any_step(
    error: type[BaseException], outcome: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = planned("(put tea)")

    def interrupted(run: Run) -> None:
        raise error

    monkeypatch.setattr(module, "search_plan", interrupted)
    result = plan_adaptively(run)
    assert result.outcome is outcome and result.explanation
    assert run.deadline.ended, "no alarm rings while the result is made"


def test_progress_is_told_between_rounds() -> None:
    told: list[int] = []
    run, _ = planned("(put tea)", lambda cup, pose: False)
    run.progress = lambda effort: told.append(effort.searches)
    result = plan_adaptively(run)
    assert result.outcome is Outcome.INFEASIBLE
    assert told and told == sorted(told)


def test_a_plan_comes_with_its_skeleton_and_what_it_rests_on() -> None:
    run, _ = planned("(put tea)", lambda cup, pose: pose == 3)
    result = plan_adaptively(run)
    assert result.outcome is Outcome.SOLVED
    (action,) = result.actions
    assert (action.name, run.task.objects.values[action.arguments[1]]) == ("put", 3)
    assert result.skeleton is run.latest and result.skeleton is not None
    assert {fact[0] for fact in result.certified} == {"pose", "clear"}
    (attempt,) = result.attempts()
    assert attempt.bound and attempt.rounds == 0
