"""How long one proposal and one classification take, as the planner asks for them: a scene and names in."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from numpy.random import Generator as Random

from benchmarks.relations.files import NAMES, write
from benchmarks.relations.relations import RELATIONS
from grounding.relations.demonstration_file import demonstrations_of
from grounding.relations.files import weights_of
from grounding.relations.grounding import LearnedRelation
from grounding.relations.learner import learn
from tamp.geometric.scene.scene import Scene

MEASURED = ("upright", "left_of_front", "stack", "between")
TIMES = 60


def timed() -> list[dict[str, object]]:
    """Learn from files, and ask in the scenes of these."""
    rows: list[dict[str, object]] = []
    for name in MEASURED:
        rng = np.random.default_rng(0)
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), name, 10, 10, rng)
            shown = list(demonstrations_of(name, [Path(folder)]))
        relation = LearnedRelation(weights_of(learn(name, shown, rng), {}))
        rows.append(_asked(name, relation, [one.scene for one in shown], rng))
    return rows


def _asked(name: str, relation: LearnedRelation, scenes: list[Scene], rng: Random) -> dict[str, object]:
    names = NAMES[: RELATIONS[name].arguments]
    return {
        "relation": name,
        "one proposal": _median([partial(relation.propose, scene, names, 1, rng) for scene in scenes]),
        "16 proposals": _median([partial(relation.propose, scene, names, 16, rng) for scene in scenes]),
        "one classification": _median([partial(relation.classify, scene, names) for scene in scenes]),
    }


def _median(calls: list[Callable[[], object]]) -> float:
    for call in calls:
        call()
    times: list[float] = []
    for turn in range(TIMES):
        started = time.process_time()
        calls[turn % len(calls)]()
        times.append(1000 * (time.process_time() - started))
    return round(float(np.median(times)), 3)
