"""Growth with the number of objects: solved runs and times for 4 to 20 objects, and the exponent between the medians.

python -m benchmarks.scale --seeds 20 --time 30
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import tyro

from benchmarks import solve
from benchmarks.common import percentile, record, table

SIZES = {"four_objects": 4, "eight_objects": 8, "twelve_objects": 12, "twenty_objects": 20}


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        seeds: Runs of each problem.
        time: Budget of one run in seconds; twenty objects have twice as much.
        problems: Some of four_objects, eight_objects, twelve_objects, twenty_objects.
    """

    seeds: int = 20
    time: float = 30.0
    problems: tyro.conf.Positional[tuple[str, ...]] = tuple(SIZES)


def exponent(few: float, many: float, ratio: float) -> float:
    """The power of the number of objects with which the time grows from `few` to `many` seconds."""
    return math.log(many / few) / math.log(ratio) if few > 0.0 and many > 0.0 else math.nan


def main(options: Options) -> None:
    """Run all, print the table."""
    rows: list[dict[str, object]] = []
    medians: dict[str, float] = {}
    for name in options.problems:
        seconds = options.time * (2.0 if SIZES[name] >= 20 else 1.0)
        chosen = solve.Options(problems=(name,), seeds=options.seeds, time=seconds, out="scale.jsonl")
        results = []
        for _, seed, result in solve.runs(chosen):
            record("scale.jsonl", seed=seed, config={"problem": name, "time_s": seconds}, **result)
            print(f"{name:16} seed {seed:3}  {result['outcome']:12} {result['planning_s']:7.2f} s", flush=True)
            results.append(result)
        medians[name] = percentile([r["planning_s"] if r["solved"] else math.inf for r in results], 50)
        first = next(iter(medians))
        growth = math.nan
        if name != first:
            growth = exponent(medians[first], medians[name], SIZES[name] / SIZES[first])
        rows.append({**solve.row(name, results), "grows with n^": growth})
    table(
        rows, "Scale: time of those solved; growth of the median from the first problem, runs without a plan infinite"
    )


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
