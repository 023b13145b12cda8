"""From labelled scenes to weights of our groundings; torch is imported when the ranker is trained."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

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


def train_relational(
    data: Dataset, args: TrainArgs = TrainArgs(), progress: Callable[[str], None] = lambda line: None, *, flow: bool
) -> Weights:
    """A relational grounding of the first scenes of a data set: demonstrations to transfer, or a flow, and the ranker.

    Raises:
        InputError: None of them holds.
    """
    count = min(args.samples or len(data), len(data))
    progress(f"measuring {count} scenes")
    measured = [measure(data[index]) for index in range(count)]
    usable = np.array([bool(len(one.view.faces)) for one in measured])
    holds = data.holds[:count]
    positive = [one for one, good in zip(measured, holds & usable, strict=True) if good]
    if not positive:
        raise InputError(f"none of the {count} scenes is a positive one", remedy="More --samples")
    chart = Chart.fit(positive)
    if flow:
        from grounding.relational import flow_training

        proposals = flow_training.train_flow(
            chart,
            positive,
            flow_training.Args(seed=args.seed),
            lambda step, steps, loss: progress(f"flow {step}/{steps}, loss {loss:.4f}"),
        )
    else:
        proposals = Transfer.of(chart, [chart.encode(one) for one in positive[: args.demonstrations]])
    rank, score = {}, None
    ranks = count >= RANKS_FROM and not holds.all()
    if ranks:
        from grounding.relational.training import Args, train_ranker

        rank, score = train_ranker(
            [one for one, good in zip(measured, usable, strict=True) if good],
            holds[usable],
            Args(seed=args.seed),
            lambda step, steps, score: progress(f"ranker {step}/{steps}, validation accuracy {score:.4f}"),
        )
    card = {
        "relation": data.relation,
        "model": "flow" if flow else "transfer",
        "samples": count,
        "seed": args.seed,
        "commit": args.commit,
        "data": {name: data.card[name] for name in ("split", "seed", "count") if name in data.card},
        "validation accuracy": score,
        "ranks": ranks,
        "classifies": ranks,
    }
    return relational_weights(chart, proposals, rank, card)


def measure(example: Example) -> Measures:
    """An example's one pose in its region's frame."""
    view = View(example.situation)
    return view.measure((view.T_region_world @ example.situation.body.matrix)[None])


TRAINERS: dict[str, Callable[..., Weights]] = {
    "transfer": partial(train_relational, flow=False),
    "flow": partial(train_relational, flow=True),
}
"""Model name to what trains it."""
