"""Doing one run: load, plan, have the plan judged, tell everything."""

from __future__ import annotations

import json
import os
import time
import traceback
from collections.abc import Callable
from typing import Any

from tamp.benchmark.case import Case
from tamp.benchmark.provenance import provenance
from tamp.geometric.samplers.choice import Registry
from tamp.geometric.samplers.mixture import SamplerRecord
from tamp.geometric.samplers.python_file import given_by_files
from tamp.plan.write import plan_text
from tamp.planner.problem import load_problem
from tamp.planner.solution import Solution
from tamp.planner.solve import solve
from tamp.stream import StreamKind

ERROR = "ERROR"
"""The outcome of a run in which the planner or the judge raised."""

VIOLATIONS = 5
"""How many of a refused plan's are kept."""


PARTS = {
    StreamKind.GRASPS: "sampling",
    StreamKind.PLACEMENTS: "sampling",
    StreamKind.IK: "ik",
    StreamKind.TESTS: "collision",
    StreamKind.MOTION: "motion",
    StreamKind.OTHER: StreamKind.OTHER.value,
}
"""Parts of the time in a robot's planner's words, by the kinds of streams."""


def warm_up() -> None:
    """Compile and load what the first run would have to wait for."""
    solve(load_problem("one_object"), max_time=60.0)


def run_case(case: Case, registry: Callable[[], Registry]) -> dict[str, Any]:
    """Run a case; what comes back is one line of the results. Times in seconds.

    An error of the planner or the judge is an outcome, too: a benchmark of a thousand runs goes on,
    and shows it.

    Args:
        case: What to run.
        registry: Gives the samplers beyond the hand-made ones.
    """
    began = time.perf_counter()
    try:
        line = _run(case, registry)
    except Exception as error:
        line = {
            "outcome": ERROR,
            "solved": False,
            "verified": None,
            "planning_s": time.perf_counter() - began,
            "explanation": traceback.format_exception(error),
        }
    told = {"config": case.config, "seed": case.seed, **line}
    return {**told, **provenance(), "load": round(os.getloadavg()[0], 2)}


def _run(case: Case, registry: Callable[[], Registry]) -> dict[str, Any]:
    began = time.perf_counter()
    names, objects = given_by_files(dict(case.samplers), dict(case.sources))
    problem = load_problem(case.problem, samplers=names, groundings=objects, registry=registry())
    loaded, used = time.perf_counter(), time.process_time()
    solution = solve(problem, max_time=case.time, seed=case.seed, algorithm=case.algorithm)
    planned, spent = time.perf_counter(), time.process_time() - used
    line: dict[str, Any] = {
        "outcome": solution.outcome.name,
        "solved": solution.solved,
        "load_s": loaded - began,
        "planning_s": planned - loaded,
        "cpu_s": spent,
        "explanation": list(solution.explanation),
        "warnings": list(solution.warnings),
        "parts_s": parts(solution),
        "streams": {
            name: {
                "calls": one.calls,
                "successes": one.successes,
                "seconds": one.seconds,
                "reasons": dict(one.reasons.most_common(3)),
            }
            for name, one in solution.statistics.items()
            if one.calls
        },
        "samplers": {
            relation: [_account(one) for one in found]
            for relation, found in solution.samplers.items()
        },
        "verified": None,
    }
    if solution.solved:
        line |= {
            "actions": len(solution.plan),
            "cost": solution.cost,
            "motion_s": solution.duration,
        }
        line |= _verdict(solution)

    return line


def parts(solution: Solution) -> dict[str, float]:
    """Split the time by what it went to, in the words of a robot's planner; "symbolic" is all that
    is not spent in streams.
    """
    times = dict.fromkeys(("symbolic", *PARTS.values(), "timing"), 0.0)
    kinds = {one.name: one.kind for one in solution.problem.stream_task.streams}
    for name, statistics in solution.statistics.items():
        times[PARTS[kinds.get(name, StreamKind.OTHER)]] += statistics.seconds
    times["timing"] = solution.seconds.get("timing", 0.0)
    times["symbolic"] = max(0.0, solution.seconds.get("total", 0.0) - sum(times.values()))
    return times


def _account(account: SamplerRecord) -> dict[str, Any]:
    return {
        "name": account.name,
        "judged": account.judged,
        "kept": account.kept,
        "work": account.work,
        "seconds": account.seconds,
        "out": account.out,
    }


def _verdict(solution: Solution) -> dict[str, Any]:
    from tamp.verification.verify import verify

    began = time.perf_counter()
    report = verify(json.loads(plan_text(solution)))
    return {
        "verified": report.holds,
        "violations": [str(violation) for violation in report.violations[:VIOLATIONS]],
        "verify_s": time.perf_counter() - began,
    }
