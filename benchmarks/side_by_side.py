"""Classical planning beside Fast Downward (lama-first) and pyperplan: CPU time and cost, in pairs, one after the other.

    python -m benchmarks.side_by_side [TASK ...] --repeats 5
    python -m benchmarks.side_by_side --folder TASKS --peers VENV      # NAME.domain.pddl with NAME.problem.pddl
    python -m benchmarks.side_by_side --optimal                        # A* with landmark cuts on both sides

The peers come from pinned wheels, into an environment of their own that is made where it is missing. Our time is that
of reading, instantiating and searching, in a process whose kernels are loaded; of a peer's process the CPU time of its
smallest task is taken off: start-up counts on neither side. Ratios are medians of pairs; a run without a plan takes
for ever and costs infinitely much, whichever side it is on, and pairs in which neither has one are left out.
"""

from __future__ import annotations

import json
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from statistics import median

import tyro

from benchmarks.classical_domains import GENERATORS
from benchmarks.common import record, table
from benchmarks.pddl_task import Task, problem

PINS = ("up-fast-downward==1.0.0", "pyperplan==2.1")

SIZES = {
    "blocks": 40, "logistics": 40, "depot": 10, "gripper": 50, "satellite": 20, "rovers": 20, "miconic": 40,
    "conditions": 300,
}  # fmt: skip
"""Tasks that are made, and their sizes; the least of gripper tells what a peer's start-up takes."""

OPTIMAL_SIZES = {"depot": 6, "rovers": 5, "blocks": 12, "logistics": 7, "gripper": 8, "satellite": 8}
"""Those that are solved optimally; the first three take Fast Downward seconds, the fourth one."""

OURS = """
import json, sys, time
from tamp.planner.pddl_only.problem import load_symbolic
from tamp.planner.pddl_only.solve import solve_symbolic
from tamp.symbolic.search.heuristics.loops import selection as kernels
from tamp.symbolic.search.packed import compiled
seconds, seed, search, *names = sys.argv[1:]
kernels.load()
rows = []
for domain, problem in [names[:2], names[2:]]:
    began = time.process_time()
    found = solve_symbolic(load_symbolic(domain, problem), search=search, max_time=float(seconds))
    rows.append({"cpu_s": time.process_time() - began, "cost": found.cost if found.solved else None,
                 "expanded": found.expanded})
print(json.dumps(rows[1]))
"""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        tasks: Some of those that are made, or of the folder's; all by default.
        folder: Tasks of one's own, instead of those that are made.
        peers: The environment with the peers.
        pyperplan: Run pyperplan (FF, greedy) as well; it takes its time.
        first: The seed of the tasks that are made.
        repeats: Pairs of each task.
        seconds: Budget of one run.
        optimal: Plans of the least cost: A* with landmark cuts, ours and Fast Downward's.
    """

    tasks: tyro.conf.Positional[tuple[str, ...]] = ()
    folder: Path | None = None
    peers: Path = field(default_factory=lambda: Path(tempfile.gettempdir()) / "tamp-peers")
    pyperplan: bool = False
    first: int = 0
    repeats: int = 3
    seconds: float = 60.0
    optimal: bool = False


def conditions(size: int) -> Task:
    """One action asks for `size` facts, each of which takes an action of its own."""
    names = [f"s{i}" for i in range(size)]
    needs = " ".join(f"(up {name})" for name in names)
    domain = f"""(define (domain conditions) (:predicates (switch ?s) (up ?s) (done)) (:constants {" ".join(names)})
      (:action flip :parameters (?s) :precondition (switch ?s) :effect (up ?s))
      (:action end :parameters () :precondition (and {needs}) :effect (done)))"""
    return domain, problem("conditions", "", [f"(switch {name})" for name in names], ["(done)"])


def made(folder: Path, name: str, size: int, seed: int = 0) -> Path:
    """Write a task into the folder; return its path without the endings."""
    domain, task = conditions(size) if name == "conditions" else GENERATORS[name](size, Random(seed))
    path = folder / (f"{name}-{size}" if seed == 0 else f"{name}-{size}-{seed}")
    Path(f"{path}.domain.pddl").write_text(domain, encoding="utf-8")
    Path(f"{path}.problem.pddl").write_text(task, encoding="utf-8")
    return path


def files(path: Path) -> list[str]:
    """The two files of a task."""
    return [f"{path}.{kind}.pddl" for kind in ("domain", "problem")]


def spent(words: list[str], seconds: float, folder: str) -> tuple[float, str]:
    """Run a command in a folder; return the CPU time of it and its children, and what it said."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, timeout=10 * seconds)
        said = done.stdout + done.stderr
    except subprocess.TimeoutExpired:
        said = ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, said


def lama(options: Options, path: Path) -> dict[str, object]:
    """Run Fast Downward's lama-first, or its A* with landmark cuts; the cost is that of its plan."""
    script = next(options.peers.glob("lib/python*/site-packages/up_fast_downward/downward/fast-downward.py"))
    limit = f"{int(options.seconds)}s"
    words = [str(options.peers / "bin" / "python"), str(script), "--overall-time-limit", limit]
    words += (
        [*files(path), "--search", "astar(lmcut())"] if options.optimal else ["--alias", "lama-first", *files(path)]
    )
    with tempfile.TemporaryDirectory() as folder:
        seconds, said = spent(words, options.seconds, folder)
    return {"cpu_s": seconds, "cost": number("Plan cost", said), "expanded": number("Expanded", said)}


def pyperplan(options: Options, path: Path) -> dict[str, object]:
    """Run pyperplan's greedy search with FF; actions cost one."""
    words = [str(options.peers / "bin" / "pyperplan"), "-H", "hff", "-s", "gbf", *files(path)]
    with tempfile.TemporaryDirectory() as folder:
        seconds, said = spent(words, options.seconds, folder)
    return {
        "cpu_s": seconds,
        "cost": number("Plan length", said),
        "expanded": number("Nodes expanded|nodes expanded", said),
    }


def number(word: str, said: str) -> float | None:
    """The first number after a word in what a planner printed; None without it."""
    found = re.search(rf"(?:{word})\D*?(\d+)", said)
    return float(found.group(1)) if found else None


def ours(options: Options, path: Path, least: Path) -> dict[str, object]:
    """Plan in a process that has planned the least task before."""
    search = "astar" if options.optimal else "greedy"
    words = [sys.executable, "-c", OURS, str(options.seconds), "0", search, *files(least), *files(path)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(words, capture_output=True, text=True, check=True, env=environment)
    return json.loads(done.stdout.splitlines()[-1])


def install(peers: Path) -> None:
    """Make the environment with the peers, where it is missing."""
    if not (peers / "bin" / "pyperplan").exists():
        subprocess.run([sys.executable, "-m", "venv", str(peers)], check=True)
        subprocess.run([str(peers / "bin" / "pip"), "install", "-q", *PINS], check=True)


def spent_of(row: dict[str, object]) -> float:
    """The CPU seconds of a run without its start-up; infinite without a plan."""
    if row["cost"] is None:
        return math.inf
    return max(0.005, float(str(row["cpu_s"])) - float(str(row.get("start_s", 0.0))))


def cost_of(row: dict[str, object]) -> float:
    """The cost of a run's plan; infinite without one."""
    return math.inf if row["cost"] is None else float(str(row["cost"]))


def ratio(ours: list[float], theirs: list[float]) -> float:
    """The median ratio of the pairs of which a side has a plan; not a number where there are none."""
    pairs = [(a, b) for a, b in zip(ours, theirs, strict=True) if min(a, b) < math.inf]
    return median(math.inf if a == math.inf else a / b if b else 1.0 for a, b in pairs) if pairs else math.nan


def compared(options: Options, path: Path, least: Path) -> dict[str, object]:
    """Run the pairs of a task: the row of the table."""
    peers = {"lmcut" if options.optimal else "lama": lama, **({"pyperplan": pyperplan} if options.pyperplan else {})}
    mine = "ours, optimal" if options.optimal else "ours"
    rows: dict[str, list[dict[str, object]]] = {"ours": [], **{name: [] for name in peers}}
    for turn in range(options.repeats):
        runs = {"ours": lambda: ours(options, path, least)}
        for name, run in peers.items():
            runs[name] = lambda run=run: {"start_s": run(options, least)["cpu_s"], **run(options, path)}
        for name in sorted(runs, reverse=bool(turn % 2)):
            rows[name].append(runs[name]())
            config = {
                "task": path.name,
                "planner": mine if name == "ours" else name,
                "time_s": options.seconds,
                "pins": PINS,
            }
            record("side_by_side.jsonl", seed=0, config=config, turn=turn, **rows[name][-1])

    spent_here = [spent_of(row) for row in rows["ours"]]
    cost = cost_of(rows["ours"][0])
    line: dict[str, object] = {"task": path.name, "ours [s]": median(spent_here), "cost": cost}
    for name in peers:
        theirs = [spent_of(row) for row in rows[name]]
        dear = cost_of(rows[name][0])
        line |= {
            f"{name} [s]": median(theirs),
            f"{name} cost": dear,
            f"{name} ratio": ratio(spent_here, theirs),
            f"{name} cost ratio": ratio([cost], [dear]),
        }
    return line


def main(options: Options) -> None:
    """Run all, print the table."""
    install(options.peers)
    with tempfile.TemporaryDirectory() as folder:
        least = made(Path(folder), "gripper", 1)
        if options.folder is None:
            sizes = OPTIMAL_SIZES if options.optimal else SIZES
            paths = [made(Path(folder), name, sizes[name], options.first) for name in options.tasks or sizes]
        else:
            ending = ".problem.pddl"
            found = sorted(path for path in options.folder.glob(f"*{ending}"))
            paths = [path.with_name(path.name.removesuffix(ending)) for path in found]
            paths = [path for path in paths if not options.tasks or path.name in options.tasks]
        lines = [compared(options, path, least) for path in paths]
    table(lines, "Side by side: CPU seconds without start-up, medians; ratios of pairs")
    peer = "lmcut" if options.optimal else "lama"
    ratios = [float(str(line[f"{peer} ratio"])) for line in lines]
    costs = [cost for line in lines if (cost := float(str(line[f"{peer} cost ratio"]))) == cost]
    time = f"time {median(ratios):.2f} (most {max(ratios):.2f})"
    print(f"against Fast Downward's {peer}: {time}, cost {median(costs or [0]):.2f}")


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
