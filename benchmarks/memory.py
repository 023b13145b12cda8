"""Memory of one process over many solves: it must stay flat. Writes results/memory.jsonl.

python -m benchmarks.memory --solves 1000
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import tyro

from benchmarks import common


def resident_mb() -> float:
    """The memory of this process that is in use, in MB (Linux)."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main(solves: int = 1000, problem: str = "one_object", warm: int = 20) -> None:
    """Solve a problem again and again, each time loaded anew.

    Args:
        solves: How often.
        problem: A shipped problem.
        warm: Solves before the first measurement, while kernels and caches are filled.
    """
    import tamp

    rows: list[dict[str, object]] = []
    base = 0.0
    started = time.perf_counter()
    for number in range(warm + solves + 1):
        if number >= warm and (number - warm) % max(1, solves // 10) == 0:
            now = resident_mb()
            base = base or now
            row = {"solves": number - warm, "resident_mb": now, "growth_mb": now - base}
            common.record("memory.jsonl", config={"problem": problem}, **row)
            rows.append({**row, "seconds": time.perf_counter() - started})
        tamp.solve(tamp.load_problem(problem), max_time=30.0, seed=number)
    common.table(rows, f"Memory over {solves} solves of {problem}")


if __name__ == "__main__":
    tyro.cli(main, description=(__doc__ or "").splitlines()[0])
