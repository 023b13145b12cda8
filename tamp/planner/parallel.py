"""Planning by several processes: `solve` or `optimize` with different seeds."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

from tamp.planner.optimize import improves, optimize
from tamp.planner.problem import Problem
from tamp.planner.solution import Solution
from tamp.planner.solve import solve
from tamp.symbolic.algorithms.result import Outcome, Progress, SearchStatistics
from tamp.symbolic.search.heuristics.loops.selection import prepare as prepare_loops
from tamp.system.deadline import Deadline
from tamp.system.race import Tell, member_seed, race

SECONDS_BETWEEN_REPORTS = 0.1
"""Seconds between two reports of a run's progress."""

FINAL_OUTCOMES = (Outcome.SOLVED, Outcome.INFEASIBLE)
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
    deadline = Deadline(max_time)
    settings = _Settings(problem, seed, algorithm, accept, record, improved is not None)
    if jobs == 1:
        return _planned(settings, seed, algorithm, max_time, progress, improved)

    prepare_loops()
    best = _Best(settings, progress, improved)
    members = [partial(_member, settings, deadline, number) for number in range(jobs)]
    outcome = Outcome.TIMEOUT
    try:
        found = race(members, partial(_ends, settings), deadline, best.hear)
    except KeyboardInterrupt:
        found, outcome = None, Outcome.INTERRUPTED

    if best.plan is not None:
        return best.plan
    if found is None:
        return Solution(problem, outcome, seed, algorithm, seconds={"total": deadline.elapsed()})
    return Solution(problem=problem, **found.answer["parts"])


@dataclass(frozen=True, eq=False)
class _Settings:
    """Settings that all runs of a race share.

    Attributes:
        problem: To plan.
        seed: Of the first run.
        algorithm: Of all runs but the third.
        accept: Looks at a plan, in the process that made it.
        record: As for `solve`.
        optimizing: Whether runs go on after their first plan.
    """

    problem: Problem
    seed: int
    algorithm: str
    accept: Callable[[Solution], bool] | None
    record: bool
    optimizing: bool


def _planned(
    settings: _Settings,
    seed: int,
    algorithm: str,
    max_time: float,
    progress: Progress | None,
    improved: Callable[[Solution], None] | None,
) -> Solution:
    """Plan once, in this process."""
    problem, record = settings.problem, settings.record
    if improved is not None:
        return optimize(
            problem, max_time=max_time, seed=seed, progress=progress, improved=improved,
            record=record,
        )  # fmt: skip
    return solve(
        problem, max_time=max_time, seed=seed, algorithm=algorithm, progress=progress, record=record
    )


def _member(settings: _Settings, deadline: Deadline, number: int, tell: Tell) -> dict[str, Any]:
    """Make one run of the race; answer with its plan's parts and whether it may end the race."""
    solution = _planned(
        settings,
        member_seed(settings.seed, number),
        "incremental" if number == 2 else settings.algorithm,
        deadline.left(),
        _seldom(tell) if number == 0 else None,
        (lambda plan: tell(_parts(plan))) if settings.optimizing else None,
    )
    checked = settings.accept is not None and not settings.optimizing and solution.solved
    good = not checked or settings.accept is None or settings.accept(solution)
    return {"good": good, "parts": _parts(solution)}


def _ends(settings: _Settings, number: int, answer: dict[str, Any]) -> bool:
    """Check whether an answer ends the race."""
    outcome = answer["parts"]["outcome"]
    if number == 0 and outcome not in (Outcome.SOLVED, Outcome.TIMEOUT):
        return True
    return outcome in FINAL_OUTCOMES and answer["good"] and not settings.optimizing


class _Best:
    """Hears what runs tell: the first one's progress, and plans, of which it keeps the best.

    Attributes:
        plan: The best so far.
    """

    def __init__(
        self,
        settings: _Settings,
        progress: Progress | None,
        improved: Callable[[Solution], None] | None,
    ) -> None:
        self._problem, self._progress, self._improved = settings.problem, progress, improved
        self.plan: Solution | None = None

    def hear(self, number: int, told: SearchStatistics | dict[str, Any]) -> None:
        """Receive a report of a run."""
        if isinstance(told, SearchStatistics):
            if self._progress is not None:
                self._progress(told)
            return

        solution = Solution(problem=self._problem, **told)
        if self._improved is not None and (self.plan is None or improves(solution, self.plan)):
            self.plan = solution
            self._improved(solution)


def _seldom(tell: Tell) -> Progress:
    last = 0.0

    def progress(effort: SearchStatistics) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= SECONDS_BETWEEN_REPORTS:
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
