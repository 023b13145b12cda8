"""Options of training a grounding, and which models have them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

NETWORKS = ("mlp-bb", "gnn-bb", "mlp-pc", "gnn-pc")
"""The paper's models: network and features."""

OPTIONS: Mapping[str, tuple[str, ...]] = {
    "scheme": NETWORKS,
    "departures": NETWORKS,
    "iterations": NETWORKS,
    "encoder": ("mlp-pc", "gnn-pc", "tree-pc"),
}
"""Fields of TrainArgs that only some models have."""


@dataclass(frozen=True)
class TrainArgs:
    """The training options.

    Attributes:
        samples: How many scenes of the data set; None for all.
        seed: Of initial weights and batches.
        demonstrations: At most so many positive ones are kept to draw from, by `transfer`.
        scheme: What teaches the generator of one of the paper's networks: discriminator, classifier
            or both; None for the relation's headline scheme.
        departures: What is done otherwise than in the paper, of its networks: any of
            `grounding.paper.training.DEPARTURES`.
        iterations: Of the paper's networks; None for the paper's 30,000.
        encoder: Weights of an encoder of clouds, which the models on clouds need.
        state: Where an interrupted training of the paper's networks goes on from, and is saved.
        commit: Of the code, for the card.
    """

    samples: int | None = None
    seed: int = 0
    demonstrations: int = 2000
    scheme: str | None = None
    departures: tuple[str, ...] | None = None
    iterations: int | None = None
    encoder: Path | None = None
    state: Path | None = None
    commit: str = ""
