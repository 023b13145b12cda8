"""Planning as a function: what it refuses, how it ends, and when it plans anew."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.planner import solve as module
from tamp.planner.solve import MOST_TRIES, solve
from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import (
    Outcome,
    PlanAction,
    Result,
    SearchStatistics,
    StreamTask,
)
from tamp.system.deadline import OutOfTime

PROBLEM: Any = SimpleNamespace(stream_task=StreamTask(None, (), {}))  # type: ignore[arg-type]
WRONG = (Cause("after 1 actions it is not what it was", CauseKind.CONTRADICTED, ("cup",)),)


class Runs:
    """An algorithm that finds a plan, and tells what it was called with."""

    def __init__(self, raising: type[BaseException] | None = None) -> None:
        self.raising = raising
        self.draws: list[float] = []
        self.tasks: list[StreamTask] = []
        self.contradicted = 0

    def __call__(
        self, task: StreamTask, make_rng: Callable[[str], Any], deadline: Any, progress: Any
    ) -> Result:
        self.tasks.append(task)
        self.draws.append(float(make_rng("place").random()))
        progress(SearchStatistics(draws=len(self.tasks)))
        if self.raising is not None:
            raise self.raising
        return Result(Outcome.SOLVED, Objects({}, {}), (PlanAction("wave", ()),))

    def contradictions(self, problem: Any, result: Result) -> tuple[Cause, ...]:
        return WRONG if len(self.tasks) <= self.contradicted else ()


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Runs:
    made = Runs()
    monkeypatch.setattr(module, "ALGORITHMS", {"adaptive": made, "other": Runs()})
    monkeypatch.setattr(module, "contradictions", made.contradictions)
    monkeypatch.setattr(module, "with_trajectories", lambda problem, result: result.actions)
    monkeypatch.setattr(
        module, "build_solution",
        lambda problem, result, actions, seed, algorithm, seconds, recorder: SimpleNamespace(
            result=result, actions=actions, seed=seed, seconds=seconds, recorder=recorder
        ),
    )  # fmt: skip
    return made


def test_an_unknown_algorithm_is_refused_with_the_choices(runs: Runs) -> None:
    with pytest.raises(InputError, match=r"unknown algorithm 'adaptiv'.*adaptive"):
        solve(PROBLEM, algorithm="adaptiv")
    assert runs.tasks == []


@pytest.mark.parametrize("seconds", [0.0, -1.0, math.nan])
def test_time_is_positive(runs: Runs, seconds: float) -> None:
    with pytest.raises(InputError, match="the time must be positive, not"):
        solve(PROBLEM, max_time=seconds)
    assert runs.tasks == []


def test_a_plan_that_nothing_contradicts_is_the_first(runs: Runs) -> None:
    heard: list[int] = []
    found: Any = solve(PROBLEM, seed=3, progress=lambda effort: heard.append(effort.draws))
    assert len(runs.tasks) == 1 and runs.tasks[0] is PROBLEM.stream_task and heard == [1]
    assert found.actions == found.result.actions and found.seed == 3 and found.recorder is None
    assert 0.0 <= found.seconds["timing"] <= found.seconds["total"]


def test_the_same_seed_draws_the_same_and_each_new_try_otherwise(runs: Runs) -> None:
    runs.contradicted = 3
    for _ in range(2):
        runs.tasks.clear()
        found: Any = solve(PROBLEM, seed=3)
        assert found.result.outcome is Outcome.SOLVED and len(runs.tasks) == 4
    assert runs.draws[:4] == runs.draws[4:] and len({*runs.draws}) == 4
    runs.contradicted = 0
    solve(PROBLEM, seed=4)
    assert runs.draws[-1] not in runs.draws[:-1]


def test_where_each_plan_is_contradicted_there_is_none(runs: Runs) -> None:
    runs.contradicted = 99
    found: Any = solve(PROBLEM)
    assert len(runs.tasks) == MOST_TRIES
    assert found.result.outcome is Outcome.EXHAUSTED and found.actions == ()
    assert found.result.causes == WRONG


def test_no_new_try_begins_when_the_time_is_up(runs: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    runs.contradicted = 99
    late = SimpleNamespace(passed=True, elapsed=lambda: 1.0)
    monkeypatch.setattr(module, "Deadline", lambda seconds: late)
    monkeypatch.setattr(
        module, "Interrupter", lambda *_, **__: SimpleNamespace(run=lambda work: work())
    )
    found: Any = solve(PROBLEM)
    assert len(runs.tasks) == 1 and found.result.outcome is Outcome.EXHAUSTED


@pytest.mark.parametrize(
    ("raised", "outcome"),
    [(OutOfTime, Outcome.TIMEOUT), (KeyboardInterrupt, Outcome.INTERRUPTED)],
)
def test_what_ends_it_early_is_its_outcome(
    runs: Runs, raised: type[BaseException], outcome: Outcome
) -> None:
    runs.raising = raised
    found = solve(PROBLEM, seed=5)
    assert (found.outcome, found.seed, found.plan) == (outcome, 5, ())
    assert found.record is None and found.problem is PROBLEM


def test_what_is_recorded_is_listened_to(runs: Runs) -> None:
    found: Any = solve(PROBLEM, record=True)
    assert found.recorder is not None and runs.tasks[0] is not PROBLEM.stream_task
    runs.raising = OutOfTime
    record = solve(PROBLEM, record=True).record
    assert record is not None and record.samples == ()
