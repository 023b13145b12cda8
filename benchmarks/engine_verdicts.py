"""Verdicts of the judge by each engine: plans of shipped problems as they are, and each spoilt at random.

    python -m benchmarks.engine_verdicts one_object four_objects shelves --seeds 20 --spoilt 3

A spoilt plan has one number moved by up to four centimetres or so, often by less than the tolerances: the engines may
differ only where a distance is within what pybullet rounds (docs/engines.md).
"""

from __future__ import annotations

import copy
import json
import math
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro

from benchmarks.common import record, table
from tamp.simulation.engines import ENGINES

Plan = dict[str, Any]
FAR = 0.04
"""Metres by which something is moved, at most."""


@dataclass(frozen=True)
class Options:
    """What to judge.

    Attributes:
        problems: Shipped problems' names or paths.
        seeds: Seeds first, first + 1, ... of each problem.
        first: The first seed.
        spoilt: Spoilt copies of each plan.
        time: Budget of planning, seconds.
        jobs: Plans at a time.
        out: The name of the file under benchmarks/results.
    """

    problems: tyro.conf.Positional[tuple[str, ...]] = ("one_object", "two_objects", "four_objects", "shelves")
    seeds: int = 10
    first: int = 0
    spoilt: int = 3
    time: float = 30.0
    jobs: Annotated[int, tyro.conf.arg(aliases=["-j"])] = 1
    out: str = "engine_verdicts.jsonl"


def _segments(plan: Plan, part: str) -> list[Plan]:
    return [one for action in plan["actions"] for one in action["segments"] if one["part"] == part]


def _size(rng: np.random.Generator) -> float:
    """A size between 0.1 mm and FAR, all magnitudes alike, of either sign."""
    return float(np.exp(rng.uniform(np.log(1e-4), np.log(FAR))) * rng.choice([-1.0, 1.0]))


def _aside(part: str) -> Callable[[Plan, np.random.Generator], Any]:
    """A motion swings aside and comes back."""

    def spoil(plan: Plan, rng: np.random.Generator) -> None:
        some = _segments(plan, part)
        one = some[int(rng.integers(len(some)))]
        rows = np.array(one["positions"])
        column = int(rng.integers(2 if part == "base" else rows.shape[1]))
        rows[:, column] += 3 * _size(rng) * np.sin(np.linspace(0, np.pi, len(rows))) ** 2
        one["positions"] = rows.tolist()

    return spoil


def _pose(plan: Plan, rng: np.random.Generator) -> None:
    poses = [value for value in plan["values"].values() if value["type"] == "pose"]
    poses[int(rng.integers(len(poses)))]["position"][int(rng.integers(3))] += _size(rng)


def _grasp(plan: Plan, rng: np.random.Generator) -> None:
    grasps = [value for value in plan["values"].values() if value["type"] == "grasp"]
    grasps[int(rng.integers(len(grasps)))]["T_tool_body"]["position"][int(rng.integers(3))] += _size(rng)


def _width(plan: Plan, rng: np.random.Generator) -> None:
    closing = [one for one in _segments(plan, "gripper") if "attach" in one]
    closing[int(rng.integers(len(closing)))]["opening"][-1] += _size(rng)


def _early(plan: Plan, rng: np.random.Generator) -> None:
    """A body is let go of before the arm is down."""
    arms = _segments(plan, "arm")
    one = arms[int(rng.integers(len(arms)))]
    keep = max(2, round(len(one["times"]) * float(rng.uniform(0.9, 1.0))))
    one["times"], one["positions"] = one["times"][:keep], one["positions"][:keep]


def _skip(plan: Plan, rng: np.random.Generator) -> None:
    del plan["actions"][int(rng.integers(len(plan["actions"])))]


SPOIL: dict[str, Callable[[Plan, np.random.Generator], Any]] = {
    "base aside": _aside("base"), "arm aside": _aside("arm"), "another pose": _pose, "another grasp": _grasp,
    "another width": _width, "an arm stops early": _early, "an action is left out": _skip,
}  # fmt: skip


def judged(document: Plan, classifiers: Any = None) -> dict[str, Any]:
    """Both verdicts, what only one of them finds, and the seconds of each."""
    from tamp.verification.verify import verify

    holds, found, seconds = {}, {}, {}
    for name in ENGINES:
        began = time.process_time()
        report = verify(document, engine=name, classifiers=classifiers)
        seconds[name] = time.process_time() - began
        holds[name] = report.holds
        found[name] = {(one.index, one.kind, tuple(sorted(one.bodies))): str(one) for one in report.violations}
    alone = {
        name: [
            text
            for key, text in mine.items()
            if not any(key in others for other, others in found.items() if other != name)
        ]
        for name, mine in found.items()
    }
    return {"holds": holds, "alone": alone, "cpu_seconds": seconds}


def run(name: str, seed: int, options: Options) -> list[dict[str, Any]]:
    """Judge one plan and its spoilt copies."""
    import tamp
    from tamp.commands.solve import registry

    problem = tamp.load_problem(name, registry=registry())
    solution = tamp.solve(problem, max_time=options.time, seed=seed)
    if not solution.solved:
        return []
    with tempfile.TemporaryDirectory() as folder:
        document = json.loads(tamp.write_plan(solution, Path(folder) / "plan.json").read_text())
    results = [{"spoilt": None, **judged(document, problem.classifiers)}]
    rng = np.random.default_rng([seed, len(document["actions"])])
    kinds = [kind for kind in SPOIL if kind != "base aside" or _segments(document, "base")]
    for _ in range(options.spoilt):
        kind = kinds[int(rng.integers(len(kinds)))]
        copied = copy.deepcopy(document)
        SPOIL[kind](copied, rng)
        results.append({"spoilt": kind, **judged(copied, problem.classifiers)})
    return results


def main(options: Options) -> None:
    """Judge, print what differs, write."""
    rows: list[dict[str, Any]] = []
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for name in options.problems:
            seeds = range(options.first, options.first + options.seeds)
            futures = [pool.submit(run, name, seed, options) for seed in seeds]
            results: list[dict[str, Any]] = []
            for seed, future in zip(seeds, futures, strict=True):
                for one in future.result():
                    results.append(one)
                    record(options.out, seed=seed, config={"problem": name, "spoilt": one["spoilt"]}, **one)
                    if len({*one["holds"].values()}) > 1:
                        print(f"  {name} seed {seed} {one['spoilt']}: {one['holds']} {one['alone']}", flush=True)
            rows.append(_row(name, results))
            print(f"{name}: {rows[-1]}", flush=True)
    table(rows, "verdicts by two engines")


def _row(name: str, results: list[dict[str, Any]]) -> dict[str, Any]:
    seconds = [one["cpu_seconds"] for one in results]
    return {
        "problem": Path(name).stem,
        "plans": sum(one["spoilt"] is None for one in results),
        "spoilt": sum(one["spoilt"] is not None for one in results),
        "rejected": sum(not one["holds"]["mujoco"] for one in results),
        "verdicts differ": sum(len({*one["holds"].values()}) > 1 for one in results),
        "findings differ": sum(any(one["alone"].values()) for one in results),
        **{
            f"{engine}_cpu_s": float(np.median([one[engine] for one in seconds])) if seconds else math.nan
            for engine in ENGINES
        },
    }


if __name__ == "__main__":
    main(tyro.cli(Options))
