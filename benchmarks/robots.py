"""Every robot that comes with tamp, and folders of yours: four objects planned, judged, carried out in physics.

python -m benchmarks.robots --seeds 20                                 # all that are shipped
python -m benchmarks.robots ur5 pr2 --seeds 20 --first 20
python -m benchmarks.robots robots/iiwa --problem four_objects
python -m benchmarks.robots two_pandas --problem two_arms_handover --time 60
"""

from __future__ import annotations

import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Any

import tyro

from benchmarks.common import record, table, times, wilson
from benchmarks.execution import Options as Execution
from benchmarks.execution import run

FOUR_OBJECTS = {
    "panda_mobile": "four_objects",
    "panda_fixed": "bench_four_objects",
    "ur5": "four_objects",
    "ur5_suction": "parcels",  # what is open, as a mug, closes no cup
    "xarm7": "four_objects",
    "pr2": "four_objects",
    "two_pandas": "two_arms_tables",
    "two_ur5": "two_arms_cupboard",
}
"""Each shipped robot's version of four_objects: within its reach, of what its gripper can hold."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        robots: Shipped robots' names, or folders; all that are shipped when empty.
        problem: One problem for all of them; else four_objects, scaled to each one's reach.
        seeds: Seeds first, first + 1, ...
        first: The first seed.
        time: Budget of planning, seconds on the clock; what it took of the processor is recorded.
        grasp: constraint, friction.
        engine: The physics engine.
        jobs: Runs at a time.
        out: The name of the file under benchmarks/results.
    """

    robots: tyro.conf.Positional[tuple[str, ...]] = ()
    problem: str | None = None
    seeds: int = 20
    first: int = 0
    time: float = 30.0
    grasp: str = "constraint"
    engine: str = "pybullet"
    jobs: Annotated[int, tyro.conf.arg(aliases=["-j"])] = 1
    out: str = "robots.jsonl"


def main(options: Options) -> None:
    rows: list[dict[str, Any]] = []
    execution = Execution(time=options.time)
    seeds = range(options.first, options.first + options.seeds)
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for robot in options.robots or tuple(FOUR_OBJECTS):
            name, began = options.problem or FOUR_OBJECTS.get(robot, "four_objects"), time.monotonic()
            futures = [
                pool.submit(run, name, seed, options.grasp, None, options.engine, execution, robot) for seed in seeds
            ]
            results: list[dict[str, Any]] = []
            for seed, future in zip(seeds, futures, strict=True):
                result = future.result()
                results.append(result)
                config = {
                    "robot": robot, "problem": name, "grasp": options.grasp, "engine": options.engine,
                    "time_s": options.time,
                }  # fmt: skip
                record(options.out, seed=seed, config=config, **result)
                print(f"{robot:14} {name} seed {seed:3} {_story(result)}", flush=True)
            rows.append(_row(robot, name, results))
            print(f"{robot}: {time.monotonic() - began:.0f} s", flush=True)
    table(rows, f"four objects by robot, {options.time:g} s")


def _row(robot: str, problem: str, results: list[dict[str, Any]]) -> dict[str, Any]:
    """One robot's line of the table; the times are those that the processor planned."""
    reached = sum(result["outcome"] == "reached" for result in results)
    low, high = wilson(reached, len(results))
    return {
        "robot": Path(robot).name,
        "problem": Path(problem).stem,
        "solved": f"{sum(result['outcome'] != 'no plan' for result in results)} of {len(results)}",
        "verified": sum(result.get("verified", False) for result in results),
        "reached": reached,
        "95 %": f"{100 * low:.0f}-{100 * high:.0f}",
        **times([result["planning_cpu_s"] for result in results]),
    }


def _story(result: dict[str, Any]) -> str:
    """One run in words: the processor's seconds, and what went wrong."""
    verdict = "" if result.get("verified", True) else result["verdict"]
    why = "; ".join(str(one) for one in (*result["explanation"], verdict) if one)
    return f"{result['planning_cpu_s']:7.2f} s  {result['outcome']}{': ' if why else ''}{why}"


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
