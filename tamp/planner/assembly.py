"""Assemble a solution from an algorithm's result: timed motions, values in use, time spent."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping

import numpy as np

from tamp.geometric.samplers.mixture import accounts
from tamp.planner.contradictions import contradictions
from tamp.planner.problem import Problem
from tamp.planner.recorder import Recorder
from tamp.planner.solution import Action, Solution
from tamp.planner.timed_trajectories import TimingCache, trajectories
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import Outcome, Result


def random_streams(seed: int) -> Callable[[str], np.random.Generator]:
    """Seed a random generator by a string and the seed: no draw depends on draws elsewhere."""

    def make_rng(key: str) -> np.random.Generator:
        digest = hashlib.blake2b(key.encode(), digest_size=8, key=str(seed).encode()).digest()
        return np.random.default_rng(int.from_bytes(digest, "little"))

    return make_rng


def with_trajectories(
    problem: Problem, result: Result, cache: TimingCache | None = None
) -> tuple[Action, ...]:
    """Return the plan's actions with their trajectories; none where there is no plan.

    Args:
        problem: The problem.
        result: Of an algorithm.
        cache: Paths that were timed for earlier plans; added to.
    """
    if result.outcome is not Outcome.SOLVED:
        return ()
    names = problem.stream_task.values
    actions: list[Action] = []
    start = 0.0
    moved = trajectories(problem.context, result.actions, result.objects.values, cache)
    for action, trajectory in zip(result.actions, moved, strict=True):
        objects = tuple(
            str(names[name]) for name in action.arguments if isinstance(names.get(name), str)
        )
        actions.append(
            Action(action.name, action.arguments, objects, trajectory, start, action.cost)
        )
        start += trajectory.duration
    return tuple(actions)


def build_solution(
    problem: Problem,
    result: Result,
    plan: tuple[Action, ...],
    seed: int,
    algorithm: str,
    seconds: Mapping[str, float],
    recorder: Recorder | None = None,
) -> Solution:
    """Assemble the solution that a result amounts to.

    Args:
        problem: The problem.
        result: Of an algorithm.
        plan: Its actions, timed.
        seed: Of the run.
        algorithm: Its name.
        seconds: "total" and "timing".
        recorder: What listened to the run, if anything did.
    """
    used = _used(problem, result)
    by_stream = {name: statistics.seconds for name, statistics in result.statistics.items()}

    return Solution(
        problem=problem,
        outcome=result.outcome,
        seed=seed,
        algorithm=algorithm,
        plan=plan,
        values=used,
        certified=result.certified,
        statistics=result.statistics,
        effort=result.effort,
        causes=result.causes,
        tallies=result.tallies,
        warnings=(
            *problem.warnings,
            *result.warnings,
            *(cause.text for cause in contradictions(problem, result)),
        ),
        seconds={
            "total": seconds["total"],
            "search": result.effort.search_seconds,
            "timing": seconds["timing"],
            "explaining": result.effort.explaining_seconds,
            "other tries": result.effort.apart_seconds,
            **by_stream,
        },
        record=None if recorder is None else recorder.record(result.attempts(), used.values()),
        samplers=accounts(result.memory),
    )


def interrupted_solution(
    problem: Problem,
    outcome: Outcome,
    seed: int,
    algorithm: str,
    total: float,
    recorder: Recorder | None = None,
) -> Solution:
    """Make the solution when time or user end it before the first round or in a plan's timing."""
    why = "it ended before the first plan was tried, or before its motions were timed"
    causes = (Cause(why, CauseKind.SEARCHED),)
    record = None if recorder is None else recorder.record(())
    return Solution(
        problem, outcome, seed, algorithm, causes=causes, seconds={"total": total}, record=record
    )


def _used(problem: Problem, result: Result) -> dict[str, object]:
    """Return the values of the names in the plan, its certified facts and the initial facts."""
    names = {name for action in result.actions for name in action.arguments}
    names |= {
        name for fact in (*result.certified, *problem.stream_task.task.initial) for name in fact[1:]
    }
    values = result.objects.values
    return {
        name: values[name]
        for name in sorted(names)
        if name in values and not isinstance(values[name], str)
    }
