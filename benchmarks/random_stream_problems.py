"""Wrong plans and missed ones among random small stream problems, against a brute force that shares no code with us.

python -m benchmarks.random_stream_problems --problems 10000       # all ways; some 15 minutes of processor time
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass
from functools import partial

import tyro

from benchmarks.common import record, table
from tests.random_streams.making import random_problem
from tests.random_streams.running import Way, compare, run_algorithm, run_anytime, run_pddlstream

BLOCK = 500
"""Problems of one line in the results."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        problems: How many.
        first: The first seed.
        seconds: Wall-clock budget of one run.
        rounds: Of improvement, where plans are improved.
        share: Every so manieth problem goes through the PDDLStream adapter; all do whose values may be equal, since
            that is what the adapter is for.
    """

    problems: int = 1000
    first: int = 0
    seconds: float = 20.0
    rounds: int = 6
    share: int = 4


def ways_of(options: Options) -> tuple[dict[str, Way], dict[str, Way]]:
    """The ways for values that differ, and for those that may be equal or go through the adapter."""
    own: dict[str, Way] = {
        name: partial(run_algorithm, name=name, seconds=options.seconds) for name in ("adaptive", "incremental")
    }
    own["anytime"] = partial(run_anytime, seconds=options.seconds, rounds=options.rounds)
    adapted: dict[str, Way] = {
        f"pddlstream {name}": partial(run_pddlstream, algorithm=name, seconds=options.seconds)
        for name in ("adaptive", "incremental")
    }
    return own, adapted


def main(options: Options) -> None:
    """Run all, print the table."""
    own, adapted = ways_of(options)
    total: dict[str, Counter[str]] = {name: Counter() for name in (*own, *adapted)}
    for start in range(options.first, options.first + options.problems, BLOCK):
        counts: dict[str, Counter[str]] = {name: Counter() for name in total}
        wrong: list[dict[str, object]] = []
        began = time.process_time()
        for seed in range(start, min(start + BLOCK, options.first + options.problems)):
            problem = random_problem(seed)
            ways = {} if problem.pooled else dict(own)
            if problem.pooled or seed % options.share == 0:
                ways |= adapted
            row = compare(problem, ways)
            for name in ways:
                count = counts[name]
                count["problems"] += 1
                count["solvable" if row["solvable"] else "unsolvable" if row["solvable"] is False else "open"] += 1
                count[row[name]] += 1
                count.update({kind: 1 for kind in ("wrong", "missed", "refuted") if name in row[kind]})
            if row["wrong"] or row["missed"] or row["refuted"]:
                wrong.append({"seed": seed, **{kind: row[kind] for kind in ("wrong", "missed", "refuted")}})
                print(f"seed {seed}: {wrong[-1]}", flush=True)
        for name, count in counts.items():
            total[name].update(count)
        record(
            "random_stream_problems.jsonl",
            seed=start,
            config={"seconds": options.seconds, "rounds": options.rounds, "share": options.share},
            counts={name: dict(count) for name, count in counts.items()},
            faults=wrong,
            cpu_s=time.process_time() - began,
        )
    columns = ("problems", "solvable", "SOLVED", "wrong", "missed", "refuted")
    table([{"way": name, **{column: count[column] for column in columns}} for name, count in total.items()])


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
