"""What the benchmark scripts share: one JSON line a measurement, a table, honest summaries."""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "benchmarks" / "results"


def without_options(description: str | None) -> None:
    """Parse the command line of a script that takes nothing: --help says what it does, before it is done."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args()


def record(
    file: str | Path, *, seed: int | None = None, config: Mapping[str, Any] | None = None, **fields: Any
) -> Path:
    """Append one measurement as a JSON line that says where it comes from.

    Args:
        file: A name under benchmarks/results, or an absolute path.
        seed: The seed that repeats it.
        config: What was varied: problem, sampler, budget in seconds.
        fields: What was measured; the name says the unit (planning_s, check_us). Not finite becomes null.

    Returns:
        The file that was appended to.
    """
    path = RESULTS / file
    path.parent.mkdir(parents=True, exist_ok=True)
    line = {"seed": seed, "config": dict(config or {}), **fields, **_origin(), "load": round(os.getloadavg()[0], 2)}
    with path.open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(_plain(line), allow_nan=False) + "\n")
    return path


def read(file: str | Path) -> list[dict[str, Any]]:
    """All measurements of a file under benchmarks/results, oldest first."""
    return [json.loads(line) for line in (RESULTS / file).read_text(encoding="utf-8").splitlines()]


def table(rows: Sequence[Mapping[str, Any]], title: str = "") -> None:
    """Print measurements, one a row; the first row's keys are the columns."""
    grid = Table(title=title or None, title_justify="left")
    for column in rows[0] if rows else ():
        grid.add_column(column, justify="left" if isinstance(rows[0][column], str) else "right")
    for row in rows:
        grid.add_row(*(_cell(row[column]) for column in rows[0]))
    Console(width=None if os.isatty(1) else 160).print(grid)


def percentile(values: Iterable[float], q: float) -> float:
    """The q-th percentile, 0 to 100, linear between the two nearest; NaN of nothing."""
    numbers = np.fromiter(values, dtype=np.float64)
    return float(np.percentile(numbers, q)) if numbers.size else math.nan


def wilson(successes: int, trials: int, z: float = 1.96) -> tuple[float, float]:
    """Wilson's score interval of a success rate, 95 % by default; (0, 1) when nothing was tried.

    Source: E. B. Wilson, Journal of the American Statistical Association 22 (1927), 209-212.
    """
    if trials == 0:
        return 0.0, 1.0
    rate = successes / trials
    centre = rate + z * z / (2 * trials)
    spread = z * math.sqrt(rate * (1 - rate) / trials + z * z / (4 * trials * trials))
    scale = 1 + z * z / trials
    return max(0.0, (centre - spread) / scale), min(1.0, (centre + spread) / scale)


def times(seconds: Sequence[float], unit: str = "s") -> dict[str, str]:
    """Median, mean, 95th percentile and maximum of durations, as cells of a table in s, ms or us."""
    scale = {"s": 1.0, "ms": 1e3, "us": 1e6}[unit]
    summary = {
        "median": percentile(seconds, 50),
        "mean": float(np.mean(seconds)) if seconds else math.nan,
        "p95": percentile(seconds, 95),
        "max": max(seconds, default=math.nan),
    }
    return {f"{name} [{unit}]": f"{scale * value:.3g}" for name, value in summary.items()}


@cache
def _origin() -> dict[str, Any]:
    """Commit, machine and versions: what a figure is worth nothing without."""
    git = ["git", "-C", str(ROOT)]
    commit = subprocess.run([*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False)
    dirty = subprocess.run([*git, "status", "--porcelain", "-uno"], capture_output=True, text=True, check=False)
    return {
        "commit": (commit.stdout.strip() or "unknown") + ("+changes" if dirty.stdout.strip() else ""),
        "machine": {"cpu": _cpu(), "cores": os.cpu_count()},
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def _cpu() -> str:
    for line in (
        Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines() if Path("/proc/cpuinfo").exists() else ()
    ):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def _plain(value: Any) -> Any:
    """Numpy's numbers and arrays as JSON knows them."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(inner) for inner in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _cell(value: Any) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"
