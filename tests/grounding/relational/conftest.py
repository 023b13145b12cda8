"""Small data sets, generated in physics, and groundings trained on them."""

from __future__ import annotations

import pytest

from grounding.dataset import Dataset
from grounding.generate import Job, generate
from grounding.train import TRAINERS, TrainArgs
from grounding.weights import Weights

SCENES = 120


@pytest.fixture(scope="session")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Dataset]:
    """Both relations' training scenes."""
    folder = tmp_path_factory.mktemp("scenes")
    return {
        name: generate(Job(name, "train", SCENES), folder / f"{name}.npz", workers=1)
        for name in ("on", "inside")
    }


@pytest.fixture(scope="session")
def trained(scenes: dict[str, Dataset]) -> dict[tuple[str, str], Weights]:
    """Relation and model to weights; `on` is learned with the ranker, `inside` from few scenes without it."""
    few = {"on": SCENES, "inside": 40}
    return {
        (relation, model): TRAINERS[model](scenes[relation], TrainArgs(samples=few[relation]))
        for relation in few
        for model in ("transfer", "flow")
    }
