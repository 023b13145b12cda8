"""Anytime planning: after the first plan fewer actions, then shorter motions, until time is up."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from dataclasses import replace
from random import Random

from tamp.errors import InputError
from tamp.planner.assembly import (
    build_solution,
    interrupted_solution,
    random_streams,
    with_trajectories,
)
from tamp.planner.problem import Problem
from tamp.planner.recorder import Recorder
from tamp.planner.solution import Improvement, Solution
from tamp.planner.timed_trajectories import TimingCache
from tamp.symbolic.algorithms.anytime import solve_anytime
from tamp.symbolic.algorithms.bound_stream import FOREIGN_CALLERS
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, SearchStatistics
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.interrupts import Interrupter

MIN_IMPROVEMENT_SHARE = 1e-3
"""The part by which the motion must be shorter to count as an improvement."""

MAX_TIMED_PATHS = 20_000
"""Timed paths that are kept."""


def optimize(
    problem: Problem,
    *,
    max_time: float = 30.0,
    seed: int = 0,
    progress: Progress | None = None,
    improved: Callable[[Solution], None] | None = None,
    record: bool = False,
) -> Solution:
    """Plan by the algorithm "adaptive", then improve the plan until time is up or Ctrl-C.

    The same seed gives the same sequence of improvements; how many there are depends on the clock.

    Args:
        problem: From `load_problem`.
        max_time: Seconds, all of which are used.
        seed: Of all randomness.
        progress: Called now and then with what was done so far.
        improved: Called with each plan that is better than those before it.
        record: As for `solve`.

    Returns:
        The best plan, with all improvements and the lower bound of the cost; as from `solve` when
        there is none.

    Raises:
        InputError: A time that is not positive.
    """
    if not max_time > 0.0:
        raise InputError(f"the time must be positive, not {max_time:g}")

    deadline = Deadline(max_time)
    recorder = Recorder() if record else None
    task = problem.stream_task if recorder is None else recorder.watched(problem.stream_task)
    cache: TimingCache = {}
    best: list[Solution] = []

    def better(result: Result) -> bool:
        began = deadline.elapsed()
        if len(cache) > MAX_TIMED_PATHS:
            cache.clear()
        plan = with_trajectories(problem, result, cache)

        now = deadline.elapsed()
        seconds = {"total": now, "timing": now - began}
        found = build_solution(problem, _frozen(result), plan, seed, "adaptive", seconds, recorder)
        if best and not improves(found, best[0]):
            return False

        step = Improvement(now, found.cost, len(found.plan), found.duration)
        if not best:
            best.append(replace(found, improvements=(step,)))
            return True
        best[0] = replace(found, improvements=(*best[0].improvements, step), bound=best[0].bound)
        if improved is not None:
            improved(best[0])
        return True

    def bounded(bound: float) -> None:
        best[0] = replace(best[0], bound=bound)
        if improved is not None:
            improved(best[0])

    def plan() -> Result:
        return solve_anytime(
            task, random_streams(seed), deadline, progress or _silent, better, bounded, Random(seed)
        )  # fmt: skip

    outcome = Outcome.TIMEOUT
    try:
        result = Interrupter(deadline, strangers=FOREIGN_CALLERS).run(plan)
        if not best:
            seconds = {"total": deadline.elapsed(), "timing": 0.0}
            return build_solution(problem, result, (), seed, "adaptive", seconds, recorder)
    except OutOfTime:
        pass
    except KeyboardInterrupt:
        outcome = Outcome.INTERRUPTED

    if not best:
        return interrupted_solution(
            problem, outcome, seed, "adaptive", deadline.elapsed(), recorder
        )
    return replace(best[0], seconds={**best[0].seconds, "total": deadline.elapsed()})


def improves(new: Solution, old: Solution) -> bool:
    """Compare plans: better is cheaper, then fewer actions, then shorter motion."""
    if not math.isclose(new.cost, old.cost, rel_tol=1e-9, abs_tol=1e-9):
        return new.cost < old.cost
    if len(new.plan) != len(old.plan):
        return len(new.plan) < len(old.plan)
    return new.duration < (1.0 - MIN_IMPROVEMENT_SHARE) * old.duration


def _frozen(result: Result) -> Result:
    """Copy the counts as they are now: the run goes on counting."""
    return replace(
        result, statistics=copy.deepcopy(result.statistics), effort=replace(result.effort)
    )


def _silent(effort: SearchStatistics) -> None:
    pass
