"""Growth with the number of objects: solved runs and times for 4 to 60 objects, and the exponent between the medians.

python -m benchmarks.scale --seeds 20 --time 30
python -m benchmarks.scale 30 34 36 40 60 --time 60       # made here: on eight boards, 60 on sixteen
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

import tyro

from benchmarks import solve
from benchmarks.common import percentile, record, table
from benchmarks.scale_scenes import scene

SHIPPED = {"four_objects": 4, "eight_objects": 8, "twelve_objects": 12, "twenty_objects": 20}
MADE = {"30": 8, "34": 8, "36": 8, "40": 8, "60": 16}
"""Objects, and the boards that they go to."""

SIZES = {**SHIPPED, **{name: int(name) for name in MADE}}


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        seeds: Runs of each problem.
        time: Budget of one run in seconds; twenty objects have twice as much.
        problems: Some of four_objects, eight_objects, twelve_objects, twenty_objects, which are all by default,
            and 30, 34, 36, 40, 60.
    """

    seeds: int = 20
    time: float = 30.0
    problems: tyro.conf.Positional[tuple[str, ...]] = tuple(SHIPPED)


def exponent(few: float, many: float, ratio: float) -> float:
    """The power of the number of objects with which the time grows from `few` to `many` seconds."""
    return math.log(many / few) / math.log(ratio) if few > 0.0 and many > 0.0 else math.nan


def main(options: Options) -> None:
    """Run all, print the table."""
    with tempfile.TemporaryDirectory() as folder:
        measure(options, Path(folder))


def measure(options: Options, folder: Path) -> None:
    """Run all problems; those that are made are written into the folder."""
    rows: list[dict[str, object]] = []
    medians: dict[str, float] = {}
    for name in options.problems:
        seconds = options.time * (2.0 if SIZES[name] >= 20 else 1.0)
        path = folder / f"scale_{name}.yaml"
        if name in MADE:
            path.write_text(scene(int(name), MADE[name]), encoding="utf-8")
        where = str(path) if name in MADE else name
        chosen = solve.Options(problems=(where,), seeds=options.seeds, time=seconds, out="scale.jsonl")
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
