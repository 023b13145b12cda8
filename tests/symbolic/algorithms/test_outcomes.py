"""How a run ends: a plan with what it rests on, a proof, or what was tried; nothing is claimed that is not known."""

from __future__ import annotations

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.outcomes import (
    end_result,
    infeasible_result,
    interrupted_result,
    solved_result,
)
from tamp.symbolic.algorithms.planning_run import bind_skeleton
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.deadline import OutOfTime
from tests.symbolic.algorithms.binding.shelf import planned


def test_a_bound_skeleton_becomes_actions_with_costs_and_certified_facts() -> None:
    run, skeleton = planned("(and (put tea) (taken tea))", lambda cup, pose: pose == 2)
    values = bind_skeleton(run, skeleton, 4, 100)
    assert values is not None
    result = solved_result(run, skeleton, values)
    assert [action.name for action in result.actions] == ["put", "take"]
    assert {action.arguments for action in result.actions} == {("tea", next(iter(values.values())))}
    assert all(action.cost == 1.0 for action in result.actions)
    assert result.certified == tuple(sorted(result.certified))
    assert {fact[0] for fact in result.certified} == {"pose", "clear"}
    assert result.tallies == () and result.explanation == ()
    assert result.effort.draws == run.binder.draws > 0
    assert [attempt.bound for attempt in result.attempts()] == [True]


def test_what_the_task_states_itself_is_not_called_certified() -> None:
    run, skeleton = planned("(put tea)")
    values = bind_skeleton(run, skeleton, 4, 100)
    assert values is not None
    before = solved_result(run, skeleton, values).certified
    stated = frozenset(fact for fact in before if fact[0] == "pose")
    object.__setattr__(run.task.problem.task, "initial", run.task.problem.task.initial | stated)
    assert set(solved_result(run, skeleton, values).certified) == set(before) - stated


@pytest.mark.parametrize("incomplete", [False, True])
def test_no_plan_is_a_proof_only_where_nothing_was_given_up(incomplete: bool) -> None:
    run, _ = planned("(put tea)")
    run.knowledge.incomplete = incomplete
    run.knowledge.exhausted_calls["sample-pose", ("tea",)] = Rejection("the shelf is full")
    result = infeasible_result(run)
    assert result.outcome is (Outcome.EXHAUSTED if incomplete else Outcome.INFEASIBLE)
    assert any("sample-pose(tea): the shelf is full" in line for line in result.explanation)
    assert result.effort.explaining_seconds > 0.0


@pytest.mark.parametrize(
    ("error", "outcome"),
    [(OutOfTime(), Outcome.TIMEOUT), (KeyboardInterrupt(), Outcome.INTERRUPTED)],
)
def test_an_end_from_outside_says_what_was_tried(
    error: OutOfTime | KeyboardInterrupt, outcome: Outcome
) -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    run.latest = skeleton
    assert bind_skeleton(run, skeleton, 4, 100) is None
    result = interrupted_result(run, error)
    assert result.outcome is outcome and run.deadline.ended
    assert any("test-clear never worked in 4 tries" in line for line in result.explanation)
    worst = result.tallies[0]
    assert (worst.stream, worst.always_failed) == ("test-clear", True)


def test_a_run_without_a_plan_yet_says_so() -> None:
    run, _ = planned("(put tea)")
    assert end_result(run, Outcome.TIMEOUT).explanation == ("no action plan was found yet",)
    why = Cause("why", CauseKind.REFUTED)
    assert end_result(run, Outcome.TIMEOUT, (why,)).explanation == ("why",)
