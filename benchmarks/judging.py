"""The judge beside another checkout's: the same reports, word for word, and CPU time as ratios of pairs.

    git worktree add ../before COMMIT
    python -m benchmarks.judging ../before one_object four_objects 30 --seeds 2 --spoilt 5

Plans are made here, with spoilt copies (benchmarks/engine_verdicts.py says how), and judged by both, in turn, in a
process of its own for each that has judged one plan before. A number names a scene of so many objects
(benchmarks/scale.py). What tells of a run, its seconds, is left out of the comparison; figures are compared to 1e-6.
"""

from __future__ import annotations

import copy
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import tyro

from benchmarks.common import record, table
from benchmarks.engine_verdicts import SPOIL
from benchmarks.scale import MADE
from benchmarks.scale_scenes import scene
from benchmarks.two_checkouts import commit

HERE = Path(__file__).resolve().parent.parent

JUDGE = """
import json, sys, time
import tamp
from tamp.verification.verify import verify
engine, files = sys.argv[1], sys.argv[2:]
verify(files[0], engine=engine)  # loads the engine
for file in files:
    began = time.process_time()
    report = verify(file, engine=engine)
    spent = time.process_time() - began
    said = {key: value for key, value in report.json().items() if key != "seconds"}
    said = json.loads(json.dumps(said), parse_float=lambda text: round(float(text), 6))
    print(json.dumps({"cpu_s": spent, "report": said, "package": tamp.__file__}))
"""


@dataclass(frozen=True)
class Options:
    """What to judge.

    Attributes:
        other: The other checkout.
        problems: Shipped problems' names, paths, or numbers of objects.
        seeds: Seeds 0, 1, ... of each problem.
        spoilt: Spoilt copies of each plan.
        engines: Those that are asked, each by itself.
        time: Budget of planning, seconds.
    """

    other: tyro.conf.Positional[Path]
    problems: tyro.conf.Positional[tuple[str, ...]] = ("one_object", "four_objects", "twelve_objects", "tray", "30")
    seeds: int = 1
    spoilt: int = 3
    engines: tuple[str, ...] = ("pybullet", "mujoco")
    time: float = 90.0


def plans(name: str, seed: int, options: Options, folder: Path) -> list[Path]:
    """Write a plan of a problem, and its spoilt copies; none where none is found in time."""
    import tamp

    problem = name
    if name in MADE:
        problem = str(folder / f"{name}.yaml")
        Path(problem).write_text(scene(int(name), MADE[name]), encoding="utf-8")
    solution = tamp.solve(tamp.load_problem(problem), max_time=options.time, seed=seed)
    if not solution.solved:
        return []
    files = [tamp.write_plan(solution, folder / f"{Path(name).stem}-{seed}.json")]
    document = json.loads(files[0].read_text(encoding="utf-8"))

    rng = np.random.default_rng([seed, len(document["actions"])])
    for number in range(options.spoilt):
        spoilt = copy.deepcopy(document)
        SPOIL[list(SPOIL)[int(rng.integers(len(SPOIL)))]](spoilt, rng)
        files.append(folder / f"{Path(name).stem}-{seed}-{number}.json")
        files[-1].write_text(json.dumps(spoilt), encoding="utf-8")
    return files


def judged(checkout: Path, engine: str, files: list[Path]) -> list[dict[str, Any]]:
    """Judge plans in a checkout: CPU seconds and report of each."""
    words = [sys.executable, "-c", JUDGE, engine, *map(str, files)]
    environment = {**os.environ, "PYTHONPATH": str(checkout)}
    done = subprocess.run(words, cwd=checkout, env=environment, capture_output=True, text=True, check=True)
    rows = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    if {Path(row["package"]).resolve().parent.parent for row in rows} != {checkout.resolve()}:
        raise SystemExit(f"{checkout} is not what was imported")
    return rows


def compared(name: str, engine: str, groups: list[list[Path]], options: Options) -> dict[str, Any]:
    """Judge the plans of a problem by both sides, in turn; say what differs; return the row of the table."""
    ours: list[dict[str, Any]] = []
    theirs: list[dict[str, Any]] = []
    for number, files in enumerate(groups):
        sides = ((HERE, ours), (options.other, theirs))
        for checkout, rows in sides if number % 2 == 0 else sides[::-1]:
            rows += judged(checkout, engine, files)

    files = [file for group in groups for file in group]
    for file, mine, other in zip(files, ours, theirs, strict=True):
        for key in mine["report"]:
            if mine["report"][key] != other["report"][key]:
                print(f"{file.stem} {engine} {key}: {mine['report'][key]} | {other['report'][key]}", flush=True)
    equal = sum(mine["report"] == other["report"] for mine, other in zip(ours, theirs, strict=True))
    same = sum(
        mine["report"]["violations"] == other["report"]["violations"] for mine, other in zip(ours, theirs, strict=True)
    )
    spent = [[row["cpu_s"] for row in rows] for rows in (ours, theirs)]
    ratios = [mine / other for mine, other in zip(*spent, strict=True)]
    record(
        "judging.jsonl", config={"problem": name, "engine": engine, "other": commit(options.other)},
        seeds=options.seeds, plans=len(files), rejected=sum(bool(one["report"]["violations"]) for one in theirs),
        same_violations=same, equal_reports=equal, cpu_s=spent[0], other_cpu_s=spent[1],
    )  # fmt: skip
    return {
        "problem": name, "engine": engine, "same violations": f"{same} of {len(files)}",
        "equal reports": f"{equal} of {len(files)}", "CPU [s]": median(spent[0]),
        "CPU there [s]": median(spent[1]), "CPU ratio, median": median(ratios),
    }  # fmt: skip


def main(options: Options) -> None:
    """Judge all, print the table, exit with 1 where violations differ."""
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.problems:
            made = [plans(name, seed, options, Path(folder)) for seed in range(options.seeds)]
            groups = [files for files in made if files]
            if groups:
                rows += [compared(name, engine, groups, options) for engine in options.engines]
                print(rows[-len(options.engines) :], flush=True)
    table(rows, f"This checkout's judge against the one of {options.other}")
    halves = [row["same violations"].split(" of ") for row in rows]
    sys.exit(any(same != all_of_them for same, all_of_them in halves))


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
