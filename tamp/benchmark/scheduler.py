"""Schedule the runs of a benchmark over workers: none is lost, and none is done twice."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable
from typing import Any

from tamp.benchmark.case import Case
from tamp.benchmark.log import Log
from tamp.benchmark.worker_pool import WorkerPool

ATTEMPTS = 3
"""So often a run is given out whose worker is lost on the way; then it is written down as lost."""

LOST = "LOST"
"""The outcome of such a run."""


def run_all(
    cases: list[Case], pool: WorkerPool, log: Log, ended: Callable[[dict[str, Any], int], None]
) -> None:
    """Do all runs that the log does not have. The pool stays.

    Args:
        cases: All of them.
        pool: Who does them.
        log: What is known, and where each line is written as soon as its run has ended.
        ended: Called for each run that has ended, with its line and the number of runs that are
            still to come.
    """
    waiting = deque(log.missing(cases))
    losses: Counter[Case] = Counter()
    under_way = 0
    while waiting or under_way:
        while waiting and under_way < pool.size:
            pool.start(waiting.popleft())
            under_way += 1
        for case, line in pool.finished():
            under_way -= 1
            if line is None:
                losses[case] += 1
                if losses[case] < ATTEMPTS:
                    waiting.append(case)
                    continue
                line = crashed_result(case)
            log.add(line)
            ended(line, len(waiting) + under_way)


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
