"""Scenes turned, mirrored and scaled for training: features are exactly those of the moved bodies."""

from __future__ import annotations

import math

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.paper.feature_table import FeatureTable
from grounding.paper.features import BoxFeatures, FeatureObservation, box_features
from grounding.paper.random_streams import random_stream
from grounding.paper.rotations import quaternions, rotations
from grounding.paper.trainer_options import TrainerOptions
from grounding.paper.training import features_of
from grounding.paper.training_scenes import MOST_SCALED, TrainingScenes, varied
from tamp.geometric.scene.pose import Array


@pytest.fixture(scope="module")
def table(data: Dataset) -> FeatureTable:
    return features_of(data, "gnn-bb", None, lambda _: None)


def moved(bodies: Array, linear: Array, scale: float) -> Array:
    """The features of bodies (k, 19) moved by an orthogonal matrix (3, 3) and scaled, one by one."""
    mirror = np.diag([np.linalg.det(linear), 1.0, 1.0])
    turned = linear @ rotations(bodies[:, 9:13]) @ mirror
    own = bodies[:, 13:].reshape(-1, 2, 3) @ mirror * scale
    own = np.stack([own.min(axis=1), own.max(axis=1)], axis=1)
    centres = bodies[:, :3] @ linear.T * scale
    return box_features(centres, quaternions(turned), own)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_features_are_those_of_the_moved_scene(seen: list[FeatureObservation], side: float) -> None:
    c, s = math.cos(0.7), math.sin(0.7)
    linear = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.diag([side, 1.0, 1.0])
    tilted = box_features(
        np.array([[0.1, -0.2, 0.3]]),
        np.array([[0.5, -0.1, 0.7, 0.5]]),
        np.array([[[-0.1, -0.3, 0.0], [0.2, 0.1, 0.4]]]),
    )
    for one in (*(np.concatenate([o.arguments, o.others]) for o in seen), tilted):
        found = varied(
            torch.from_numpy(one).float()[None], torch.full((1, 1), 0.7), torch.full((1, 1), side),
            torch.full((1, 1), 1.25),
        )[0].numpy()  # fmt: skip
        np.testing.assert_allclose(found, moved(one, linear, 1.25), atol=1e-6)


def test_an_empty_place_stays_empty() -> None:
    gone = varied(torch.zeros(1, 2, 19), *(torch.full((1, 1), v) for v in (0.7, -1.0, 1.2)))
    assert not gone.any()


def options(**some: bool) -> TrainerOptions:
    return TrainerOptions(**some)  # pyright: ignore[reportArgumentType]


def test_scenes_stay_as_they_are_without_the_departures(table: FeatureTable) -> None:
    scenes, rows = TrainingScenes(table, True, options()), torch.tensor([[3, 1], [2, 0]])
    scenes.vary([random_stream(240, seed, 5, 0) for seed in (0, 1)])
    batch = scenes.batch(rows)
    assert np.array_equal(batch.arguments.numpy(), table.arguments[rows.numpy()])
    assert np.array_equal(batch.others.numpy(), table.others[rows.numpy()])


def test_each_model_has_its_own_turns_whoever_else_is_trained(table: FeatureTable) -> None:
    rows = torch.arange(240).expand(2, 240)
    scenes = TrainingScenes(table, True, options(turned=True))
    scenes.vary([random_stream(240, seed, 5, 0) for seed in (0, 1)])
    both = scenes.batch(rows)
    assert not torch.equal(both.arguments[0], both.arguments[1])
    scenes.vary([random_stream(240, 1, 5, 0)])
    alone = scenes.batch(rows[:1])
    assert torch.equal(alone.arguments[0], both.arguments[1])
    assert torch.equal(alone.others[0], both.others[1])
    plain = scenes.as_they_are(rows[:1])
    assert np.array_equal(plain.arguments[0].numpy(), table.arguments)

    heights, sizes = (2, 21), slice(32, 38)
    for column in heights:
        assert torch.equal(alone.arguments[0, :, column], plain.arguments[0, :, column])
    spans = [
        (one.arguments[0, :, sizes][:, 3:] - one.arguments[0, :, sizes][:, :3]).numpy()
        for one in (alone, plain)
    ]
    np.testing.assert_allclose(*spans, atol=1e-7)
    mirrored = (alone.arguments[0, :, 34] != plain.arguments[0, :, 34]).any()
    assert not mirrored  # these boxes are the same from both sides


def test_scaled_scenes_are_scaled_only(table: FeatureTable) -> None:
    scenes = TrainingScenes(table, False, options(scaled=True))
    scenes.vary([random_stream(240, 0, 5, 0)])
    found = scenes.arguments(torch.arange(240)[None])[0].numpy()
    ratio = found[:, 16:19] / table.arguments[:, 16:19]  # the own box of argument 0
    assert 1 / MOST_SCALED <= ratio.min() < 0.8 and 1.25 < ratio.max() <= MOST_SCALED
    lengths = [*range(9), *range(13, 28), *range(32, 38)]
    np.testing.assert_allclose(
        found[:, lengths], table.arguments[:, lengths] * ratio[:, :1], atol=1e-5
    )


def test_argument_1_is_shown_unturned_after_the_scene_was_turned(data: Dataset) -> None:
    plain = features_of(data, "gnn-bb", None, lambda _: None)
    shown = features_of(data, "gnn-bb", None, lambda _: None, residual=True)
    rows = torch.arange(240)[None]
    scenes = TrainingScenes(plain, True, options(turned=True, residual=True))
    np.testing.assert_allclose(scenes.batch(rows).arguments[0].numpy(), shown.arguments, atol=1e-6)
    scenes.vary([random_stream(240, 0, 5, 0)])
    found = scenes.arguments(rows)[0].numpy()[:, BoxFeatures.size :]
    assert (found[:, 9:13] == [0.0, 0.0, 0.0, 1.0]).all()
    np.testing.assert_allclose(found[:, 16:19], found[:, 6:9] - found[:, :3], atol=1e-6)
