"""Trainings on a Ray cluster of two workers, one of which is killed on the way."""

from __future__ import annotations

import os
import signal
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks import paper_variants
from benchmarks.paper_variants import Options
from benchmarks.ray_trainings import Files, Training, train_all, train_there
from grounding.dataset import write_dataset
from grounding.weights import Weights, read_weights
from tests.grounding.paper.conftest import boxes_on_a_table
from tests.needs import NEEDS_TORCH

DATA = boxes_on_a_table(40)


def killed_once(training: Training, files: Files, folder: Path) -> list[Weights]:
    """Leave a trace of every try; the first one by `both` has its process killed."""
    tries = len(list(folder.glob(f"{training.scheme}.*")))
    (folder / f"{training.scheme}.{tries}").touch()
    if training.scheme == "both" and tries == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return train_there(training, files)


@pytest.mark.slow
@NEEDS_TORCH
@pytest.mark.timeout(300)
@pytest.mark.filterwarnings("default")  # Ray's own
def test_a_killed_worker_loses_no_training_and_the_weights_are_the_same(tmp_path: Path) -> None:
    from grounding.paper.training import train  # which imports torch

    path = tmp_path / "train.npz"
    write_dataset(path, DATA)
    files = Files(path.read_bytes(), path.with_suffix(".json").read_bytes())
    trainings = [
        Training("mlp-bb", scheme, (), 40, 3, (0, 2))
        for scheme in ("discriminator", "both", "classifier")
    ]
    work = partial(killed_once, folder=tmp_path)
    found = dict(train_all(trainings, files, "local", 2, work))
    assert {*found} == {*trainings}
    tries = {one.scheme: len(list(tmp_path.glob(f"{one.scheme}.*"))) for one in trainings}
    assert tries == {"discriminator": 1, "both": 2, "classifier": 1}
    for training, trained in found.items():
        setting = {"sizes": [40, 40], "seeds": [0, 2], "iterations": 3}
        for one, other in zip(
            trained, train(DATA, "mlp-bb", training.scheme, **setting), strict=True
        ):
            assert one.card == {**other.card, "data": one.card["data"]}
            assert all(np.array_equal(one.arrays[name], other.arrays[name]) for name in one.arrays)


@pytest.mark.slow
@NEEDS_TORCH
@pytest.mark.timeout(300)
@pytest.mark.filterwarnings("default")
def test_the_benchmark_trains_there_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for split in ("train", "test"):
        write_dataset(tmp_path / f"on_paper_{split}.npz", DATA)
    monkeypatch.setattr(paper_variants, "evaluate", None)  # nothing is judged yet
    weights = tmp_path / "weights"
    options = Options("on", ("mlp-bb discriminator",), 2, 2, data=tmp_path, weights=weights)
    there = Options(**{**vars(options), "out": tmp_path / "results.jsonl", "ray": "local"})
    with pytest.raises(TypeError):
        paper_variants.main(there)
    names = [path.name for path in sorted(weights.glob("*.safetensors"))]
    assert names == [f"on_mlp-bb_discriminator_40_2_{seed}.safetensors" for seed in (0, 1)]
    assert read_weights(weights / names[1]).card["seed"] == 1
