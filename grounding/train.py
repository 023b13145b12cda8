"""Training from labelled scenes to weights of a grounding, by name; torch and scikit-learn are
imported when they are used.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from grounding.certainty import MANY, REASON, Labels, chance, no_better_than_chance, too_few
from grounding.dataset import Dataset, Example
from grounding.registry import MODELS, PARAMETER_FREE, SHARED_WEIGHTS
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.measures import Measures, RegionFrame
from grounding.relational.model import relational_weights
from grounding.relational.proposals import Transfer
from grounding.relational.ranker import Ranker
from grounding.train_options import NETWORKS as NETWORKS
from grounding.train_options import OPTIONS as OPTIONS
from grounding.train_options import TrainArgs as TrainArgs
from grounding.weights import Weights, read_weights
from tamp.errors import InputError

RANKS_FROM = 100
"""Labelled scenes from which on the ranker takes part; with fewer it does harm (LEARNING.md,
section 3).
"""

SHOWN = 500
"""Labels that one of the paper's classifiers is asked of again."""

ITERATIONS = 30_000
"""Of the paper's networks: of the classifier, and then of the generator."""

DEFAULTS = TrainArgs()

Say = Callable[[str], None]
"""What is told how far it is."""


def train(
    data: Dataset, model: str, args: TrainArgs = DEFAULTS, progress: Say = lambda line: None
) -> Weights:
    """Train a grounding.

    Args:
        data: Labelled scenes.
        model: One of TRAINERS.
        args: How.
        progress: Told how far it is.

    Raises:
        InputError: An unknown model or one that is not trained, an option that it has not, scenes
            that do not serve.
        ImportError: What it is trained with is not installed.
    """
    check(data.relation, model, args)
    if args.samples is not None and args.samples > len(data):
        raise InputError(f"the data set has {len(data):,} scenes, not {args.samples:,}")
    return TRAINERS[model](data, args, progress)


def check(relation: str, model: str, args: TrainArgs) -> None:
    """Check the options as far as they can be before the data are read.

    Raises:
        InputError: An unknown model or one that is not trained, or an option that it has not.
    """
    if model in SHARED_WEIGHTS:
        remedy = f"Train that: tamp-learn train {relation} --model {SHARED_WEIGHTS[model]}"
        raise InputError(
            f"'{model}' is not trained: it judges by the classifier of '{SHARED_WEIGHTS[model]}'",
            remedy=remedy,
        )
    if model in PARAMETER_FREE:
        raise InputError(f"'{model}' needs no training")
    if model not in TRAINERS:
        raise InputError(f"unknown model '{model}'", found=model, choices=TRAINERS)
    for option, models in OPTIONS.items():
        if getattr(args, option) is not None and model not in models:
            raise InputError(f"model '{model}' has no {option}; these have: {', '.join(models)}")
    if model in OPTIONS["encoder"] and args.encoder is None:
        raise InputError(
            f"model '{model}' needs an encoder of clouds",
            remedy=f"Train one: tamp-learn encoder {relation}",
        )


def train_relational(
    data: Dataset, args: TrainArgs = DEFAULTS, progress: Say = lambda line: None, *, flow: bool
) -> Weights:
    """Train a relational grounding of the first scenes of a data set: demonstrations to transfer,
    or a flow, and the ranker.

    Raises:
        InputError: None of them holds.
    """
    count = args.samples or len(data)
    progress(f"measuring {count} scenes")
    measured = [measure(data[index]) for index in range(count)]
    usable = np.array([bool(len(one.view.faces)) for one in measured])
    holds = data.holds[:count]
    positive = [one for one, good in zip(measured, holds & usable, strict=True) if good]
    if not positive:
        raise InputError(f"none of the {count} scenes is a positive one", remedy="More --samples")
    chart = RelationalCoordinates.fit(positive)
    if flow:
        from grounding.relational import flow_training

        proposals = flow_training.train_flow(
            chart,
            positive,
            flow_training.FlowOptions(seed=args.seed),
            lambda step, steps, loss: progress(f"flow {step}/{steps}, loss {loss:.4f}"),
        )
    else:
        proposals = Transfer.of(
            chart, [chart.encode(one) for one in positive[: args.demonstrations]]
        )
    rank, score = {}, None
    ranks = count >= RANKS_FROM and not holds.all()
    if ranks:
        from grounding.relational.training import RankerOptions, train_ranker

        rank, score = train_ranker(
            [one for one, good in zip(measured, usable, strict=True) if good],
            holds[usable],
            RankerOptions(seed=args.seed),
            lambda step, steps, score: progress(
                f"ranker {step}/{steps}, validation accuracy {score:.4f}"
            ),
        )
    card = {
        "relation": data.relation,
        "model": "flow" if flow else "transfer",
        "samples": count,
        "seed": args.seed,
        "commit": args.commit,
        "data": {
            name: data.card[name]
            for name in ("split", "seed", "count", "layout")
            if name in data.card
        },
        "validation accuracy": score,
        "ranks": ranks,
        **_certainty(measured, holds, usable, ranks, score, args.seed),
    }
    return relational_weights(chart, proposals, rank, card)


def _certainty(
    measured: list[Measures],
    holds: Labels,
    usable: Labels,
    ranks: bool,
    score: float | None,
    seed: int,
) -> dict[str, object]:
    """Return the card's entries on whether the ranker may judge, and else why not."""
    why = too_few(holds)
    if why is None and ranks:
        from grounding.relational.training import RankerOptions, train_ranker

        seen = [one for one, good in zip(measured, usable, strict=True) if good]
        labels = holds[usable]

        def fit(train_rows: NDArray[np.intp], test_rows: NDArray[np.intp]) -> Labels:
            rank, _ = train_ranker(
                [seen[row] for row in train_rows], labels[train_rows], RankerOptions(seed=seed)
            )
            ranker = Ranker(rank)
            return np.array(
                [float(ranker.logits(seen[row])[0]) > 0.0 for row in test_rows], dtype=bool
            )

        if len(labels) < MANY:
            why = no_better_than_chance(labels, fit)
        elif score is not None and score <= max(labels.mean(), 1 - labels.mean()):
            why = (
                f"on labels that it was not shown it is right about {100 * score:.0f} %, "
                "as saying the same always is"
            )
    return {"classifies": ranks and why is None, **({REASON: why} if why else {})}


def measure(example: Example) -> Measures:
    """Measure an example's one pose in its region's frame."""
    view = RegionFrame(example.situation)
    return view.measure((view.T_region_world @ example.situation.body.matrix)[None])


def train_paper(data: Dataset, args: TrainArgs, progress: Say, *, model: str) -> Weights:
    """Train one of the paper's networks, on as many scenes in the order of
    `grounding.paper.feature_table.order`.
    """
    from grounding.paper.trainer_options import HEADLINE_SCHEME
    from grounding.paper.training import train as train_networks

    (weights,) = train_networks(
        data,
        model,
        args.scheme or HEADLINE_SCHEME.get(data.relation, "both"),
        sizes=[args.samples or len(data)],
        seeds=[args.seed],
        encoder=None if args.encoder is None else encoder_of(args.encoder),
        state=args.state,
        progress=progress,
        iterations=args.iterations or ITERATIONS,
        departures=args.departures or (),
    )
    return _signed(_checked(weights, data, args), args)


def train_tree(data: Dataset, args: TrainArgs, progress: Say, *, model: str) -> Weights:
    """Train one of the paper's trees, on the same scenes."""
    from grounding.paper import tree_training

    weights = tree_training.train_tree(
        data,
        model,
        samples=args.samples or len(data),
        seed=args.seed,
        encoder=None if args.encoder is None else encoder_of(args.encoder),
        progress=progress,
    )
    return _signed(_checked(weights, data, args), args)


def _checked(weights: Weights, data: Dataset, args: TrainArgs) -> Weights:
    """Add to the weights what their card says of their classifier; it is asked of the labels that
    it was shown.
    """
    count = args.samples or len(data)
    why = too_few(data.holds[:count])
    if why is None and weights.card.get("classifies", True):
        model = MODELS[str(weights.card["model"])](weights)
        examples = [data[index] for index in range(min(count, SHOWN))]
        bodies = [(one.situation, one.situation.body.matrix[None]) for one in examples]
        said = np.array([float(model.classify(*body)[0]) > 0.5 for body in bodies], dtype=bool)
        why = chance(data.holds[: len(said)], said)
    return (
        Weights(weights.arrays, {**weights.card, "classifies": False, REASON: why})
        if why
        else weights
    )


def encoder_of(path: Path) -> Weights:
    """Read an encoder of clouds: a file of its own, or what is inside a model on clouds.

    Raises:
        InputError: There is none in it.
    """
    weights = read_weights(path)
    inside = {
        name.removeprefix("encoder."): array
        for name, array in weights.arrays.items()
        if name.startswith("encoder.")
    }
    if inside:
        return Weights(inside, {})
    if (weights.card.get("model"), weights.card.get("kind")) != ("encoder", "conv"):
        raise InputError(
            "no encoder of kind 'conv'",
            file=path,
            remedy="Train one: tamp-learn encoder --help",
        )
    return weights


def _signed(weights: Weights, args: TrainArgs) -> Weights:
    return Weights(weights.arrays, {**weights.card, "commit": args.commit})


TRAINERS: Mapping[str, Callable[..., Weights]] = {
    "transfer": partial(train_relational, flow=False),
    "flow": partial(train_relational, flow=True),
    **{name: partial(train_paper, model=name) for name in NETWORKS},
    **{name: partial(train_tree, model=name) for name in ("tree-bb", "tree-pc")},
}
"""Model name to what trains it."""
