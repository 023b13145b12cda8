"""Turned proposals: the scene is shown turned, and what is proposed is turned back."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.paper.features import BB, BoxFeatures, FeatureObservation, poses_of
from grounding.paper.numpy_networks import NOISE, Network
from grounding.paper.runtime import TRIES, TURNED, PaperModel, generated, unit
from grounding.paper.turned_proposals import turned_features, turned_proposals
from grounding.relation_scene import Placed, RelationScene
from grounding.weights import Weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array, Pose
from tests.grounding.paper.untrained import untrained


class Angle:
    """A source of one angle."""

    def __init__(self, yaw: float) -> None:
        self.yaw = yaw

    def uniform(self, low: float, high: float, count: int) -> Array:
        return np.full(count, self.yaw)


def turned_about(situation: RelationScene, turn: Array) -> RelationScene:
    """The whole situation turned by T_world_world, shape (4, 4)."""
    support, body, *others = (
        Placed(item.form, turn @ item.matrix)
        for item in (situation.support, situation.body, *situation.others)
    )
    return RelationScene(support, situation.region, body, tuple(others))


@pytest.mark.parametrize("residual", [False, True])
@pytest.mark.parametrize("around", [False, True])
def test_a_proposal_is_that_of_the_turned_scene_turned_back(
    data: Dataset, residual: bool, around: bool
) -> None:
    network = Network(untrained(BB, around)[1], "generator")
    situation, features = data[2].situation, BoxFeatures(residual)
    turn = Pose.from_xyz_yaw(0.3, -0.2, 0.1, 0.6).matrix
    noise = np.random.default_rng(0).standard_normal((3, NOISE), dtype=np.float32)
    seen = features.observe(turned_about(situation, turn), around)
    positions, turns = generated(network, seen, noise)
    expected = np.linalg.inv(turn) @ poses_of(
        seen, positions.astype(float), unit(turns.astype(float))
    )
    found = turned_proposals(
        network, features.observe(situation, around), residual, noise, Angle(0.6)
    )  # pyright: ignore[reportArgumentType]
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_turned_features_keep_heights_and_sizes(seen: list[FeatureObservation]) -> None:
    bodies = np.concatenate([seen[2].arguments, seen[2].others])
    turns = np.stack([Pose.from_xyz_yaw(0, 0, 0, yaw).matrix[:3, :3] for yaw in (0.0, 1.1)])
    found = turned_features(bodies, turns)
    np.testing.assert_allclose(found[0], bodies, atol=1e-9)
    same = [2, 5, 8, *range(13, 19)]
    np.testing.assert_allclose(found[1][:, same], bodies[:, same], atol=1e-9)
    assert np.abs(found[1] - bodies).max() > 0.05


def test_the_weights_say_that_proposals_are_turned(data: Dataset) -> None:
    arrays, situation = untrained(BB, True)[1], data[2].situation
    several = {TRIES: np.full(1, 8.0, np.float32)}
    spreads = []
    for extra in ({}, {TURNED: np.ones(1, np.float32)}):
        poses = PaperModel(Weights(arrays | extra, {})).propose(
            situation, 40, np.random.default_rng(0)
        )
        spreads.append(poses[:, :3, 3].std(axis=0)[:2].mean())
    assert poses.shape == (40, 4, 4) and spreads[1] > 1.5 * spreads[0]
    model = PaperModel(Weights(arrays | several | extra, {}))
    once, again = (model.propose(situation, 2, np.random.default_rng(3)) for _ in range(2))
    assert np.array_equal(once, again) and once.shape == (2, 4, 4)


def test_codes_of_clouds_are_not_turned(encoder: Weights) -> None:
    arrays = untrained(135, False)[1] | {f"encoder.{k}": v for k, v in encoder.arrays.items()}
    with pytest.raises(InputError, match=r"'choice.turned' is for models on boxes"):
        PaperModel(Weights(arrays | {TURNED: np.ones(1, np.float32)}, {}))
