"""Data sets and trained groundings in their folders, made when they are missing, shared between the figures."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from benchmarks.groundings.case import Case, on_clouds
from benchmarks.paper_ways import EDGES
from grounding.arguments import data_file
from grounding.dataset import Dataset, read_dataset
from grounding.model import RelationModel
from grounding.registry import PARAMETER_FREE, SHIPPED, load_model
from grounding.train import NETWORKS
from grounding.weights import Weights, write_weights
from tamp.errors import InputError


@dataclass(frozen=True)
class Library:
    """Where the data and the weights are, and what may be made.

    Attributes:
        data: With RELATION_train.npz and RELATION_test.npz, or those of the layout's names.
        weights: With RELATION-MODEL-SAMPLES-SEED.safetensors, and RELATION-encoder.safetensors for the clouds.
        train: Whether missing weights are trained.
        iterations: Of the paper's networks and of the encoder; None for what they usually have.
        generate: Scenes of training and test that are made where there are no data; None for an error.
        say: Told what takes a while.
        layout: Of the scenes.
    """

    data: Path
    weights: Path
    train: bool = True
    iterations: int | None = None
    generate: tuple[int, int] | None = None
    say: Callable[[str], None] = lambda line: None
    layout: str = "household"

    def scenes(self, relation: str, split: str, edges: bool = False) -> Dataset:
        """A data set.

        Raises:
            InputError: There is none, and none may be generated.
        """
        path = self.data / data_file(relation, split, self.layout, edges).name
        if not path.is_file() and self.generate is not None:
            from grounding.generate import Job, generate

            count = self.generate[split == "test"]
            self.say(f"generating {count} scenes: {path}")
            generate(Job(relation, split, count, layout=self.layout, edges=edges), path, workers=1)
        return _read(path, self.layout)

    def train_networks(self, cases: Sequence[Case]) -> None:
        """Train the paper's networks that are missing, those of the same kind as one ensemble."""
        missing: dict[tuple[str, str], dict[Path, Case]] = {}
        for case in cases if self.train else ():
            path = self._path(case)
            if case.model not in PARAMETER_FREE and case.variant.model in NETWORKS and not path.is_file():
                missing.setdefault((case.relation, case.trained), {}).setdefault(path, case)
        for same in missing.values():
            self._train_ensemble(same)

    def model(self, case: Case) -> RelationModel | None:
        """The grounding of a case; None when its weights are missing and may not be trained.

        Raises:
            InputError: There are no data to train it on.
        """
        if case.model in PARAMETER_FREE:
            return PARAMETER_FREE[case.model]()
        path = self._path(case)
        if not path.is_file():
            if not self.train:
                return None
            self._train(case, path)
        model = case.variant.model if case.model == case.trained else case.model
        return load_model(path, model)

    def _path(self, case: Case) -> Path:
        return self.weights / f"{case.weights}.safetensors"

    def _train(self, case: Case, path: Path) -> None:
        from grounding.train import TrainArgs, train

        if case.variant.model in NETWORKS:
            self._train_ensemble({path: case})
            return
        encoder = self._encoder(case.relation) if on_clouds(case.model) else None
        args = TrainArgs(samples=case.samples, seed=case.seed, encoder=encoder)
        self.say(f"training {path}")
        started = time.perf_counter()
        write_weights(path, train(self.scenes(case.relation, "train"), case.model, args))
        self.say(f"trained in {time.perf_counter() - started:.0f} s")

    def _train_ensemble(self, cases: Mapping[Path, Case]) -> None:
        """Train networks that differ in their seed and size only; the state is beside the first one."""
        from grounding.paper.training import train
        from grounding.train import ITERATIONS, encoder_of

        first, case = next(iter(cases.items()))
        variant, state = case.variant, first.with_suffix(".state")
        self.say(f"training {', '.join(path.name for path in cases)} in {first.parent}")
        started = time.perf_counter()
        found = train(
            self.scenes(case.relation, "train", EDGES in variant.departures),
            variant.model,
            variant.scheme,
            sizes=[one.samples for one in cases.values()],
            seeds=[one.seed for one in cases.values()],
            iterations=self.iterations or ITERATIONS,
            departures=variant.departures,
            encoder=encoder_of(self._encoder(case.relation)) if on_clouds(variant.model) else None,
            state=state,
            progress=self.say,
        )
        for path, weights in zip(cases, found, strict=True):
            write_weights(path, weights)
        state.unlink(missing_ok=True)
        self.say(f"trained in {time.perf_counter() - started:.0f} s")

    def _encoder(self, relation: str) -> Path:
        """The encoder's weights, trained if need be; in the paper's layout those that ship, of household scenes."""
        path = self.weights / f"{relation}-encoder.safetensors"
        if self.layout == "paper" and not path.is_file():
            return SHIPPED / f"{relation}_mlp-pc.safetensors"
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
def _read(path: Path, layout: str) -> Dataset:
    if not path.is_file():
        asked = "" if layout == "household" else f" --layout {layout}"
        asked += " --edges" if "_edges_" in path.name else ""
        relation, split = path.stem.partition("_")[0], path.stem.rpartition("_")[2]
        remedy = f"tamp-learn generate {relation}{asked} --split {split} --out {path}, or name a folder with --data"
        raise InputError("no such data set", file=path, remedy=remedy)
    return read_dataset(path)
