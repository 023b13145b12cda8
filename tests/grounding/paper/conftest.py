"""Boxes on a table: a data set that is made by hand in a moment."""

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.generate import Job, generate
from grounding.paper.features import BoxFeatures, FeatureObservation
from grounding.weights import Weights
from tamp.geometric.scene.scene import Box, Part

TEMPLATES = {"table": (0.8, 0.6, 0.4), "brick": (0.1, 0.06, 0.04), "cube": (0.06, 0.06, 0.06)}


def boxes_on_a_table(count: int, seed: int = 0) -> Dataset:
    """Half stand on the table, half float or are sunken by 8 cm or more; up to 3 others lie around."""
    rng = np.random.default_rng(seed)
    holds = np.arange(count) % 2 == 0
    body = np.full((count, 5), -1, np.int16)
    body[:, 0] = 0
    body[:, 1] = rng.integers(1, 3, count)
    others = rng.integers(0, 4, count)
    for row in range(3):
        body[others > row, 2 + row] = 1 + row % 2
    scale = np.ones((count, 5))
    scale[:, 1] = rng.uniform(0.8, 1.2, count)
    pose = np.tile(np.eye(4), (count, 5, 1, 1))
    pose[:, 0, :3, 3] = rng.uniform(-1, 1, (count, 3))
    yaw = rng.uniform(-np.pi, np.pi, (count, 5))
    pose[:, 1:, 0, 0] = pose[:, 1:, 1, 1] = np.cos(yaw[:, 1:])
    pose[:, 1:, 1, 0] = np.sin(yaw[:, 1:])
    pose[:, 1:, 0, 1] = -np.sin(yaw[:, 1:])
    height = np.array([size[2] for size in TEMPLATES.values()])[body[:, 1]] * scale[:, 1] / 2
    wrong = np.where(rng.random(count) < 0.5, -1, 1) * rng.uniform(0.08, 0.3, count)
    top = pose[:, 0, :3, 3] + [0, 0, 0.2]
    pose[:, 1, :3, 3] = top + np.column_stack(
        [rng.uniform(-0.2, 0.2, (count, 2)), height + np.where(holds, 0, wrong)]
    )
    pose[:, 2:, :3, 3] = top[:, None] + rng.uniform(-0.3, 0.3, (count, 3, 3))
    region = np.tile(np.eye(4), (count, 1, 1))
    region[:, 2, 3] = 0.2
    arrays = {
        "holds": holds,
        "kind": (~holds).astype(int),
        "body": body,
        "scale": scale,
        "pose": pose,
        "hollow": np.zeros(count, bool),
        "region": region,
        "size": np.tile([0.8, 0.6, np.inf], (count, 1)),
        "box": np.tile([[-0.4, -0.3, -0.2], [0.4, 0.3, 0.2]], (count, 1, 1)),
    }
    templates = {name: (Part(Box(size)),) for name, size in TEMPLATES.items()}
    return Dataset(arrays, templates, ["standing", "shifted"], {"relation": "on"})


@pytest.fixture(scope="session")
def data() -> Dataset:
    return boxes_on_a_table(240)


@pytest.fixture(scope="session")
def seen(data: Dataset) -> list[FeatureObservation]:
    """Three scenes of boxes, with none, one and three others around."""
    observations = [BoxFeatures().observe(example.situation) for example in data]
    chosen = [next(o for o in observations if len(o.others) == count) for count in (0, 1, 3)]
    assert len(chosen) == 3
    return chosen


@pytest.fixture(scope="session", params=["on", "inside"])
def laid_out(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    """Scenes of each relation as the paper lays them out."""
    job = Job(request.param, "test", 40, layout="paper")
    return generate(job, tmp_path_factory.mktemp("paper") / "small.npz", workers=1)


@pytest.fixture(scope="session")
def tree(data: Dataset) -> Weights:
    """A tree of all the boxes."""
    from grounding.paper.tree_training import train_tree

    return train_tree(data, "tree-bb", samples=240, seed=0)


@pytest.fixture(scope="session")
def encoder(data: Dataset) -> Weights:
    """An encoder that was hardly trained."""
    from grounding.paper.encoders import EncoderOptions, train_encoder

    few = EncoderOptions(iterations=2, batch=4, validation=4, points=64, validate_every=1)
    return Weights(train_encoder(data, "conv", "one", few)[0], {})
