"""Where bodies end in physics when a plan is carried out: random scenes, three placements each, held by friction alone.

python -m benchmarks.placements --scenes 60
python -m benchmarks.placements --first 7 --scenes 1 --keep /tmp/scenes -v      # one of them again, its files kept
"""

from __future__ import annotations

import math
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro

from benchmarks.common import record, table, wilson
from benchmarks.random_scenes import ROOM, Place, furniture, objects

FAR = 0.01
"""A placement that ends farther from the plan's pose than this is counted, metres."""

THINGS = 3
"""Bodies of a scene, each with a goal."""

LOST = ("lost", "stuck", "gone", "toppled")
"""Deviations after which a body is not where anybody wanted it."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        scenes: How many scenes with a plan.
        first: The first scene's seed.
        time: Budget of planning, seconds.
        keep: A folder for the scenes and plans; a temporary one when not given.
        verbose: Print what came of each placement.
        out: The name of the file under benchmarks/results.
    """

    scenes: int = 60
    first: int = 0
    time: float = 60.0
    keep: Path | None = None
    verbose: Annotated[bool, tyro.conf.arg(aliases=["-v"])] = False
    out: str = "placements.jsonl"


def scene(seed: int) -> str | None:
    """A problem file's text: furniture, three things and where each is to go; None where they find no room."""
    rng = np.random.default_rng([seed, 20])
    lines: list[str] = []
    places = furniture(lines, rng)
    things: list[tuple[str, Place, float]] = []
    for _ in range(8):
        kept = list(lines)
        things = objects(lines, places, rng, True)
        if len(things) >= THINGS:
            break
        lines[:] = kept
    else:
        return None
    kept, things = [line for line in lines if not line.startswith("  thing")], things[:THINGS]
    names = {name for name, _, _ in things}
    kept += [line for line in lines if line.startswith("  thing") and line.split(":")[0].strip() in names]
    kept = [_wide(line, rng) for line in kept]
    goals: list[str] = []
    for name, place, height in things:
        others = [one for one in places if one is not place and one.height > height + 0.12 and min(one.size) > 0.2]
        if not others:
            return None
        there = others[int(rng.integers(len(others)))]
        goals.append(f"({there.relation} {name} {there.name})")
    return (
        f"# Placements {seed}.\nname: placements_{seed}\ndomain: cupboard\n"
        f"robot: {{model: panda_mobile, base: [0.0, 0.0, {rng.uniform(-3, 3):.2f}]}}\n"
        f"room: {{x: [-{ROOM}, {ROOM}], y: [-{ROOM}, {ROOM}]}}\nbodies:\n"
        + "\n".join(kept)
        + f"\ngoal: (and {' '.join(goals)})\n"
    )


def _wide(line: str, rng: np.random.Generator) -> str:
    """One box in three is long: its weight is far from most grasps."""
    if "thing" not in line or "box:" not in line or rng.random() > 1 / 3:
        return line
    length, width, height = rng.uniform(0.2, 0.4), rng.uniform(0.03, 0.07), rng.uniform(0.08, 0.3)
    head, rest = line.split("{box: [", 1)
    return f"{head}{{box: [{length:.3f}, {width:.3f}, {height:.3f}]{rest.split(']', 1)[1]}"


def run(path: Path, seed: int, options: Options) -> dict[str, Any]:
    """Plan once, carry it out once. Lengths in millimetres, times in seconds."""
    import tamp
    from tamp.commands.solve import registry
    from tamp.execution.command import Options as Chosen
    from tamp.execution.command import carry_out

    try:
        problem = tamp.load_problem(path)
    except tamp.InputError as error:
        return {"outcome": "refused", "explanation": [str(error)], "placements": []}
    began = time.process_time()
    solution = tamp.solve(problem, max_time=options.time, seed=seed)
    result: dict[str, Any] = {"outcome": solution.outcome.name, "planning_cpu_s": time.process_time() - began}
    if not solution.solved:
        return result | {"explanation": list(solution.explanation), "placements": []}
    file = tamp.write_plan(solution, path.with_suffix(".plan.json"))
    done = carry_out(file, Chosen("friction", False, None, seed, options.time), registry())
    placements: list[dict[str, Any]] = []
    slips = 0
    for action in done.actions:
        if action.name != "place":
            slips += sum(one.kind in ("slipped", "lost") for one in action.deviations)
            continue
        off = [one for one in action.deviations if one.body == action.objects[0] and one.kind != "fact"]
        moved = max((1000 * one.moved for one in off), default=0.0)
        kinds = [one.kind for one in off]
        gone = any(kind in LOST for kind in kinds)
        far = gone or moved > 1000 * FAR
        placements.append({"body": action.objects[0], "far": far, "lost": gone, "mm": moved, "kinds": kinds})
    return result | {"placements": placements, "slips": slips, "reached": done.reached, "simulated_s": done.simulated}


def main(options: Options) -> None:
    count = far = lost = scenes = unsolved = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        seed = options.first
        while scenes < options.scenes and seed < options.first + 4 * options.scenes:
            text = scene(seed)
            if text is not None:
                path = folder / f"placements_{seed}.yaml"
                path.write_text(text, encoding="utf-8")
                result = run(path, seed, options)
                record(options.out, seed=seed, config={"time_s": options.time}, **result)
                placed = result["placements"]
                scenes, unsolved = scenes + bool(placed), unsolved + (not placed)
                count += len(placed)
                far += sum(one["far"] for one in placed)
                lost += sum(one["lost"] for one in placed)
                said = [f"{one['body']} {one['mm']:.0f} mm {' '.join(one['kinds'])}" for one in placed if one["far"]]
                why = result.get("explanation", []) if not placed else said
                print(f"placements_{seed}: {result['outcome']} {len(placed)} placed; {'; '.join(why)}", flush=True)
            seed += 1
    low, high = wilson(far, count)
    table([{
        "scenes": scenes, "without plan": unsolved, "placements": count, "over 1 cm": far, "lost": lost,
        "95 %": f"{100 * low:.1f}-{100 * high:.1f} %" if count else math.nan,
    }], "placements in physics, friction grasp")  # fmt: skip


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
