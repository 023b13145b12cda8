"""Data sets and trained groundings in their folders, made when they are missing, shared between the figures."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from benchmarks.groundings.case import Case
from grounding.dataset import Dataset, read_dataset
from grounding.model import RelationModel
from grounding.registry import PARAMETER_FREE, SHARED_WEIGHTS, TRAINING_VARIANTS, load_model
from grounding.weights import Weights, write_weights
from tamp.errors import InputError


@dataclass(frozen=True)
class Library:
    """Where the data and the weights are, and what may be made.

    Attributes:
        data: With RELATION_train.npz and RELATION_test.npz.
        weights: With RELATION-MODEL-SAMPLES-SEED.safetensors, and RELATION-encoder.safetensors for the clouds.
        train: Whether missing weights are trained.
        iterations: Of the paper's networks and of the encoder; None for what they usually have.
        generate: Scenes of training and test that are made where there are no data; None for an error.
        say: Told what takes a while.
    """

    data: Path
    weights: Path
    train: bool = True
    iterations: int | None = None
    generate: tuple[int, int] | None = None
    say: Callable[[str], None] = lambda line: None

    def scenes(self, relation: str, split: str) -> Dataset:
        """A data set.

        Raises:
            InputError: There is none, and none may be generated.
        """
        path = self.data / f"{relation}_{split}.npz"
        if not path.is_file() and self.generate is not None:
            from grounding.generate import Job, generate

            count = self.generate[split == "test"]
            self.say(f"generating {count} scenes: {path}")
            generate(Job(relation, split, count), path, workers=1)
        return _read(path)

    def model(self, case: Case) -> RelationModel | None:
        """The grounding of a case; None when its weights are missing and may not be trained.

        Raises:
            InputError: There are no data to train it on.
        """
        if case.model in PARAMETER_FREE:
            return PARAMETER_FREE[case.model]()
        path = self.weights / f"{case.weights}.safetensors"
        if not path.is_file():
            if not self.train:
                return None
            self._train(case, path)
        return load_model(path, TRAINING_VARIANTS.get(case.model, case.model))

    def _train(self, case: Case, path: Path) -> None:
        from grounding.train import NETWORKS, TrainArgs, train

        borrowed = SHARED_WEIGHTS.get(case.model, case.model)
        model = TRAINING_VARIANTS.get(borrowed, borrowed)
        network = model in NETWORKS
        args = TrainArgs(
            samples=case.samples,
            seed=case.seed,
            scheme=borrowed.removeprefix(f"{model}-") if borrowed in TRAINING_VARIANTS else None,
            iterations=self.iterations if network else None,
            encoder=self._encoder(case.relation) if model.endswith("-pc") else None,
            state=path.with_suffix(".state") if network else None,
        )
        self.say(f"training {path}")
        started = time.perf_counter()
        weights = train(self.scenes(case.relation, "train"), model, args)
        write_weights(path, weights)
        path.with_suffix(".state").unlink(missing_ok=True)
        self.say(f"trained in {time.perf_counter() - started:.0f} s")

    def _encoder(self, relation: str) -> Path:
        """The encoder's weights, trained if need be."""
        path = self.weights / f"{relation}-encoder.safetensors"
        if not path.is_file():
            from grounding.paper.encoders import EncoderOptions, train_encoder

            self.say(f"training {path}")
            args = (
                EncoderOptions() if self.iterations is None else EncoderOptions(iterations=self.iterations, points=256)
            )
            arrays, _ = train_encoder(self.scenes(relation, "train"), "conv", "one", args, lambda line: None)
            write_weights(path, Weights(arrays, {"model": "encoder", "kind": "conv", "relation": relation}))
        return path


@cache
def _read(path: Path) -> Dataset:
    if not path.is_file():
        remedy = f"tamp-learn generate {path.stem.partition('_')[0]} --out {path}, or name a folder with --data"
        raise InputError("no such data set", file=path, remedy=remedy)
    return read_dataset(path)
