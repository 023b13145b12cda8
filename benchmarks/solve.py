"""How often and how fast problems are solved, every plan judged by the verifier.

python -m benchmarks.solve four_objects --seeds 100 --time 30
python -m benchmarks.solve                                        # the whole ladder, five seeds each
"""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from benchmarks.common import record, table, times, wilson

LADDER = (
    "one_object", "two_objects", "four_objects", "eight_objects", "cluttered", "packed", "shelves", "drawers",
    "blocked", "swap", "impossible_reach", "impossible_size",
)  # fmt: skip


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        problems: Shipped problems' names or paths; the whole ladder when empty.
        seeds: Seeds first, first + 1, ... of each problem.
        first: The first seed.
        time: Budget of one run in seconds.
        jobs: Runs at a time; more than the cores makes the times meaningless.
        fresh: Start a process for every run, so that loading the kernels counts as well.
        algorithm: The planner's algorithm.
        on: The sampler of placements on surfaces; the domain's own when not given.
        out: The name of the file under benchmarks/results.
    """

    problems: tyro.conf.Positional[tuple[str, ...]] = ()
    seeds: int = 5
    first: int = 0
    time: float = 30.0
    jobs: Annotated[int, tyro.conf.arg(aliases=["-j"])] = 1
    fresh: bool = False
    algorithm: str = "adaptive"
    on: str | None = None
    out: str = "solve.jsonl"


def run(name: str, seed: int, options: Options) -> dict[str, Any]:
    """Plan once and judge the plan. Times in seconds."""
    import tamp
    from tamp.verification.verify import verify

    began = time.perf_counter()
    problem = tamp.load_problem(name, samplers={"on": options.on} if options.on else {})
    loaded = time.perf_counter()
    solution = tamp.solve(problem, max_time=options.time, seed=seed, algorithm=options.algorithm)
    planned = time.perf_counter()
    result: dict[str, Any] = {
        "outcome": solution.outcome.name,
        "solved": solution.solved,
        "load_s": loaded - began,
        "planning_s": planned - loaded,
        "verified": None,
        "violations": [],
        "explanation": list(solution.explanation),
        "seconds": dict(solution.seconds),
        "samples": {name: [s.successes, s.calls] for name, s in solution.statistics.items() if s.calls},
    }
    if solution.solved:
        result |= {"actions": len(solution.plan), "cost": solution.cost, "motion_s": solution.duration}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "plan.json"
            tamp.write_plan(solution, path)
            verdict = verify(path)
        result["verified"] = verdict.holds
        result["violations"] = [str(violation) for violation in verdict.violations][:5]
        result["verify_s"] = time.perf_counter() - planned
    return result


def runs(options: Options) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """All runs, in order, as they end."""
    cases = [(name, options.first + i) for name in options.problems or LADDER for i in range(options.seeds)]
    context = multiprocessing.get_context("spawn")
    once = 1 if options.fresh else None
    with ProcessPoolExecutor(options.jobs, mp_context=context, max_tasks_per_child=once) as pool:
        if not options.fresh:  # compile and load the kernels before anything is timed
            warm = [pool.submit(run, "one_object", 0, options) for _ in range(options.jobs)]
            for future in warm:
                future.result()
        futures = [pool.submit(run, name, seed, options) for name, seed in cases]
        for (name, seed), future in zip(cases, futures, strict=True):
            yield name, seed, future.result()


def row(name: str, results: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """One problem's line of the table; the times are those of the solved runs."""
    solved = [result for result in results if result["solved"]]
    verified = sum(result["verified"] is True for result in solved)
    low, high = wilson(verified, len(results))
    return {
        "problem": name,
        "solved": f"{len(solved)}/{len(results)}",
        "verified": f"{verified}/{len(solved)}",
        "95 %": f"{low:.2f}-{high:.2f}",
        **times([result["planning_s"] for result in solved]),
        "slowest run": f"{max(result['planning_s'] for result in results):.2f}",
    }


def main(options: Options) -> None:
    results: dict[str, list[dict[str, Any]]] = {}
    config = {"time_s": options.time, "fresh": options.fresh, "jobs": options.jobs, "algorithm": options.algorithm}
    for name, seed, result in runs(options):
        results.setdefault(name, []).append(result)
        record(options.out, seed=seed, config={"problem": name, "on": options.on, **config}, **result)
        judged = {True: "verified", False: "REJECTED", None: ""}[result["verified"]]
        print(f"{name:18} seed {seed:3}  {result['outcome']:12} {result['planning_s']:7.2f} s  {judged}", flush=True)
        for violation in result["violations"]:
            print(f"    {violation}")
    table([row(name, found) for name, found in results.items()], f"solve, {options.time:g} s, {options.algorithm}")


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
