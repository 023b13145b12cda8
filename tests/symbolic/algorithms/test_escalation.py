"""When rounds lead nowhere: deeper instances, a second opinion, or the end; each at its time."""

from __future__ import annotations

from typing import Any

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms import escalation as module
from tamp.symbolic.algorithms.escalation import (
    DRAWS_PER_FAILURE,
    FAILURES_BEFORE_SECOND_OPINION,
    FEW_DRAWS_PER_ROUND,
    MANY_OPERATORS,
    ROUNDS_BEFORE_DEEPER,
    ROUNDS_BEFORE_SECOND_OPINION,
    Escalation,
    escalate,
    instantiate_more,
    look_at_real_values,
)
from tamp.symbolic.algorithms.incremental import MAX_DRY_ROUNDS
from tamp.symbolic.algorithms.outcomes import end_result
from tamp.symbolic.algorithms.planning_run import Run
from tamp.symbolic.algorithms.result import Outcome, Result
from tests.symbolic.algorithms.binding.shelf import planned

Asked = list[int]


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The draws that second opinions were given; each ends without a plan."""
    draws: Asked = []

    def plan_incrementally(run: Run, most: int | None = None) -> Result:
        assert most is not None
        draws.append(most)
        return end_result(run, Outcome.EXHAUSTED)

    monkeypatch.setattr(module, "plan_incrementally", plan_incrementally)
    return draws


def test_a_run_that_draws_is_left_alone(asked: Asked) -> None:
    run, _ = planned("(put tea)")
    state = Escalation()
    for _ in range(3 * MAX_DRY_ROUNDS):
        assert escalate(run, state, True) is None
    assert state == Escalation() and not asked


def test_many_dry_rounds_in_a_row_exhaust_the_run() -> None:
    run, _ = planned("(put tea)")
    state = Escalation()
    for _ in range(MAX_DRY_ROUNDS - 1):
        assert escalate(run, state, False) is None
    assert escalate(run, state, True) is None
    for _ in range(MAX_DRY_ROUNDS - 1):
        assert escalate(run, state, False) is None
    result = escalate(run, state, False)
    assert result is not None and result.outcome is Outcome.EXHAUSTED


def test_dry_rounds_bring_excluded_objects_back_first() -> None:
    run, _ = planned("(put tea)")
    run.knowledge.excluded_objects = frozenset({"mug"})
    state, before = Escalation(dry_rounds=MAX_DRY_ROUNDS - 1), run.optimistic
    assert escalate(run, state, False) is None
    assert not run.knowledge.excluded_objects and run.optimistic is not before
    assert state.dry_rounds == 0


@pytest.mark.parametrize("searches", [ROUNDS_BEFORE_DEEPER - 1, ROUNDS_BEFORE_DEEPER])
def test_shallow_instances_go_deeper_after_some_searches(
    searches: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = planned("(put tea)")
    deeper: list[object] = []
    monkeypatch.setattr(module, "instantiate_more", lambda run: bool(deeper.append(run) or True))
    run.effort.searches = searches
    state = Escalation()
    assert escalate(run, state, True) is None and not deeper, "nothing is kept shallow"
    run.knowledge.depth_limit = 1
    assert escalate(run, state, True) is None
    assert len(deeper) == (searches >= ROUNDS_BEFORE_DEEPER)
    assert state.shallow_searches == ROUNDS_BEFORE_DEEPER * (2 if deeper else 1)


@pytest.mark.parametrize("successes", [0, 1])
def test_what_fails_and_fails_is_worth_a_second_opinion(asked: Asked, successes: int) -> None:
    run, skeleton = planned("(put tea)")
    run.latest, state = skeleton, Escalation()
    fact = skeleton.nodes[1].fact
    for _ in range(FAILURES_BEFORE_SECOND_OPINION - 1):
        run.knowledge.experience.record(fact, Rejection("no"))
    for _ in range(successes):
        run.knowledge.experience.record(fact, None)
    assert escalate(run, state, True) is None and not asked
    run.knowledge.experience.record(fact, Rejection("no"))
    assert escalate(run, state, True) is None
    assert asked == ([] if successes else [DRAWS_PER_FAILURE * FAILURES_BEFORE_SECOND_OPINION])
    if not successes:
        assert state.failures == 2 * FAILURES_BEFORE_SECOND_OPINION
        assert escalate(run, state, True) is None and len(asked) == 1
        assert run.effort.apart_seconds > 0.0


def test_where_operators_are_many_more_has_to_fail(asked: Asked) -> None:
    """The second opinion draws for each of them."""
    run, skeleton = planned("(put tea)")
    run.latest, state = skeleton, Escalation(failures=1)
    operators = run.optimistic.instantiated.operators
    assert len(operators) > 1
    for number in range(1, len(operators) + 1):
        assert not asked and escalate(run, state, True) is None
        run.knowledge.experience.record(skeleton.nodes[1].fact, Rejection("no"))
        assert (number, asked) == (number, [])
    assert escalate(run, state, True) is None
    assert asked == [DRAWS_PER_FAILURE * len(operators)]
    assert state.failures == 2 * len(operators)


def test_only_what_the_latest_skeleton_rests_on_counts(asked: Asked) -> None:
    run, skeleton = planned("(put tea)")
    run.latest = skeleton
    for _ in range(FAILURES_BEFORE_SECOND_OPINION):
        run.knowledge.experience.record(("clear", "mug", "#p9"), Rejection("no"))
    assert escalate(run, Escalation(), True) is None and not asked


@pytest.mark.parametrize(
    ("searches", "draws", "operators", "asks"),
    [
        (ROUNDS_BEFORE_SECOND_OPINION, 0, MANY_OPERATORS, True),
        (ROUNDS_BEFORE_SECOND_OPINION - 1, 0, MANY_OPERATORS, False),
        (
            ROUNDS_BEFORE_SECOND_OPINION,
            FEW_DRAWS_PER_ROUND * ROUNDS_BEFORE_SECOND_OPINION,
            MANY_OPERATORS,
            False,
        ),
        (ROUNDS_BEFORE_SECOND_OPINION, 0, MANY_OPERATORS - 1, False),
    ],
)
def test_rounds_that_wander_in_a_large_task(
    asked: Asked,
    monkeypatch: pytest.MonkeyPatch,
    searches: int,
    draws: int,
    operators: int,
    asks: bool,
) -> None:
    run, _ = planned("(put tea)")
    run.effort.searches, run.binder.draws = searches, draws
    monkeypatch.setattr(
        module,
        "MANY_OPERATORS",
        len(run.optimistic.instantiated.operators) + MANY_OPERATORS - operators,
    )
    state = Escalation()
    assert escalate(run, state, True) is None
    assert asked == ([10 * FEW_DRAWS_PER_ROUND * ROUNDS_BEFORE_SECOND_OPINION] if asks else [])
    assert state.wandering_rounds == ROUNDS_BEFORE_SECOND_OPINION * (2 if asks else 1)


def test_a_round_that_drew_nothing_does_not_wander(
    asked: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = planned("(put tea)")
    run.effort.searches = ROUNDS_BEFORE_SECOND_OPINION
    monkeypatch.setattr(module, "MANY_OPERATORS", 0)
    assert escalate(run, Escalation(), False) is None and not asked


@pytest.mark.parametrize("outcome", list(Outcome))
def test_a_second_opinion_ends_the_run_with_a_plan_or_an_interruption(
    outcome: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, skeleton = planned("(put tea)")
    run.effort.searches = ROUNDS_BEFORE_SECOND_OPINION
    monkeypatch.setattr(module, "MANY_OPERATORS", 0)

    def plan_incrementally(other: Run, most: int | None = None) -> Result:
        assert other is not run and other.streams.warnings is run.streams.warnings
        return end_result(other, outcome, (), solution=skeleton)

    monkeypatch.setattr(module, "plan_incrementally", plan_incrementally)
    result = escalate(run, Escalation(), True)
    assert (result is not None) == (outcome in (Outcome.SOLVED, Outcome.INTERRUPTED))
    assert result is None or result.skeleton is None, "it is no skeleton of this run"


def test_instantiating_more_says_whether_there_was_more() -> None:
    run, _ = planned("(put tea)")
    before = run.optimistic
    assert not instantiate_more(run) and run.optimistic is before
    run.knowledge.excluded_objects = frozenset({"mug"})
    assert instantiate_more(run) and run.optimistic is not before


@pytest.mark.parametrize(
    "draws", [module.DRAWS_BEFORE_INFEASIBLE - 1, module.DRAWS_BEFORE_INFEASIBLE]
)
def test_real_values_that_are_all_there_are_prove_nothing(
    draws: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = planned("(put tea)")

    def plan_incrementally(other: Run, most: int | None = None) -> Result:
        assert other.brief and most == module.DRAWS_BEFORE_INFEASIBLE
        other.binder.draws = draws
        return end_result(other, Outcome.EXHAUSTED)

    monkeypatch.setattr(module, "plan_incrementally", plan_incrementally)
    assert look_at_real_values(run) is None
    assert run.knowledge.incomplete == (draws < module.DRAWS_BEFORE_INFEASIBLE)


def test_out_of_reach_without_distinctions_needs_no_look(asked: Asked) -> None:
    run, _ = planned("(put tea)")
    unreachable: Any = type("Unreachable", (), {"goal_is_reachable": False})()
    run.optimistic = unreachable
    assert look_at_real_values(run) is None and not asked
