"""Planning as a function: a problem in, a solution out."""

from __future__ import annotations

import hashlib

import numpy as np

from tamp.alarm import Alarm
from tamp.algorithms.registry import ALGORITHMS
from tamp.algorithms.solution import Effort, Outcome, Progress, Result
from tamp.clock import Deadline, OutOfTime
from tamp.errors import InputError
from tamp.problem import Problem
from tamp.solution import Action, Solution
from tamp.streams.mixture import accounts
from tamp.trajectories import trajectories


def solve(
    problem: Problem,
    *,
    max_time: float = 30.0,
    seed: int = 0,
    algorithm: str = "adaptive",
    progress: Progress | None = None,
) -> Solution:
    """Plan.

    The same seed gives the same plan, as long as the time did not run out.

    Args:
        problem: From `load_problem`.
        max_time: Seconds.
        seed: Of all randomness.
        algorithm: "adaptive" or "incremental".
        progress: Called now and then with what was done so far.

    Raises:
        InputError: Unknown algorithm, or a time that is not positive.
    """
    if algorithm not in ALGORITHMS:
        raise InputError(f"unknown algorithm '{algorithm}'", found=algorithm, choices=ALGORITHMS)
    if not max_time > 0.0:
        raise InputError(f"the time must be positive, not {max_time:g}")
    deadline = Deadline(max_time)

    def make_rng(key: str) -> np.random.Generator:
        digest = hashlib.blake2b(key.encode(), digest_size=8, key=str(seed).encode()).digest()
        return np.random.default_rng(int.from_bytes(digest, "little"))

    alarm = Alarm(deadline)
    try:
        with alarm:
            result = ALGORITHMS[algorithm](problem.stream_task, make_rng, deadline, progress or _silent)
            planned = deadline.elapsed()
            plan = _timed(problem, result) if result.outcome is Outcome.SOLVED else ()
    except (OutOfTime, KeyboardInterrupt) as end:  # before the first round, or while a bound plan was being timed
        outcome = Outcome.TIMEOUT if isinstance(end, OutOfTime) else Outcome.INTERRUPTED
        why = ("it ended before the first plan was tried, or before its motions were timed",)
        return Solution(
            problem, outcome, seed, algorithm, explanation=why, seconds={"total": deadline.elapsed()}
        )  # fmt: skip
    finally:
        alarm.disarm()
    total = deadline.elapsed()
    by_stream = {name: statistics.seconds for name, statistics in result.statistics.items()}
    return Solution(
        problem=problem,
        outcome=result.outcome,
        seed=seed,
        algorithm=algorithm,
        plan=plan,
        values=_used(problem, result),
        certified=result.certified,
        statistics=result.statistics,
        effort=result.effort,
        explanation=result.explanation,
        warnings=(*problem.warnings, *result.warnings),
        seconds={
            "total": total,
            "search": result.effort.search_seconds,
            "timing": total - planned,
            **by_stream,
        },
        samplers=accounts(result.memory),
    )


def _timed(problem: Problem, result: Result) -> tuple[Action, ...]:
    known = problem.stream_task.values
    actions: list[Action] = []
    start = 0.0
    timed = trajectories(problem.context, result.actions, result.objects.values)
    for action, trajectory in zip(result.actions, timed, strict=True):
        objects = tuple(str(known[name]) for name in action.arguments if isinstance(known.get(name), str))
        actions.append(Action(action.name, action.arguments, objects, trajectory, start, action.cost))
        start += trajectory.duration
    return tuple(actions)


def _used(problem: Problem, result: Result) -> dict[str, object]:
    """The values of the names in the plan, its certified facts and the initial facts."""
    names = {name for action in result.actions for name in action.arguments}
    names |= {name for fact in (*result.certified, *problem.stream_task.task.initial) for name in fact[1:]}
    values = result.objects.values
    return {name: values[name] for name in sorted(names) if name in values and not isinstance(values[name], str)}


def _silent(effort: Effort) -> None:
    pass
