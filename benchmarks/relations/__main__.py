"""Relations learned from a few demonstrations, by true geometry, on unseen bodies, heights, yaws and sizes.

python -m benchmarks.relations table --seeds 5      classifier and proposals from 5, 20, 160 labels
python -m benchmarks.relations lazy --seeds 4       20 labels at one height, one yaw, one size
python -m benchmarks.relations asking --seeds 4     accuracy by number of labels, with and without being asked
python -m benchmarks.relations told --seeds 5       20 labels at one yaw, and one more as the warnings ask for it
python -m benchmarks.relations random --seeds 5     cross-validation of labels at random
python -m benchmarks.relations physics --seeds 2    proposals dropped in physics, in generated scenes
python -m benchmarks.relations times                one proposal and one classification through a scene
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import tyro

from benchmarks.common import record, table
from benchmarks.relations.asking import curves, told
from benchmarks.relations.measure import Case, held_out, measured
from benchmarks.relations.physics import dropped
from benchmarks.relations.relations import HELD_OUT, RELATIONS
from benchmarks.relations.times import timed
from grounding.relations.learner import HOPELESS, KNOWS

FILE = "relations.jsonl"
LABELS = ((5, 0), (10, 10), (80, 80))
TUNED = tuple(name for name in RELATIONS if name not in HELD_OUT)


@dataclass(frozen=True)
class Args:
    """What is measured."""

    what: tyro.conf.Positional[str]
    """table, lazy, asking, told, random, physics or times."""
    seeds: int = 5
    """Seeds 0, 1, ..."""
    relations: tuple[str, ...] = tuple(RELATIONS)
    """Some of them."""
    record: bool = True
    """Whether results are added to benchmarks/results/relations.jsonl."""


def main(args: Args) -> None:
    tables = {
        "table": _table, "lazy": _lazy, "asking": _asking, "told": _told, "random": _random, "times": _times,
        "physics": _physics,
    }  # fmt: skip
    tables[args.what](args)


def _table(args: Args) -> None:
    rows = []
    for name in args.relations:
        row: dict[str, object] = {"relation": name}
        for good, bad in LABELS:
            found = [_one(args, Case(name, good, bad, seed)) for seed in range(args.seeds)]
            row[f"{good}+{bad} cls"] = _mean(found, "classifier")
            row[f"{good}+{bad} prop"] = _mean(found, "proposals")
        row["train s"], row["proposal ms"] = _mean(found, "training_cpu_s"), _mean(found, "proposal_ms")
        rows.append(row)
    for title, names in (("mean of the 13", TUNED), ("mean held out", HELD_OUT)):
        some = [row for row in rows if row["relation"] in names]
        if some:
            rows.append({"relation": title, **_means(some)})
    table(rows, f"relations from a few demonstrations, {args.seeds} seeds")


def _lazy(args: Args) -> None:
    rows = []
    for name in args.relations:
        row: dict[str, object] = {"relation": name}
        for lazy in ("", "height", "yaw", "size", "all"):
            found = [_one(args, Case(name, 10, 10, seed, lazy)) for seed in range(args.seeds)]
            row[lazy or "varied"] = _mean(found, "classifier")
            if lazy in ("height", "yaw", "size"):
                row[f"{lazy} warned"] = round(float(np.mean([lazy in str(one["warned"]) for one in found])), 2)
        rows.append(row)
    rows.append({"relation": "mean", **_means(rows)})
    table(rows, f"20 labels by a lazy hand, {args.seeds} seeds")


def _one(args: Args, case: Case) -> dict[str, float | str]:
    found = measured(case)
    if args.record:
        record(FILE, seed=case.seed, config={"what": "table", **case._asdict()}, **found)
    return found


def _mean(found: list[dict[str, float | str]], key: str) -> float:
    return round(float(np.mean([float(one[key]) for one in found])), 3)


def _random(args: Args) -> None:
    rows = []
    for name in args.relations:
        cases = [Case(name, 10, 10, seed) for seed in range(args.seeds)]
        row: dict[str, object] = {"relation": name}
        for words, shuffled in (("true", False), ("at random", True)):
            means = np.array([held_out(case, shuffled) for case in cases])
            row[words] = round(float(means.mean()), 3)
            row[f"{words}, below .75"] = round(float((means < KNOWS).mean()), 2)
            row[f"{words}, below .65"] = round(float((means < HOPELESS).mean()), 2)
        rows.append(row)
        if args.record:
            record(FILE, config={"what": "random", "seeds": args.seeds, **row})
    rows.append({"relation": "mean", **_means(rows)})
    table(rows, "cross-validation of 20 labels, true ones and at random")


def _means(rows: list[dict[str, object]]) -> dict[str, float]:
    """The mean of each column of numbers."""
    keys = [key for key in rows[0] if key != "relation"]
    return {key: round(float(np.mean([float(str(row[key])) for row in rows])), 3) for key in keys}


def _told(args: Args) -> None:
    rows = []
    for name in args.relations:
        found = [told(name, seed) for seed in range(args.seeds)]
        before, after, left = (round(float(one), 3) for one in np.mean(found, axis=0))
        rows.append({"relation": name, "one yaw": before, "one more": after, "warnings left": left})
    for title, names in (("mean of the 13", TUNED), ("mean held out", HELD_OUT)):
        some = [row for row in rows if row["relation"] in names]
        if some:
            rows.append({"relation": title, **_means(some)})
    for row in rows:
        if args.record:
            record(FILE, config={"what": "told", "seeds": args.seeds}, **row)
    table(rows, f"20 labels at one yaw, and one demonstration more, {args.seeds} seeds")


def _asking(args: Args) -> None:
    rows = curves(args.relations, args.seeds)
    for row in rows:
        if args.record:
            record(FILE, config={"what": "asking", "seeds": args.seeds, **row})
    table(rows, f"accuracy by labels, {args.seeds} seeds")


def _physics(args: Args) -> None:
    rows = [dropped(name, args.seeds) for name in args.relations]
    for row in rows:
        if args.record:
            record(FILE, config={"what": "physics", "seeds": args.seeds, **row})
    table(rows, f"proposals dropped in physics, {args.seeds} seeds")


def _times(args: Args) -> None:
    rows = timed()
    for row in rows:
        if args.record:
            record(FILE, config={"what": "times", **row})
    table(rows, "milliseconds of one thread, through a scene")


if __name__ == "__main__":
    main(tyro.cli(Args))
