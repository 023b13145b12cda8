"""Whether the explanation names the cause: seeded problems without a plan, each built around a known cause.

python -m benchmarks.infeasible --time 5             # 48 problems: 12 kinds, three of each, and one of 12 more
"""

from __future__ import annotations

import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro

from benchmarks.common import percentile, record, table
from benchmarks.infeasible_more import MORE
from benchmarks.infeasible_scenes import KINDS, Case

LINES = 3
"""The cause must be named in one of so many first lines."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        each: Problems of each of the first twelve kinds,
        more: and of each of the others.
        time: Budget of one run in seconds.
        kinds: Some of them; all by default.
        show: Print the explanations.
    """

    each: int = 3
    more: int = 1
    time: float = 5.0
    kinds: tyro.conf.Positional[tuple[str, ...]] = ()
    show: bool = False


def named(case: Case, explanation: tuple[str, ...]) -> bool:
    """Whether one of the first lines contains a word of every group."""
    return any(all(any(word in line for word in group) for group in case.cause) for line in explanation[:LINES])


def main(options: Options) -> None:
    """Run all, print the table."""
    from tamp.planner.problem import load_problem
    from tamp.planner.solve import solve

    rows: dict[str, list[dict[str, object]]] = defaultdict(list)
    for number, make in enumerate((*KINDS, *MORE)):
        if options.kinds and make.__name__ not in options.kinds:
            continue
        for seed in range(options.each if make in KINDS else options.more):
            case = make(np.random.default_rng((number, seed)))
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / f"{case.kind}.yaml"
                path.write_text(case.text, encoding="utf-8")
                problem = load_problem(path)
            began, used = time.perf_counter(), time.process_time()
            solution = solve(problem, max_time=options.time, seed=seed)
            result = {
                "outcome": solution.outcome.name,
                "named": named(case, solution.explanation),
                "planning_s": time.perf_counter() - began,
                "planning_cpu_s": time.process_time() - used,
                "explanation": list(solution.explanation),
            }
            record("infeasible.jsonl", seed=seed, config={"kind": case.kind, "time_s": options.time}, **result)
            rows[case.kind].append(result)
            right = "right" if result["named"] else "WRONG"
            print(
                f"{case.kind:18} seed {seed}  {right}  {solution.outcome.name:10} {result['planning_s']:6.2f} s", end=""
            )
            print(f" {result['planning_cpu_s']:6.2f} s of CPU")
            for line in solution.explanation if options.show else ():
                print(f"    {line}")
    table([row(kind, results) for kind, results in rows.items()], "The cause named, by kind")
    right = sum(bool(result["named"]) for results in rows.values() for result in results)
    print(f"the right cause is named in {right} of {sum(map(len, rows.values()))}")


def row(kind: str, results: list[dict[str, object]]) -> dict[str, object]:
    """One kind as a row."""
    outcomes = [str(result["outcome"]) for result in results]
    return {
        "kind": kind,
        "named": f"{sum(bool(result['named']) for result in results)}/{len(results)}",
        "infeasible": outcomes.count("INFEASIBLE"),
        "exhausted": outcomes.count("EXHAUSTED"),
        "timeout": outcomes.count("TIMEOUT"),
        "WRONGLY solved": outcomes.count("SOLVED"),
        "most CPU [s]": max(float(str(result["planning_cpu_s"])) for result in results),
        "median [s]": percentile([float(str(result["planning_s"])) for result in results], 50),
    }


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
