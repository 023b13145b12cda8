"""Evaluation of a grounding on scenes with bodies it never saw: classifier accuracy, MCA, settled
success, time.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grounding.dataset import Dataset
from grounding.model import Model
from grounding.oracles import ItemOf, Verdict, paper_verdicts, settled
from tamp.simulation.engines import open_drops

NOTHING = "nothing proposed"
"""What is counted where a model knows of no pose."""


@dataclass(frozen=True)
class Evaluation:
    """Shares are of all scenes, positive and negative ones alike.

    Attributes:
        scenes: How many.
        mca: Success by the paper's oracle, of the one pose returned.
        settled: Success in physics.
        feasible: The share of scenes in which a placement was found at all, by the data's maker or
            by the model.
        accuracy: Of the classifier, at the scenes' own poses; None when it has none.
        failures: How the failures failed in physics, shares by verdict.
        mca_failures: How they failed by the paper's oracle.
        milliseconds: Of one returned pose, the median.
    """

    scenes: int
    mca: float
    settled: float
    feasible: float
    accuracy: float | None
    failures: dict[str, float]
    mca_failures: dict[str, float]
    milliseconds: float


def evaluate(
    model: Model,
    data: Dataset,
    scenes: int | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Evaluation:
    """Ask for one pose in each scene, and judge it by both oracles; the planner's collision test
    takes no part.

    Args:
        model: The grounding.
        data: Test scenes.
        scenes: At most so many of them, drawn by seed.
        seed: Of the scenes' order and of the model's draws.
        progress: Called with the scenes done and all.
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(data))[: scenes or len(data)]
    verdicts: Counter[str] = Counter()
    papers: Counter[str] = Counter()
    feasible, times = 0, []
    items = ItemOf()

    with open_drops() as drops:
        for done, index in enumerate(order):
            situation = data[int(index)].situation
            started = time.perf_counter()
            poses = model.propose(situation, 1, rng)
            times.append(time.perf_counter() - started)
            verdict = settled(situation, poses, drops, items)[0] if len(poses) else None
            verdicts[str(verdict or NOTHING)] += 1
            papers[str(paper_verdicts(situation, poses)[0] if len(poses) else NOTHING)] += 1
            known = bool(data.arrays["feasible"][index]) if "feasible" in data.arrays else True
            feasible += known or verdict is Verdict.HOLDS
            if done % 50 == 49:
                progress(done + 1, len(order))

    count = len(order)

    return Evaluation(
        count,
        papers[Verdict.HOLDS] / count,
        verdicts[Verdict.HOLDS] / count,
        feasible / count,
        accuracy(model, data, scenes, seed),
        _failures(verdicts),
        _failures(papers),
        1e3 * float(np.median(times)),
    )


def accuracy(model: Model, data: Dataset, scenes: int | None = None, seed: int = 0) -> float | None:
    """Return the share of scenes that the classifier is right about, at their own poses; None when
    there is no classifier.

    Args:
        model: The grounding.
        data: Labelled scenes.
        scenes: At most so many of them, the same ones as `evaluate` takes.
        seed: Of their order.
    """
    order = np.random.default_rng(seed).permutation(len(data))[: scenes or len(data)]
    right = 0
    for index in order:
        example = data[int(index)]
        own = float(model.classify(example.situation, example.situation.body.matrix[None])[0])
        if math.isnan(own):
            return None
        right += (own > 0.5) == example.holds
    return right / len(order)


def _failures(verdicts: Counter[str]) -> dict[str, float]:
    """Return each failure's share of all."""
    count = verdicts.total()
    return {
        name: number / count for name, number in sorted(verdicts.items()) if name != Verdict.HOLDS
    }


def wilson(share: float, count: int) -> tuple[float, float]:
    """Compute the 95 % confidence interval of a share of `count` (Wilson 1927)."""
    z = 1.96
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = (
        z
        / (1 + z * z / count)
        * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    )
    return max(0.0, middle - half), min(1.0, middle + half)
