"""Schedule the runs of a benchmark over workers: none is lost, and none is done twice."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from tamp.benchmark.case import Case
from tamp.benchmark.log import RunLog
from tamp.benchmark.worker_pool import R, WorkerPool

ATTEMPTS = 3
"""So often a run is given out whose worker is lost on the way; then it is written down as lost."""

LOST = "LOST"
"""The outcome of such a run."""


def run_all(
    cases: list[Case],
    pool: WorkerPool[Case],
    log: RunLog,
    ended: Callable[[dict[str, Any], int], None],
) -> None:
    """Do all runs that the log does not have. The pool stays.

    Args:
        cases: All of them.
        pool: Who does them.
        log: What is known, and where each line is written as soon as its run has ended.
        ended: Called for each run that has ended, with its line and the number of runs that are
            still to come.
    """
    for case, line, left in dispatch(log.missing(cases), pool):
        found = crashed_result(case) if line is None else line
        log.add(found)
        ended(found, left)


def dispatch(runs: Iterable[R], pool: WorkerPool[R]) -> Iterator[tuple[R, Any, int]]:
    """Hand runs to the workers, one whose worker is lost on the way ATTEMPTS times.

    Args:
        runs: Each is done once.
        pool: Who does them.

    Yields:
        Each as it ends, with what came out, None for one that was lost each time, and the number of
        runs that are still to come.
    """
    waiting = deque(runs)
    losses: Counter[R] = Counter()
    under_way = 0
    while waiting or under_way:
        while waiting and under_way < pool.size:
            pool.start(waiting.popleft())
            under_way += 1
        for run, found in pool.finished():
            under_way -= 1
            if found is None:
                losses[run] += 1
                if losses[run] < ATTEMPTS:
                    waiting.append(run)
                    continue
            yield run, found, len(waiting) + under_way


def crashed_result(case: Case) -> dict[str, Any]:
    """Return the line of a run whose workers were lost each time: it counts as one that took all
    its time in vain.
    """
    return {
        "config": case.config,
        "seed": case.seed,
        "outcome": LOST,
        "solved": False,
        "verified": None,
        "planning_s": case.time,
        "explanation": [f"its process ended {ATTEMPTS} times"],
    }
