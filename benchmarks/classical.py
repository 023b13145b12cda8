"""Classical planning: generated tasks of eight domains, solved greedily and optimally, timed.

    python -m benchmarks.classical [DOMAIN ...] [--time SECONDS] [--seeds N]
    python -m benchmarks.classical depot --size 15 --search greedy --seeds 20 --cpu

Every plan is replayed before it counts. On a busy machine --cpu counts CPU seconds, in the limit as well.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from random import Random

from benchmarks import common
from benchmarks.classical_domains import GENERATORS
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.plan_trace import trace
from tamp.symbolic.search.search import search
from tamp.system.deadline import Deadline

SIZES = {
    "blocks": (6, 12, 30), "logistics": (4, 8, 20), "gripper": (4, 8, 30), "rovers": (2, 4, 10),
    "satellite": (3, 6, 12), "depot": (3, 6, 10), "miconic": (4, 8, 20), "network": (5, 10, 20),
}  # fmt: skip
"""Small, medium and large: A* is asked about the first two."""

METHODS = {"greedy": "ff+landmarks", "astar": "lmcut"}


def measure(
    name: str, size: int, seed: int, method: str, seconds: float, clock: Callable[[], float]
) -> dict[str, object]:
    """Solve one task; the row says how it ended, its cost, the time of each part and the nodes per second."""
    domain, problem = GENERATORS[name](size, Random(seed))
    task = parse_task(problem, parse_domain(domain))
    started = clock()
    instantiated = instantiate(task)
    ready = clock()
    result = search(instantiated, search=method, heuristic=METHODS[method], deadline=Deadline(seconds), seed=seed)
    spent = clock() - ready
    if result.plan is not None:
        trace(instantiated, result.plan.operators)
    return {
        "outcome": "solved" if result.plan else "" if result.reason is None else result.reason.name.lower(),
        "operators": len(instantiated.operators),
        "cost": result.plan.cost if result.plan else float("nan"),
        "instantiate_s": ready - started,
        "search_s": spent,
        "expanded": result.expanded,
        "evaluated_per_s": result.evaluated / max(spent, 1e-9),
    }


def main() -> None:
    """Run the tasks that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("domains", nargs="*", choices=[*GENERATORS, []], help="all by default")
    parser.add_argument("--time", type=float, default=20.0, help="seconds for each search")
    parser.add_argument("--seeds", type=int, default=1, help="tasks of each size")
    parser.add_argument("--size", type=int, default=None, help="one size instead of those of each domain")
    parser.add_argument("--search", choices=METHODS, default=None, help="both by default")
    parser.add_argument("--cpu", action="store_true", help="these are seconds of CPU time")
    arguments = parser.parse_args()
    clock = time.process_time if arguments.cpu else time.perf_counter
    if arguments.cpu:
        time.monotonic = time.process_time  # the clock of deadlines
    rows: list[dict[str, object]] = []
    for name in arguments.domains or GENERATORS:
        for size in SIZES[name] if arguments.size is None else (arguments.size,):
            for seed in range(arguments.seeds):
                for method in METHODS if arguments.search is None else (arguments.search,):
                    if method == "astar" and size == SIZES[name][-1]:
                        continue
                    row = measure(name, size, seed, method, arguments.time, clock)
                    config = {"domain": name, "size": size, "search": method, "time_s": arguments.time}
                    config |= {"clock": "cpu"} if arguments.cpu else {}
                    common.record("classical.jsonl", seed=seed, config=config, **row)
                    rows.append({"domain": name, "size": size, "seed": seed, "search": method, **row})
    common.table(rows, "Classical tasks")


if __name__ == "__main__":
    main()
