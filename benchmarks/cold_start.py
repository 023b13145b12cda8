"""How long a user waits for the first plan: `tamp-solve one_object` as a whole process, kernels compiled before.

python -m benchmarks.cold_start --runs 10
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import tyro

from benchmarks.common import record, table, times

COMMAND = ("-c", "from tamp.cli import main; main()")


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        problem: A shipped problem's name, or a path.
        runs: Timed runs after one that is not timed.
        seed: Of every run.
        top: Packages to list.
    """

    problem: str = "one_object"
    runs: int = 5
    seed: int = 0
    top: int = 12


def start(options: Options, folder: Path, *flags: str) -> tuple[float, str]:
    """One whole process: seconds, and its standard error."""
    command = [sys.executable, *flags, *COMMAND, options.problem, "--seed", str(options.seed), "--quiet"]
    began = time.perf_counter()
    run = subprocess.run(
        [*command, "--out", str(folder / "plan.json")], cwd=folder, capture_output=True, text=True, check=False
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


def main(options: Options) -> None:
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
