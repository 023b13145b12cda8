"""How long a user waits for the first plan: `tamp-solve one_object` as a whole process, kernels compiled before.

python -m benchmarks.cold_start --runs 10
python -m benchmarks.cold_start --fresh
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import tyro

from benchmarks.common import record, table, times

COMMAND = ("-c", "from tamp.commands.solve import main; main()")


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        problem: A shipped problem's name, or a path.
        runs: Timed runs after one that is not timed.
        seed: Of every run.
        top: Packages to list.
        fresh: Measure what the very first run costs: kernels compiled into an empty folder, against all compiled.
    """

    problem: str = "one_object"
    runs: int = 5
    seed: int = 0
    top: int = 12
    fresh: bool = False


def start(options: Options, folder: Path, *flags: str, kernels: Path | None = None) -> tuple[float, str]:
    """One whole process: seconds, and its standard error; `kernels`: where it keeps them."""
    command = [sys.executable, *flags, *COMMAND, options.problem, "--seed", str(options.seed), "--quiet"]
    environment = os.environ if kernels is None else {**os.environ, "NUMBA_CACHE_DIR": str(kernels)}
    began = time.perf_counter()
    run = subprocess.run(
        [*command, "--out", str(folder / "plan.json")],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    seconds = time.perf_counter() - began
    if run.returncode != 0:
        raise SystemExit(f"exit {run.returncode}: {run.stdout}{run.stderr}")
    return seconds, run.stderr


def import_times(log: str) -> Counter[str]:
    """Seconds by top-level package, without what it imports itself, from `python -X importtime`'s log."""
    spent: Counter[str] = Counter()
    for line in log.splitlines():
        own, _, rest = line.removeprefix("import time:").partition("|")
        if line.startswith("import time:") and own.strip().isdigit():
            spent[rest.partition("|")[2].strip().partition(".")[0]] += int(own)
    return Counter({package: microseconds * 1e-6 for package, microseconds in spent.items()})


def spent() -> float:
    """Seconds of CPU that all processes have taken which were started here and have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def fresh(options: Options) -> None:
    """CPU of the first run, of the runs after it, and what compiling costs: the difference."""
    first: list[float] = []
    later: list[float] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number in range(options.runs):
            kernels = folder / f"kernels{number}"
            for cpu in (first, later):
                before = spent()
                start(options, folder, kernels=kernels)
                cpu.append(spent() - before)
    compiling = [one - other for one, other in zip(first, later, strict=True)]
    config = {"problem": options.problem, "fresh": True}
    record("cold_start.jsonl", seed=options.seed, config=config, first_cpu_s=first, later_cpu_s=later)
    rows = {"first run": first, "later runs": later, "compiling": compiling}
    table([{"CPU": name, **times(cpu)} for name, cpu in rows.items()], f"{options.problem} in a fresh environment")


def main(options: Options) -> None:
    if options.fresh:
        fresh(options)
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        start(options, folder)
        seconds = [start(options, folder)[0] for _ in range(options.runs)]
        packages = import_times(start(options, folder, "-X", "importtime")[1]).most_common(options.top)
    config = {"problem": options.problem}
    record("cold_start.jsonl", seed=options.seed, config=config, process_s=seconds, import_s=dict(packages))
    table([{"problem": options.problem, "runs": options.runs, **times(seconds)}], "cold tamp-solve, whole process")
    table([{"package": package, "own import [ms]": 1e3 * spent} for package, spent in packages])


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
