"""A solution put together from an algorithm's result: what of it is kept, and in which order."""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.planner import assembly as module
from tamp.planner.assembly import (
    build_solution,
    interrupted_solution,
    random_streams,
    with_trajectories,
)
from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.result import Outcome, PlanAction, Result, SearchStatistics

VALUES: Mapping[str, object] = {
    "cup": "Cup",
    "p0": 0.0,
    "p1": 1.0,
    "q": 2.0,
    "t": 3.0,
    "unused": 4.0,
}


def problem(initial: frozenset[tuple[str, ...]] = frozenset()) -> Any:
    task = SimpleNamespace(initial=initial)
    return SimpleNamespace(
        context=None, warnings=("it is odd",), stream_task=SimpleNamespace(task=task, values={"cup": "Cup"}),
    )  # fmt: skip


def result(outcome: Outcome = Outcome.SOLVED, **more: Any) -> Result:
    actions = (PlanAction("move", ("q", "t"), 0.5), PlanAction("pick", ("cup", "p1"), 2.0))
    return Result(
        outcome, Objects({}, dict(VALUES)), actions, (("kin", "cup", "q"), ("far", "gone")), **more
    )


@pytest.fixture(autouse=True)
def parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each action takes as many seconds as its name has letters; no classifier contradicts."""

    def timed(context: Any, actions: Any, values: Any, cache: Any) -> list[Any]:
        return [SimpleNamespace(duration=float(len(action.name))) for action in actions]

    monkeypatch.setattr(module, "trajectories", timed)
    monkeypatch.setattr(module, "contradictions", lambda *_: ())


def test_draws_depend_on_their_key_and_the_seed_alone() -> None:
    draws = {
        (seed, key): tuple(random_streams(seed)(key).integers(0, 2**62, 3).tolist())
        for seed in (0, 1)
        for key in ("a", "b")
    }
    assert len({*draws.values()}) == 4
    make = random_streams(0)
    make("a").random(99)
    make("b").random(99)
    assert tuple(make("a").integers(0, 2**62, 3).tolist()) == draws[0, "a"]


def test_actions_follow_each_other_and_know_the_scenes_objects() -> None:
    move, pick = with_trajectories(problem(), result())
    assert (move.name, move.start, move.cost, move.objects) == ("move", 0.0, 0.5, ())
    assert (pick.name, pick.start, pick.cost, pick.objects) == ("pick", 4.0, 2.0, ("Cup",))
    assert pick.arguments == ("cup", "p1") and pick.trajectory.duration == 4.0


@pytest.mark.parametrize("outcome", [one for one in Outcome if one is not Outcome.SOLVED])
def test_without_a_plan_nothing_is_timed(outcome: Outcome) -> None:
    assert with_trajectories(problem(), result(outcome)) == ()


def test_values_are_those_of_the_plan_its_facts_and_the_start() -> None:
    start = frozenset({("at-pose", "cup", "p0")})
    seconds = {"total": 9.0, "timing": 1.0}
    made = build_solution(problem(start), result(), (), 3, "adaptive", seconds)
    assert made.values == {"p0": 0.0, "p1": 1.0, "q": 2.0, "t": 3.0}
    assert [*made.values] == sorted(made.values)
    assert (made.seed, made.algorithm, made.record) == (3, "adaptive", None)
    assert made.certified == result().certified


def test_time_is_told_by_what_took_it() -> None:
    spent = {"ik": StreamStatistics(seconds=2.0)}
    effort = SearchStatistics(search_seconds=3.0, explaining_seconds=0.5, apart_seconds=0.25)
    made = build_solution(
        problem(), result(statistics=spent, effort=effort), (), 0, "adaptive", {"total": 9.0, "timing": 1.0},
    )  # fmt: skip
    assert made.seconds == {
        "total": 9.0, "search": 3.0, "timing": 1.0, "explaining": 0.5, "other tries": 0.25, "ik": 2.0,
    }  # fmt: skip


def test_warnings_end_with_what_a_classifier_says_otherwise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    otherwise = Cause("after 1 actions it is not", CauseKind.CONTRADICTED)
    monkeypatch.setattr(module, "contradictions", lambda *_: (otherwise,))
    made = build_solution(
        problem(), result(warnings=("slow",)), (), 0, "adaptive", {"total": 9.0, "timing": 1.0}
    )
    assert made.warnings == ("it is odd", "slow", "after 1 actions it is not")


class Recorder:
    """Keeps what a record is asked for."""

    def record(self, attempts: Any, used: Any = ()) -> Any:
        return (attempts, tuple(used))


def test_a_record_has_the_attempts_and_the_values_that_are_used() -> None:
    seconds, recorder = {"total": 9.0, "timing": 1.0}, Recorder()
    tried = result(attempts=lambda: ("tried",))
    made = build_solution(problem(), tried, (), 0, "adaptive", seconds, recorder)  # type: ignore[arg-type]
    assert made.record == (("tried",), (1.0, 2.0, 3.0))
    ended = interrupted_solution(problem(), Outcome.TIMEOUT, 0, "adaptive", 1.0, recorder)  # type: ignore[arg-type]
    assert ended.record == ((), ())


@pytest.mark.parametrize("outcome", [Outcome.TIMEOUT, Outcome.INTERRUPTED])
def test_what_ended_before_the_first_round_says_so(outcome: Outcome) -> None:
    made = interrupted_solution(problem(), outcome, 3, "incremental", 0.7)
    assert (made.outcome, made.seed, made.algorithm) == (outcome, 3, "incremental")
    assert made.plan == () and made.seconds == {"total": 0.7} and made.record is None
    (cause,) = made.causes
    assert cause.kind is CauseKind.SEARCHED and "before the first plan was tried" in cause.text
