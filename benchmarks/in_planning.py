"""The collision checks that planning really asks for: recorded while a problem is solved, then timed again.

python -m benchmarks.in_planning four_objects eight_objects
python -m benchmarks.in_planning --robots ur5 xarm7 pr2         # each one's version of four_objects
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import tyro

from benchmarks.common import record, table
from benchmarks.robots import FOUR_OBJECTS
from tamp import load_problem, solve
from tamp.geometric.collision.arrangement import Arrangement

REPEATS = 15
"""Each recorded check is timed so often; the fastest pass counts."""


@dataclass(frozen=True)
class Options:
    """What to run."""

    problems: tyro.conf.Positional[tuple[str, ...]] = ("four_objects", "eight_objects", "cluttered", "shelves")
    """Shipped problems' names or paths."""
    robots: tuple[str, ...] = ()
    """Shipped robots, each with its version of four_objects, instead of problems."""
    seed: int = 0
    """Of the solve."""
    out: str = "in_planning.jsonl"
    """The file under benchmarks/results."""


Check = tuple[Arrangement, tuple[Any, ...]]


@contextmanager
def recorded(name: str, checks: list[Check]) -> Iterator[None]:
    """Keep every call of one of Arrangement's methods."""
    method: Callable[..., bool] = getattr(Arrangement, name)

    def keep(self: Arrangement, *confs: Any) -> bool:
        checks.append((self, confs))
        return method(self, *confs)

    setattr(Arrangement, name, keep)
    try:
        yield
    finally:
        setattr(Arrangement, name, method)


def microseconds(name: str, checks: list[Check]) -> float:
    """Mean CPU time of a recorded check, the call from Python included."""
    method: Callable[..., bool] = getattr(Arrangement, name)
    best = float("inf")
    for _ in range(REPEATS):
        started = time.process_time()
        for arrangement, confs in checks:
            method(arrangement, *confs)
        best = min(best, time.process_time() - started)
    return 1e6 * best / len(checks)


def main(options: Options) -> None:
    """Record, time, print."""
    rows: list[dict[str, Any]] = []
    asked_of = [(robot, FOUR_OBJECTS[robot]) for robot in options.robots]
    for robot, problem in asked_of or [(None, problem) for problem in options.problems]:
        states: list[Check] = []
        edges: list[Check] = []
        with recorded("free", states), recorded("edge_free", edges):
            solve(load_problem(problem, robot=robot), seed=options.seed)
        arrangements = {id(arrangement): arrangement for arrangement, _ in (*states, *edges)}.values()
        asked = sum(arrangement.stats.edges for arrangement in arrangements)
        decided = sum(arrangement.stats.edges_decided for arrangement in arrangements)
        row = {
            "states": len(states),
            "us a state": round(microseconds("free", states), 2),
            "edges": len(edges),
            "us an edge": round(microseconds("edge_free", edges), 1),
            "edges decided compiled": round(decided / asked, 4),
        }
        rows.append({"problem": problem, "robot": robot or "its own", **row})
        record(options.out, seed=options.seed, config={"problem": problem, "robot": robot}, **row)
    table(rows, "collision checks as planning asks for them")


if __name__ == "__main__":
    main(tyro.cli(Options))
