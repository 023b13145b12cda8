"""Training of the paper's models from a data set, by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from grounding.dataset import Dataset
from grounding.paper.cloud_embeddings import embedding_table
from grounding.paper.feature_table import FeatureTable, table_of
from grounding.paper.features import BoxFeatures
from grounding.paper.runtime import CHOICE, MIDDLE, RESIDUAL, TRIES, TURNED, NumpyEncoder
from grounding.paper.trainer import SCHEMES, Trainer
from grounding.paper.trainer_options import TrainerOptions
from grounding.train_options import NETWORKS
from grounding.weights import Weights
from tamp.errors import InputError

DEPARTURES = (
    "residual-turn",
    "middle-code",
    "mean-weights",
    "scaled-classifier",
    "attention",
    "own-choice",
    "turned-scenes",
    "scaled-scenes",
    "edge-negatives",
    "turned-proposals",
)
"""What may be done otherwise than in the paper: the generator on boxes turns argument 1 from where
it was, as the published one on clouds does; a code is of the cloud about the middle of its extent,
where its position is, not about its centroid; the running mean of the generator's weights is kept;
the classifier's gradient is brought to the critic's length where both teach; a GNN weights the
surroundings by a softmax instead of taking their mean; of CHOICE proposals the one that the own
classifier takes for the likeliest is returned; scenes are turned about the vertical, and half of
them mirrored, anew for each block of iterations; they are scaled likewise; the data set has
negatives close by the limits (`grounding.paper.edge_negatives`); each proposal is made with the
scene turned otherwise, and turned back.
"""

VARYING = ("turned-scenes", "scaled-scenes")
"""Those by which scenes are shown otherwise in each block of iterations; of boxes only."""

MEAN_WEIGHTS = 0.999
"""The share of the running mean that is kept a step."""


def train(
    data: Dataset,
    model: str,
    scheme: str = "both",
    *,
    sizes: Sequence[int],
    seeds: Sequence[int],
    iterations: int = 30_000,
    departures: Sequence[str] = (),
    encoder: Weights | None = None,
    table: FeatureTable | None = None,
    classifiers: Sequence[Weights] = (),
    state: Path | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> list[Weights]:
    """Train one model for each pair of a size and a seed, all at once, in one thread's worth of
    small matrices.

    Args:
        data: The training set.
        model: One of NETWORKS.
        scheme: What teaches the generator, one of SCHEMES.
        sizes: How many of the examples each model sees.
        seeds: As many; initial weights, order of the examples and noise.
        iterations: Of the classifier, and then of the generator.
        departures: What is done otherwise than in the paper, any of DEPARTURES.
        encoder: What codes the clouds, for the models on clouds.
        table: The data's features, if they are known already.
        classifiers: One a model, trained on the same data, size, seed and iterations, perhaps by
            another scheme, which classifiers do not depend on: these are not trained again.
        state: A file to go on from, and to save the state of the run in every 2,000 iterations.
        progress: Told how far it is.

    Raises:
        InputError: An unknown model or scheme, sizes that the data do not have, no encoder, another
            run's state.
    """
    _check(data, model, scheme, sizes, seeds, encoder, departures)
    residual = _clouds(model) or "residual-turn" in departures
    about_middle = "middle-code" in departures
    varied = any(name in departures for name in VARYING)
    shown_unturned = residual and not varied  # else after scenes were turned
    table = table or features_of(
        data, model, encoder, progress, max(sizes), shown_unturned, about_middle
    )
    args = TrainerOptions(
        iterations=iterations,
        mean_weights=MEAN_WEIGHTS if "mean-weights" in departures else 0.0,
        scaled_classifier="scaled-classifier" in departures,
        attention="attention" in departures,
        turned="turned-scenes" in departures,
        scaled="scaled-scenes" in departures,
        residual=varied and residual,
    )
    trainer = Trainer(table, model.startswith("gnn"), scheme, sizes, seeds, args)
    if classifiers:
        trainer.take_classifiers([weights.arrays for weights in classifiers])
    trainer.run(state, progress)
    extra = (
        {f"encoder.{name}": array for name, array in encoder.arrays.items()}
        if _clouds(model) and encoder
        else {}
    )
    if residual:
        extra[RESIDUAL] = np.ones(1, np.float32)
    if about_middle:
        extra[MIDDLE] = np.ones(1, np.float32)
    if "own-choice" in departures:
        extra[TRIES] = np.full(1, CHOICE, np.float32)
    if "turned-proposals" in departures:
        extra[TURNED] = np.ones(1, np.float32)

    return [
        Weights(
            {**arrays, **extra},
            {
                "relation": data.relation,
                "model": model,
                "scheme": scheme,
                "departures": sorted(departures),
                "samples": size,
                "seed": seed,
                "iterations": iterations,
                "data": {
                    key: data.card[key]
                    for key in ("split", "seed", "count", "commit", "layout", "edges")
                    if key in data.card
                },
                "architecture": {name: list(array.shape) for name, array in arrays.items()},
            },
        )
        for size, seed, arrays in zip(sizes, seeds, trainer.models(), strict=True)
    ]


def features_of(
    data: Dataset,
    model: str,
    encoder: Weights | None,
    progress: Callable[[str], None],
    count: int | None = None,
    residual: bool = False,
    about_middle: bool = False,
) -> FeatureTable:
    """Compute the features that a model is trained on, of the first `count` scenes or of all; with
    `residual` those for turns from where argument 1 was, with `about_middle` those of middle-code.
    """
    if _clouds(model) and encoder is not None:
        around = model.startswith("gnn")
        return embedding_table(
            data,
            NumpyEncoder(encoder.arrays),
            progress,
            count=count,
            surroundings=around,
            residual=residual,
            about_middle=about_middle,
        )
    return table_of(data, BoxFeatures(residual), progress, count)


def _clouds(model: str) -> bool:
    return model.endswith("pc")


def _check(
    data: Dataset,
    model: str,
    scheme: str,
    sizes: Sequence[int],
    seeds: Sequence[int],
    encoder: Weights | None,
    departures: Sequence[str],
) -> None:
    for found in departures:
        if found not in DEPARTURES:
            raise InputError(f"unknown departure '{found}'", found=found, choices=DEPARTURES)
    boxes_only = {*departures} & {*VARYING, "turned-proposals"}
    if boxes_only and _clouds(model):
        raise InputError(f"model '{model}' sees clouds; {min(boxes_only)} is for models on boxes")
    if ("edge-negatives" in departures) != bool(data.card.get("edges")):
        have = "has" if data.card.get("edges") else "lacks"
        raise InputError(
            f"the data set {have} negatives close by the limits",
            remedy="--departures edge-negatives goes with data of "
            "tamp-learn generate --layout paper --edges",
        )
    if "middle-code" in departures and not _clouds(model):
        raise InputError(f"model '{model}' sees no clouds, whose codes middle-code changes")
    if "attention" in departures and model.startswith("mlp"):
        raise InputError(f"model '{model}' sees no surroundings to attend to")
    if model not in NETWORKS:
        raise InputError(f"unknown model '{model}'", found=model, choices=NETWORKS)
    if scheme not in SCHEMES:
        raise InputError(f"unknown scheme '{scheme}'", found=scheme, choices=SCHEMES)
    if len(sizes) != len(seeds) or not sizes:
        raise InputError(f"{len(sizes)} sizes for {len(seeds)} seeds; each model has one of each")

    if min(sizes) < 2 or max(sizes) > len(data):
        raise InputError(
            f"training sets of {min(sizes)} to {max(sizes)} examples; 2 to {len(data)} are possible"
        )
    if not 0 < int(data.holds.sum()) < len(data):
        raise InputError(
            "the demonstrations are all positive or all negative",
            remedy="Add some of the other kind.",
        )
    if _clouds(model) and encoder is None:
        raise InputError(
            f"model '{model}' needs an encoder of clouds",
            remedy="Train one: tamp-learn encoder --help",
        )
