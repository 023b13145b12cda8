"""The steps of one run: search, the skeleton of a plan, values for it, and what the replay refuses."""

from __future__ import annotations

import random

import pytest

from tamp.symbolic.algorithms import planning_run as module
from tamp.symbolic.algorithms.adaptive import start_adaptive
from tamp.symbolic.algorithms.planning_run import (
    REPLAY_REFUSAL,
    Run,
    bind_skeleton,
    renew,
    search_plan,
    skeleton_of,
)
from tamp.symbolic.search.replay import REFUTED_TEXT
from tamp.system.deadline import Deadline
from tests.symbolic.algorithms.binding.shelf import planned


def test_a_skeleton_that_is_found_again_is_the_same_one() -> None:
    run, skeleton = planned("(put tea)")
    found = search_plan(run)
    assert found is not None and skeleton_of(run, found) is skeleton
    assert run.effort.skeletons == len(run.skeletons) == 1


def test_values_that_the_replay_refuses_are_told_and_others_are_found() -> None:
    run, skeleton = planned("(put tea)")
    first = bind_skeleton(run, skeleton, 4, 100)
    run.streams.certain.clear()
    second = bind_skeleton(run, skeleton, 4, 100)
    assert first is not None and second is not None and first != second
    assert run.effort.refuted == 1
    assert any("was not certified" in text for text in run.streams.warnings)


def test_a_skeleton_that_can_give_no_more_is_made_anew() -> None:
    run, skeleton = planned("(put tea)")
    found = search_plan(run)
    assert found is not None
    run.knowledge.exhausted_calls["sample-pose", ("tea",)] = REPLAY_REFUSAL
    run.traced.clear()
    again = skeleton_of(run, found)
    assert again is not skeleton and again.actions == skeleton.actions
    assert run.effort.skeletons == len(run.skeletons) == 1


def test_a_renewed_task_follows_from_what_is_known_by_now() -> None:
    run, _ = planned("(put tea)")
    before, spent = run.optimistic, run.effort.search_seconds
    run.knowledge.exhausted_calls["sample-pose", ("tea",)] = REPLAY_REFUSAL
    renew(run)
    assert run.optimistic is not before and not run.optimistic.goal_is_reachable
    assert run.effort.search_seconds > spent
    assert search_plan(run) is None


def asked_once(run: Run, monkeypatch: pytest.MonkeyPatch, answer: bool) -> list[object]:
    asked: list[object] = []

    def exclude(task: object, deadline: object) -> bool:
        asked.append(task)
        return answer

    monkeypatch.setattr(module, "exclude_each_other", exclude)
    return asked


@pytest.mark.parametrize("answer", [True, False])
def test_a_doubtful_run_asks_of_each_task_once_whether_its_goals_exclude_each_other(
    answer: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = planned("(put tea)")
    asked = asked_once(run, monkeypatch, answer)
    assert search_plan(run) is not None and asked == []
    run.doubtful, searches = True, run.effort.searches
    assert (search_plan(run) is None) is answer
    assert search_plan(run) is not None  # what is proven of this task was said
    assert asked == [run.optimistic.instantiated] and run.effort.searches == searches + 2
    renew(run)
    search_plan(run)
    assert len(asked) == 2


def test_a_search_below_a_cost_has_one_try() -> None:
    run, _ = planned("(and (put tea) (put mug))")
    assert search_plan(run, below=2.0) is None
    found = search_plan(run, below=2.5)
    assert found is not None and len(found.plan.operators) == 2


def test_the_seed_of_restarts_comes_from_the_run() -> None:
    names: list[str] = []

    def make_rng(name: str) -> random.Random:
        names.append(name)
        return random.Random(name)

    run, _ = planned("(put tea)")
    run.make_rng = make_rng
    search_plan(run)
    assert names == ["restarts of the search"]


def test_where_no_values_hold_the_skeleton_forgets_them_and_the_failure_is_noted() -> None:
    """Nothing counts as certified, so that the replay refuses whatever is drawn."""
    run, skeleton = planned("(put tea)")
    run.replay.fault = lambda skeleton, values: module.Fault("no pose is any good", expected=False)  # type: ignore[method-assign]
    assert bind_skeleton(run, skeleton, 2, 100) is None
    assert not skeleton.memory and run.effort.refuted == 1
    assert list(run.streams.warnings) == [f"{REFUTED_TEXT}: no pose is any good"]
    (drawn,) = (node.fact for node in skeleton.nodes if node.outputs)
    facts = run.knowledge.experience.facts
    refused = {fact: record.reasons[REPLAY_REFUSAL.reason] for fact, record in facts.items()}
    assert {fact: count for fact, count in refused.items() if count} == {drawn: 1}


def test_a_fault_that_was_to_be_expected_is_no_mistake() -> None:
    run, skeleton = planned("(put tea)")
    run.replay.fault = lambda skeleton, values: module.Fault("two have one value", expected=True)  # type: ignore[method-assign]
    assert bind_skeleton(run, skeleton, 2, 100) is None
    assert run.effort.refuted == 0 and not list(run.streams.warnings)


def test_a_run_begins_with_nothing_drawn_and_its_task_at_hand() -> None:
    run, _ = planned("(put tea)")
    fresh = start_adaptive(run.task.problem, random.Random, Deadline(), lambda effort: None)
    assert fresh.effort.searches == 0 and fresh.binder.draws == 0 and fresh.latest is None
    assert fresh.effort.search_seconds > 0.0 and fresh.optimistic.goal_is_reachable
