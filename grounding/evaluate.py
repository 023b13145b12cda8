"""Evaluation of a grounding on scenes with bodies it never saw: classifier accuracy, MCA, settled
success, time.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from grounding.dataset import Dataset, Example
from grounding.model import RelationModel
from grounding.oracles import NEAR, ItemOf, Verdict, drop_verdicts, paper_verdicts
from grounding.paper.blind_ceiling import blind_ceiling
from grounding.paper.oracle import CLOUD_NEAR_M, published_oracle
from tamp.simulation.engines import open_drops

NOTHING_PROPOSED = "nothing proposed"
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
        draws: Poses a scene that the two box oracles judged.
        published: Success by the published code's oracle (`grounding.paper.oracle`) at 3 cm.
        published_scaled: The same at the tolerance to which it comes for clouds.
        blind_mca, blind_published: The blind ceilings of `mca` and `published`: what an ideal
            generator that does not see the surroundings reaches on these scenes.
        blind_corner: By the published oracle, of one that goes to the corners.
    """

    scenes: int
    mca: float
    settled: float
    feasible: float
    accuracy: float | None
    failures: dict[str, float]
    mca_failures: dict[str, float]
    milliseconds: float
    draws: int
    published: float
    published_scaled: float
    blind_mca: float
    blind_published: float
    blind_corner: float


def evaluate(
    model: RelationModel,
    data: Dataset,
    scenes: int | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] = lambda done, total: None,
    draws: int = 1,
) -> Evaluation:
    """Ask for poses in each scene, and judge them by the oracles on boxes, the first one in
    physics; the planner's collision test takes no part.

    Args:
        model: The grounding.
        data: Test scenes.
        scenes: At most so many of them, drawn by seed.
        seed: Of the scenes' order and of the model's draws.
        progress: Called with the scenes done and all.
        draws: Poses a scene, each asked for on its own; 9 in the published evaluation.
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(data))[: scenes or len(data)]
    verdicts: Counter[str] = Counter()
    papers: Counter[str] = Counter()
    feasible, times = 0, []
    right: list[bool | None] = []
    published = np.zeros(2)
    items = ItemOf()

    with open_drops() as drops:
        for done, index in enumerate(order):
            example = data[int(index)]
            situation = example.situation
            started = time.perf_counter()
            poses = model.propose(situation, 1, rng)
            times.append(time.perf_counter() - started)
            verdict = drop_verdicts(situation, poses, drops, items)[0] if len(poses) else None
            verdicts[str(verdict or NOTHING_PROPOSED)] += 1

            more = [model.propose(situation, 1, rng) for _ in range(draws - 1)]
            for drawn in (poses, *more):
                papers[
                    str(paper_verdicts(situation, drawn)[0] if len(drawn) else NOTHING_PROPOSED)
                ] += 1
                published += [
                    published_oracle(situation, drawn, near).sum() for near in (NEAR, CLOUD_NEAR_M)
                ]

            right.append(_right(model, example))
            possible = bool(data.arrays["feasible"][index]) if "feasible" in data.arrays else True
            feasible += possible or verdict is Verdict.HOLDS
            if done % 50 == 49:
                progress(done + 1, len(order))

    count = len(order)
    ceiling = blind_ceiling(data, order, draws, seed)

    return Evaluation(
        count,
        papers[Verdict.HOLDS] / papers.total(),
        verdicts[Verdict.HOLDS] / count,
        feasible / count,
        _share(right),
        _failures(verdicts),
        _failures(papers),
        1e3 * float(np.median(times)),
        draws,
        float(published[0]) / papers.total(),
        float(published[1]) / papers.total(),
        ceiling.mca,
        ceiling.published,
        ceiling.corner,
    )


def accuracy(
    model: RelationModel, data: Dataset, scenes: int | None = None, seed: int = 0
) -> float | None:
    """Return the share of scenes that the classifier is right about, at their own poses; None when
    there is no classifier.

    Args:
        model: The grounding.
        data: Labelled scenes.
        scenes: At most so many of them, the same ones as `evaluate` takes.
        seed: Of their order.
    """
    order = np.random.default_rng(seed).permutation(len(data))[: scenes or len(data)]
    right: list[bool | None] = []
    for index in order:
        right.append(_right(model, data[int(index)]))
        if right[-1] is None:
            return None
    return _share(right)


def _right(model: RelationModel, example: Example) -> bool | None:
    """Check whether the classifier is right about an example; None when there is no classifier."""
    own = float(model.classify(example.situation, example.situation.body.matrix[None])[0])
    return None if math.isnan(own) else (own > 0.5) == example.holds


def _share(right: Sequence[bool | None]) -> float | None:
    return None if None in right else sum(map(bool, right)) / len(right)


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
