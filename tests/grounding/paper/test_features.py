"""Features of a body: what is seen of a situation, and the pose that features come from."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.paper.clouds import cloud
from grounding.paper.features import BoxFeatures, CloudFeatures, completed, poses_of
from grounding.paper.rotations import quaternions, rotations
from grounding.relation_scene import Placed, RelationScene


@pytest.mark.parametrize("features", [BoxFeatures(), BoxFeatures(residual=True)])
def test_completed_features_are_those_of_the_pose_that_comes_out(
    laid_out: Dataset, features: BoxFeatures
) -> None:
    rng = np.random.default_rng(1)
    for example in list(laid_out)[:5]:
        seen = features.observe(example.situation)
        turns = rng.normal(size=(3, 4))
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        positions = rng.normal(size=(3, 3))
        poses = poses_of(seen, positions, turns)
        at = features.at(seen, example.situation, poses)
        assert at[:, :3] == pytest.approx(completed(seen, positions, turns)[:, :3])
        assert poses[:, :3, :3] == pytest.approx(rotations(turns) @ seen.start)
        unmoved = poses_of(seen, seen.arguments[1:, :3], quaternions(np.eye(3)[None]))
        if features is not BoxFeatures and not np.array_equal(seen.start, np.eye(3)):
            assert unmoved[0] == pytest.approx(example.situation.body.matrix)


def test_clouds_are_shown_unturned_and_turned_from_where_they_were(laid_out: Dataset) -> None:
    features = CloudFeatures(lambda points: np.resize(points.std(axis=0), 128))
    situation: RelationScene = laid_out[0].situation
    seen = features.observe(situation)
    assert seen.arguments[:, 3:7].tolist() == [[0, 0, 0, 1]] * 2
    unmoved = poses_of(seen, seen.arguments[1:, :3], np.array([[0.0, 0.0, 0.0, 1.0]]))
    assert unmoved[0] == pytest.approx(situation.body.matrix)
    half = np.sqrt(0.5)
    turned = poses_of(seen, seen.arguments[1:, :3], np.array([[0.0, 0.0, half, half]]))
    box = Placed(situation.body.form, turned[0]).box.mean(axis=0)
    assert box == pytest.approx(seen.arguments[1, :3] + seen.origin, abs=2e-3)
    at = features.at(seen, situation, situation.body.matrix[None])
    assert at[0] == pytest.approx(seen.arguments[1])


def test_a_code_about_the_middle_is_of_what_the_position_is_the_middle_of(
    laid_out: Dataset,
) -> None:
    """Read a table's height off its code: half of it above the middle, whatever the centroid is."""

    def top(points: np.ndarray) -> np.ndarray:
        return np.full(128, points[:, 2].max())

    situation: RelationScene = laid_out[0].situation
    points = cloud(situation.support.form) @ situation.support.matrix[:3, :3].T
    half = np.ptp(points[:, 2]) / 2
    about_middle = CloudFeatures(top, about_middle=True).observe(situation).arguments[0]
    assert about_middle[7:] == pytest.approx(half)
    about_centroid = CloudFeatures(top).observe(situation).arguments[0]
    assert about_centroid[7:] == pytest.approx(points[:, 2].max() - points[:, 2].mean())
    assert about_middle[:7] == pytest.approx(about_centroid[:7])


def test_poses_there_and_back(data):
    seen = BoxFeatures().observe(data[1].situation)
    pose = data[1].situation.body.matrix[None]
    again = poses_of(seen, seen.arguments[1:, :3], quaternions(pose[:, :3, :3]))
    np.testing.assert_allclose(again, pose, atol=1e-12)


def test_clouds_that_are_turned_absolutely_have_their_centroid_and_their_turn(
    laid_out: Dataset,
) -> None:
    features = CloudFeatures(lambda points: np.resize(points.std(axis=0), 128), residual=False)
    situation: RelationScene = laid_out[0].situation
    seen = features.observe(situation)
    body = situation.body
    points = cloud(body.form) @ body.matrix[:3, :3].T + body.matrix[:3, 3]
    assert seen.arguments[1, :3] + seen.origin == pytest.approx(points.mean(axis=0))
    assert rotations(seen.arguments[1:, 3:7])[0] == pytest.approx(body.matrix[:3, :3])
    assert seen.arguments[1, 7:10] == pytest.approx(points.std(axis=0))
    again = poses_of(seen, seen.arguments[1:, :3], seen.arguments[1:, 3:7])
    assert again[0] == pytest.approx(body.matrix)
    # completed: another place and turn, the code stays
    turn = np.array([[0.0, 0.0, 0.6, 0.8]])
    found = completed(seen, np.ones((1, 3)), turn)
    assert found[0, :7].tolist() == [1.0, 1.0, 1.0, 0.0, 0.0, 0.6, 0.8]
    assert (found[0, 7:] == seen.arguments[1, 7:]).all()


def test_who_sees_no_surroundings_is_shown_none(data: Dataset) -> None:
    situation = next(one.situation for one in data if len(one.situation.others) == 3)
    assert BoxFeatures().observe(situation).others.shape == (3, 19)
    assert BoxFeatures().observe(situation, surroundings=False).others.shape == (0, 19)
