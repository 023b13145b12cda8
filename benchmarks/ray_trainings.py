"""Trainings of the paper's networks on a Ray cluster, which may lose workers on the way."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from grounding.dataset import read_dataset
from grounding.weights import Weights
from tamp.benchmark.ray_pool import RayPool
from tamp.benchmark.scheduler import ATTEMPTS, dispatch
from tamp.errors import InputError

BUDGET_S = 24 * 3600.0
"""Seconds after which a training is given up."""


@dataclass(frozen=True)
class Training:
    """One training of several seeds.

    Attributes:
        model, scheme, departures: See `grounding.paper.training.train`.
        samples: Training scenes.
        iterations: Of the classifier, and then of the generator.
        seeds: Trained as one ensemble.
        time: Its budget, seconds.
    """

    model: str
    scheme: str
    departures: tuple[str, ...]
    samples: int
    iterations: int
    seeds: tuple[int, ...]
    time: float = BUDGET_S


@dataclass(frozen=True)
class Files:
    """What a worker needs, which may be on another machine.

    Attributes:
        data, card: The data set's two files.
        encoder: Of clouds.
    """

    data: bytes
    card: bytes
    encoder: Weights | None = None


Work = Callable[[Training, Files], list[Weights]]


def train_there(training: Training, files: Files) -> list[Weights]:
    """Train in a worker's process, one model a seed."""
    from grounding.paper.training import train

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "train.npz"
        path.write_bytes(files.data)
        path.with_suffix(".json").write_bytes(files.card)
        data = read_dataset(path)
    return train(
        data,
        training.model,
        training.scheme,
        sizes=[training.samples] * len(training.seeds),
        seeds=training.seeds,
        iterations=training.iterations,
        departures=training.departures,
        encoder=files.encoder,
    )


def train_all(
    trainings: Sequence[Training], files: Files, address: str, workers: int | None = None, work: Work = train_there
) -> Iterator[tuple[Training, list[Weights]]]:
    """Train on a cluster, each once; yields trainings and their weights as they end.

    Args:
        trainings: Which.
        files: What they are trained on.
        address: Of the cluster, see RayPool.
        workers: Trainings at a time; as many as the cluster has cores when not given.
        work: What a worker does.

    Raises:
        InputError: Ray is not installed, no cluster is there, a training is not possible, or its worker was lost each
            time.
    """
    if not trainings:
        return
    pool = RayPool[Training](address, partial(_done, work, files), _nothing, workers)
    with closing(pool):
        for training, weights, _ in dispatch(trainings, pool):
            if weights is None:
                what = f"the workers that trained {training.model} {training.scheme} were lost {ATTEMPTS} times"
                raise InputError(what, remedy="The same command goes on with what is there")
            yield training, weights


def _done(work: Work, files: Files, training: Training) -> list[Weights]:
    return work(training, files)


def _nothing() -> None:
    """Prepare nothing."""
