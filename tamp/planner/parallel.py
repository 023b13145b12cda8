"""Planning by several processes: `solve` or `optimize` with different seeds."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable
from dataclasses import fields
from typing import Any

from tamp.planner.optimize import improves, optimize
from tamp.planner.problem import Problem
from tamp.planner.solution import Solution
from tamp.planner.solve import solve
from tamp.symbolic.algorithms.result import Effort, Outcome, Progress
from tamp.symbolic.search.heuristics.loops.selection import prepare as prepare_loops
from tamp.system.deadline import Deadline
from tamp.system.race import Tell, member_seed, race

EVERY = 0.1
"""Seconds between two reports of a run's progress."""

FINAL = (Outcome.SOLVED, Outcome.INFEASIBLE)
"""Outcomes that settle the matter, whichever run says so."""


def solve_parallel(
    problem: Problem,
    *,
    jobs: int,
    max_time: float = 30.0,
    seed: int = 0,
    algorithm: str = "adaptive",
    progress: Progress | None = None,
    accept: Callable[[Solution], bool] | None = None,
    improved: Callable[[Solution], None] | None = None,
    record: bool = False,
) -> Solution:
    """Plan in `jobs` processes; the first plan counts, with `improved` the best when time is up.

    The first run is what `solve` does with the same arguments, the others have seeds of their own
    (`member_seed`); the third is by the algorithm "incremental". Which plan comes first depends on
    the clock, yet each is the plan of one run: `solve` with the seed and the algorithm that the
    solution names makes it again. The others give way to the first run where cores are scarce.

    Args:
        problem: From `load_problem`.
        jobs: Number of processes; one is this one.
        max_time: Seconds.
        seed: Of the first run.
        algorithm: Of all runs but the third.
        progress: Called now and then with what the first run has done.
        accept: Looks at a plan, in the process that made it; one that it refuses does not end the
            race.
        record: As for `solve`.
        improved: Go on after the first plan, and call this with each that is better.

    Raises:
        InputError: As for `solve`.
    """
    if jobs == 1 and improved is not None:
        return optimize(
            problem,
            max_time=max_time,
            seed=seed,
            progress=progress,
            improved=improved,
            record=record,
        )
    if jobs == 1:
        return solve(
            problem,
            max_time=max_time,
            seed=seed,
            algorithm=algorithm,
            progress=progress,
            record=record,
        )

    # No fork while a thread is importing it.
    importlib.import_module("tamp.geometric.motion.parametrization")
    prepare_loops()
    deadline = Deadline(max_time)
    best: list[Solution] = []

    def member(number: int) -> Callable[[Tell], dict[str, Any]]:
        def run(tell: Tell) -> dict[str, Any]:
            left, own = deadline.left(), member_seed(seed, number)
            told = _seldom(tell) if number == 0 else None
            if improved is not None:
                shared = optimize(
                    problem,
                    max_time=left,
                    seed=own,
                    progress=told,
                    improved=lambda plan: tell(_parts(plan)),
                    record=record,
                )
                return {"good": True, "parts": _parts(shared)}

            name = "incremental" if number == 2 else algorithm
            solution = solve(
                problem, max_time=left, seed=own, algorithm=name, progress=told, record=record
            )
            good = accept is None or not solution.solved or accept(solution)
            return {"good": good, "parts": _parts(solution)}

        return run

    def ends(number: int, answer: dict[str, Any]) -> bool:
        outcome = answer["parts"]["outcome"]
        if number == 0 and outcome not in (Outcome.SOLVED, Outcome.TIMEOUT):
            return True
        return outcome in FINAL and answer["good"] and improved is None

    def news(number: int, told: Effort | dict[str, Any]) -> None:
        if isinstance(told, Effort):
            if progress is not None:
                progress(told)
            return
        solution = Solution(problem=problem, **told)
        if improved is not None and (not best or improves(solution, best[0])):
            best[:] = [solution]
            improved(solution)

    outcome = Outcome.TIMEOUT
    try:
        found = race([member(number) for number in range(jobs)], ends, deadline, news)
    except KeyboardInterrupt:
        found, outcome = None, Outcome.INTERRUPTED

    if best:
        return best[0]
    if found is None:
        return Solution(problem, outcome, seed, algorithm, seconds={"total": deadline.elapsed()})
    return Solution(problem=problem, **found.answer["parts"])


def _seldom(tell: Tell) -> Progress:
    last = 0.0

    def progress(effort: Effort) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= EVERY:
            last = now
            tell(effort)

    return progress


def _parts(solution: Solution) -> dict[str, Any]:
    """Take a solution apart, without its problem: no pipe carries streams, all have them."""
    return {
        part.name: getattr(solution, part.name)
        for part in fields(solution)
        if part.name != "problem"
    }
