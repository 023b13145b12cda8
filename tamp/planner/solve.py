"""Planning as a function: a problem in, a solution out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from tamp.errors import InputError
from tamp.planner.assembly import (
    build_solution,
    interrupted_solution,
    random_streams,
    with_trajectories,
)
from tamp.planner.contradictions import contradictions
from tamp.planner.problem import Problem
from tamp.planner.recorder import Recorder
from tamp.planner.solution import Action, Solution
from tamp.symbolic.algorithms.bound_stream import FOREIGN_CALLERS
from tamp.symbolic.algorithms.registry import ALGORITHMS
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, SearchStatistics, StreamTask
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.interrupts import Interrupter

MOST_TRIES = 8
"""Plans that are made at most until the classifiers bear one out."""


def solve(
    problem: Problem,
    *,
    max_time: float = 30.0,
    seed: int = 0,
    algorithm: str = "adaptive",
    progress: Progress | None = None,
    record: bool = False,
) -> Solution:
    """Plan.

    The same seed gives the same plan, as long as the time did not run out.

    Args:
        problem: From `load_problem`.
        max_time: Seconds.
        seed: Of all randomness.
        algorithm: "adaptive" or "incremental".
        progress: Called now and then with what was done so far.
        record: Keep what was tried in the solution, for `tamp.view`; the plan is the same.

    Raises:
        InputError: Unknown algorithm, or a time that is not positive.
    """
    if algorithm not in ALGORITHMS:
        raise InputError(f"unknown algorithm '{algorithm}'", found=algorithm, choices=ALGORITHMS)
    if not max_time > 0.0:
        raise InputError(f"the time must be positive, not {max_time:g}")

    deadline = Deadline(max_time)
    recorder = Recorder() if record else None
    task = problem.stream_task if recorder is None else recorder.watched(problem.stream_task)

    def plan() -> tuple[Result, tuple[Action, ...], float]:
        result = _borne_out(problem, task, seed, algorithm, deadline, progress or _silent)
        planned = deadline.elapsed()
        return result, with_trajectories(problem, result), planned

    try:
        result, actions, planned = Interrupter(deadline, strangers=FOREIGN_CALLERS).run(plan)
    except (OutOfTime, KeyboardInterrupt) as end:
        # Before the first round, or while a bound plan was being timed.
        outcome = Outcome.TIMEOUT if isinstance(end, OutOfTime) else Outcome.INTERRUPTED
        return interrupted_solution(problem, outcome, seed, algorithm, deadline.elapsed(), recorder)

    total = deadline.elapsed()
    return build_solution(
        problem,
        result,
        actions,
        seed,
        algorithm,
        {"total": total, "timing": total - planned},
        recorder,
    )


def _borne_out(
    problem: Problem,
    task: StreamTask,
    seed: int,
    algorithm: str,
    deadline: Deadline,
    progress: Progress,
) -> Result:
    """Find a plan in whose states the user's classifiers say what they said of its poses.

    Only those that look at more than their arguments can make the first plan another one than that
    of the seed.
    """
    make_rng = random_streams(seed)
    result = ALGORITHMS[algorithm](task, make_rng, deadline, progress)
    wrong = contradictions(problem, result)
    for again in range(1, MOST_TRIES):
        if not wrong or deadline.passed:
            break
        result = ALGORITHMS[algorithm](task, partial(_renamed, make_rng, again), deadline, progress)
        wrong = contradictions(problem, result)
    return replace(result, outcome=Outcome.EXHAUSTED, actions=(), causes=wrong) if wrong else result


def _renamed(make_rng: Callable[[str], Any], again: int, key: str) -> Any:
    return make_rng(f"{again} {key}")


def _silent(effort: SearchStatistics) -> None:
    pass
