"""Compare two checkouts side by side: the same plans, byte for byte, and planning CPU time as ratios of pairs.

    git worktree add ../before COMMIT
    python -m benchmarks.two_checkouts ../before [PROBLEM ...] --seeds 5
    python -m benchmarks.two_checkouts ../before 30 40 60 --seeds 3      # objects onto boards, see benchmarks.scale

Both sides run in this environment, in turn, each problem and seed in a process of its own that has planned once before
it is timed. Only public names are used, so that checkouts with other rooms can be compared; where the time limit is to
count CPU seconds as well (--cpu, for a busy machine) the clock of deadlines, too. What tells of a run and not of a
plan (timing, versions, paths, statistics) is left out of the comparison.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from benchmarks import common
from benchmarks.scale import MADE
from benchmarks.scale_scenes import scene

PROBLEMS = (
    "one_object", "two_objects", "four_objects", "eight_objects", "cluttered", "shelves", "blocked", "swap", "packed",
    "drawers", "twelve_objects", "twenty_objects", "pack", "tray", "stack", "parcels", "bench_one_object",
    "bench_four_objects", "two_arms_tables", "two_arms_handover", "two_arms_cupboard",
)  # fmt: skip
"""The shipped ones that have plans and need no learned relation."""

LEARNED = ("set_table", "stack_learned", "pack_learned")
"""Shipped ones with learned relations, which the registry of `grounding` brings."""

OF_THE_RUN = ("timing", "inputs", "versions", "statistics", "effort", "options")
"""Entries of a plan file that differ between two runs that made the same plan."""

RUN = """
import json, resource, sys, time
import tamp
from pathlib import Path
name, seed, limit, out = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), Path(sys.argv[4])
tamp.solve(tamp.load_problem("one_object"), max_time=limit, seed=0)  # loads kernels
if sys.argv[5] == "cpu":
    import tamp.system.deadline
    tamp.system.deadline.counted = time.process_time
registry = {}
if name in sys.argv[6].split():
    from grounding.registry import GROUNDINGS
    registry = {"registry": GROUNDINGS}
problem = tamp.load_problem(name, **registry)
began = time.process_time()
solution = tamp.solve(problem, max_time=limit, seed=seed)
spent = time.process_time() - began
if solution.solved:
    tamp.write_plan(solution, out)
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps({"cpu_s": spent, "peak_mb": peak, "outcome": solution.outcome.name, "package": tamp.__file__}))
"""


def run(checkout: Path, problem: str, seed: int, seconds: float, clock: str = "wall") -> dict[str, object]:
    """Plan once in a checkout; the row says how it ended, the CPU seconds, the peak of memory and the plan's hash."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "plan.json"
        if problem in MADE:
            made = Path(folder) / f"scale_{problem}.yaml"
            made.write_text(scene(int(problem), MADE[problem]), encoding="utf-8")
            problem = str(made)
        words = [sys.executable, "-c", RUN, problem, str(seed), str(seconds), str(out), clock, " ".join(LEARNED)]
        environment = {**os.environ, "PYTHONPATH": str(checkout)}
        done = subprocess.run(words, cwd=checkout, env=environment, capture_output=True, text=True, check=True)
        row = json.loads(done.stdout.splitlines()[-1])
        if Path(row.pop("package")).resolve().parent.parent != checkout.resolve():
            raise SystemExit(f"{checkout} is not what was imported")

        row["plan"] = plan_hash(out) if out.is_file() else None
    return row


def shipped_in(other: Path) -> list[str]:
    """Return the shipped problems to compare, less those that the other checkout does not have, which are named."""
    every = (*PROBLEMS, *LEARNED)
    newer = [name for name in every if not (other / "problems" / f"{name}.yaml").is_file()]
    if newer:
        print(f"Not in {other}:", *newer, flush=True)
    return [name for name in every if name not in newer]


def plan_hash(file: Path) -> str:
    """Hash what a plan file says of the plan."""
    document = json.loads(file.read_text(encoding="utf-8"))
    for key in OF_THE_RUN:
        document.pop(key, None)
    return hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()


def main() -> None:
    """Run the pairs that the command line asks for, print the table, exit with 1 where plans differ."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("other", type=Path, help="the other checkout")
    parser.add_argument("problems", nargs="*", help="all shipped ones that are solvable by default")
    parser.add_argument("--seeds", type=int, default=5, help="seeds 0, 1, ... of each problem")
    parser.add_argument("--first", type=int, default=0, help="the first of them")
    parser.add_argument("--time", type=float, default=60.0, help="seconds for each run")
    parser.add_argument("--cpu", action="store_true", help="these are seconds of CPU time")
    arguments = parser.parse_args()

    clock = "cpu" if arguments.cpu else "wall"
    here, rows, ratios = Path(__file__).resolve().parent.parent, [], []
    for problem in arguments.problems or shipped_in(arguments.other):
        pairs = []
        for seed in range(arguments.first, arguments.first + arguments.seeds):
            sides = (here, arguments.other) if seed % 2 == 0 else (arguments.other, here)
            found = {side: run(side, problem, seed, arguments.time, clock) for side in sides}
            pairs.append((found[here], found[arguments.other]))
            print(problem, seed, *pairs[-1], flush=True)

        ratio = [ours["cpu_s"] / theirs["cpu_s"] for ours, theirs in pairs]
        ratios += ratio
        equal = sum(ours["plan"] == theirs["plan"] for ours, theirs in pairs)
        row = {"problem": problem, "equal plans": f"{equal} of {len(pairs)}", "CPU ratio, median": median(ratio)}
        for side, number in (("here", 0), ("there", 1)):
            ends = [pair[number] for pair in pairs]
            row[f"solved {side}"] = sum(end["outcome"] == "SOLVED" for end in ends)
            row[f"CPU {side} [s]"] = median(end["cpu_s"] for end in ends)
            row[f"peak {side} [MB]"] = max(end["peak_mb"] for end in ends)
        rows.append(row)
        config = {"problem": problem, "other": commit(arguments.other), "time_s": arguments.time, "clock": clock}
        common.record(
            "two_checkouts.jsonl", seed=arguments.seeds, config=config, equal=equal, pairs=len(pairs), ratios=ratio,
            first=arguments.first, runs=pairs,
        )  # fmt: skip
    common.table(rows, f"This checkout against {arguments.other}; CPU ratio of all pairs, median: {median(ratios):.3f}")
    sys.exit(any(row["equal plans"].split(" of ")[0] != row["equal plans"].split(" of ")[1] for row in rows))


def commit(checkout: Path) -> str:
    """Return the commit that a checkout is at."""
    words = ["git", "-C", str(checkout), "rev-parse", "--short", "HEAD"]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()


if __name__ == "__main__":
    main()
