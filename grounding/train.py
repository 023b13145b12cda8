"""From labelled scenes to weights of our groundings; torch is imported when the ranker is trained."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from grounding.dataset import Dataset, Example
from grounding.relational.chart import Chart
from grounding.relational.measures import Measures, View
from grounding.relational.model import relational_weights
from grounding.relational.proposals import Transfer
from grounding.weights import Weights
from tamp.errors import InputError

RANKS_FROM = 100
"""Labelled scenes from which on the ranker takes part; with fewer it does harm (LEARNING.md, section 3)."""


@dataclass(frozen=True)
class TrainArgs:
    """What is trained.

    Attributes:
        samples: How many scenes of the data set, its first ones; None for all.
        seed: Of initial weights and batches.
        demonstrations: At most so many positive ones are kept to draw from.
        commit: Of the code, for the card.
    """

    samples: int | None = None
    seed: int = 0
    demonstrations: int = 2000
    commit: str = ""


def train_transfer(
    data: Dataset, args: TrainArgs = TrainArgs(), progress: Callable[[str], None] = lambda line: None
) -> Weights:
    """A relational grounding of the first scenes of a data set.

    Raises:
        InputError: None of them holds.
    """
    count = min(args.samples or len(data), len(data))
    progress(f"measuring {count} scenes")
    measured = [measure(data[index]) for index in range(count)]
    holds = data.holds[:count]
    positive = [one for one, good in zip(measured, holds, strict=True) if good and one.view.form.faces]
    if not positive:
        raise InputError(f"none of the {count} scenes is a positive one", remedy="More --samples")
    chart = Chart.fit(positive)
    transfer = Transfer.of(chart, [chart.encode(one) for one in positive[: args.demonstrations]])
    rank, accuracy = {}, None
    ranks = count >= RANKS_FROM and not holds.all()
    if ranks:
        from grounding.relational.training import Args, train_ranker

        usable = [index for index, one in enumerate(measured) if one.view.form.faces]
        rank, accuracy = train_ranker(
            [measured[index] for index in usable],
            holds[np.array(usable)],
            Args(seed=args.seed),
            lambda step, steps, score: progress(f"ranker {step}/{steps}, validation accuracy {score:.4f}"),
        )
    card = {
        "relation": data.relation,
        "model": "transfer",
        "samples": count,
        "seed": args.seed,
        "commit": args.commit,
        "data": {name: data.card[name] for name in ("split", "seed", "count") if name in data.card},
        "validation accuracy": accuracy,
        "ranks": ranks,
        "classifies": ranks,
    }
    return relational_weights(chart, transfer, rank, card)


def measure(example: Example) -> Measures:
    """An example's one pose in its region's frame."""
    view = View(example.situation)
    return view.measure((view.T_region_world @ example.situation.body.matrix)[None])


TRAINERS: dict[str, Callable[..., Weights]] = {"transfer": train_transfer}
"""Model name to what trains it."""


def accuracy(predicted: Sequence[float], holds: np.ndarray) -> float:
    """The share of probabilities on the right side of a half."""
    return float(((np.asarray(predicted) > 0.5) == holds).mean())
