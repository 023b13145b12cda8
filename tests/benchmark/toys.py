"""Runs that take no planner: what workers do in these tests."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

from tamp.benchmark.case import Case, cases

SOLVED = {"outcome": "SOLVED", "solved": True, "verified": True}
TIMEOUT = {"outcome": "TIMEOUT", "solved": False, "verified": None}


def some(seeds: int, samplers: tuple[str, ...] = ("default",), time: float = 30.0) -> list[Case]:
    return cases(["swap"], {sampler: {} for sampler in samplers}, range(seeds), time)


def line(case: Case, planning_s: float = 1.0, **fields: Any) -> dict[str, Any]:
    return {"config": case.config, "seed": case.seed, **SOLVED, "planning_s": planning_s, **fields}


def nothing() -> None:
    pass


def refuse() -> None:
    raise SystemExit(3)


def note(case: Case, folder: Path) -> dict[str, Any]:
    """Leave a trace of every try; the first one with seed 1 has its process killed on the way, as if by the system."""
    tries = len(list(folder.glob(f"{case.seed}.*")))
    (folder / f"{case.seed}.{tries}").write_text(str(os.getpid()), encoding="utf-8")
    if case.seed == 1 and tries == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return line(case, pid=os.getpid())


def die(case: Case) -> dict[str, Any]:
    """Never come to an end with seed 0."""
    if case.seed == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return line(case)


def hang(case: Case) -> dict[str, Any]:
    """Never come to an end with seed 0, and do not die either."""
    while case.seed == 0:
        signal.pause()
    return line(case)
