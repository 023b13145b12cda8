"""Plans judged and carried out in physics: how often the goal is reached, by kind of grasp, and after a disturbance.

python -m benchmarks.execution four_objects shelves eight_objects --seeds 20 --grasps constraint friction
python -m benchmarks.execution four_objects --seeds 10 --grasps friction --disturb object-moved grasp-slips
python -m benchmarks.execution set_table stack_learned pack_learned stack pack tray --seeds 20 --grasps friction
"""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Any

import tyro

from benchmarks.common import record, table, times, wilson


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        problems: Shipped problems' names or paths.
        seeds: Seeds first, first + 1, ... of each problem: of the plan, the disturbance and planning anew.
        first: The first seed.
        grasps: friction, constraint.
        disturb: Disturbances; with one the plan is mended (--replan), and without any it is not.
        replan: Mend the plan without a disturbance as well.
        engines: Names of physics engines.
        time: Budget of planning, seconds on the clock; what it took of the processor is recorded.
        jobs: Runs at a time.
        out: The name of the file under benchmarks/results.
    """

    problems: tyro.conf.Positional[tuple[str, ...]] = ("four_objects", "shelves", "eight_objects")
    seeds: int = 10
    first: int = 0
    grasps: tuple[str, ...] = ("constraint", "friction")
    disturb: tuple[str, ...] = ()
    replan: bool = False
    engines: tuple[str, ...] = ("pybullet",)
    time: float = 30.0
    jobs: Annotated[int, tyro.conf.arg(aliases=["-j"])] = 1
    out: str = "execution.jsonl"


def run(
    name: str, seed: int, grasp: str, disturb: str | None, engine: str, options: Options, robot: str | None = None
) -> dict[str, Any]:
    """Plan once, have the plan judged, and carry it out once. Times in seconds."""
    import tamp
    from tamp.commands.solve import registry
    from tamp.execution.command import Options as Chosen
    from tamp.execution.command import carry_out
    from tamp.plan.write import plan_document
    from tamp.verification.verify import verify

    problem, began = tamp.load_problem(name, registry=registry(), robot=robot), time.process_time()
    solution = tamp.solve(problem, max_time=options.time, seed=seed)
    cpu = time.process_time() - began
    if not solution.solved:
        return {"outcome": "no plan", "planning_cpu_s": cpu, "explanation": list(solution.explanation)}

    judged = verify(plan_document(solution), classifiers=problem.classifiers)
    with tempfile.TemporaryDirectory() as folder:
        file = tamp.write_plan(solution, Path(folder) / "plan.json")
        mends = disturb is not None or options.replan
        chosen = Chosen(grasp, mends, disturb, seed, options.time, engine=engine)
        done = carry_out(file, chosen, registry())
    return {
        "outcome": "reached" if done.reached else "explained" if done.explanation else "not reached",
        "explanation": [*done.explanation, *(f"{part.fact}: {part.why}" for part in done.goal if not part.holds)],
        "planning_cpu_s": cpu,
        "verified": judged.holds and judged.checked,
        "verdict": judged.text(),
        "disturbance": done.disturbance,
        "kinds": done.kinds,
        "touches": Counter(f"{one.first} - {one.second}" for action in done.actions for one in action.touches),
        "replans": done.replans,
        "kept": done.kept,
        "actions": len(done.actions),
        "base_lag_m": max(action.base for action in done.actions),
        "arm_lag_rad": max(action.arm for action in done.actions),
        "simulated_s": done.simulated,
        "wall_s": done.seconds,
    }


def main(options: Options) -> None:
    rows: list[dict[str, Any]] = []
    seeds = range(options.first, options.first + options.seeds)
    cases = [(name, grasp, what, engine) for name in options.problems for grasp in options.grasps
             for what in options.disturb or (None,) for engine in options.engines]  # fmt: skip
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for name, grasp, what, engine in cases:
            began = time.monotonic()
            futures = [pool.submit(run, name, seed, grasp, what, engine, options) for seed in seeds]
            results = []
            for seed, future in zip(seeds, futures, strict=True):
                result = future.result()
                results.append(result)
                config = {
                    "problem": name, "grasp": grasp, "disturb": what, "replan": options.replan, "engine": engine,
                }  # fmt: skip
                record(options.out, seed=seed, config=config, **result)
                verdict = "" if result.get("verified", True) else result["verdict"]
                if verdict or result["outcome"] != "reached":
                    story = [result.get("disturbance"), *result["explanation"], result.get("kinds"), verdict]
                    said = "; ".join(str(one) for one in story if one)
                    print(f"  {name} {grasp} {engine} seed {seed} {result['outcome']}: {said}")
            rows.append(_row(name, grasp, what, engine, results))
            print(f"{name} {grasp} {what or ''} {engine}: {time.monotonic() - began:.0f} s", flush=True)
    table(rows, "carried out in physics")


def _row(name: str, grasp: str, what: str | None, engine: str, results: list[dict[str, Any]]) -> dict[str, Any]:
    counts = Counter(result["outcome"] for result in results)
    low, high = wilson(counts["reached"], len(results))
    kinds = sum((Counter(result.get("kinds", {})) for result in results), Counter())
    return {
        "problem": Path(name).stem,
        "grasp": grasp,
        "engine": engine,
        "disturbance": what or "",
        "verified": sum(result.get("verified", False) for result in results),
        "planning CPU, max [s]": f"{max(result['planning_cpu_s'] for result in results):.3g}",
        "reached": f"{counts['reached']} of {len(results)}",
        "95 %": f"{100 * low:.0f}-{100 * high:.0f}",
        "explained": counts["explained"],
        "replans": sum(result.get("replans", 0) for result in results),
        "kept": sum(result.get("kept", 0) for result in results),
        "deviations": ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())),
        **times([result["wall_s"] for result in results if "wall_s" in result]),
    }


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
