"""The paper's layout, its oracle, and the ceiling of what sees no surroundings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.demonstrations import KINDS, POSITIVE
from grounding.generate import Job, generate
from grounding.oracles import ItemOf, Verdict, drop_verdicts, paper_oracle
from grounding.paper.blind_ceiling import BlindModel, CornerModel, blind_ceiling
from grounding.paper.clouds import cloud
from grounding.paper.features import BoxFeatures, CloudFeatures, completed, poses_of
from grounding.paper.oracle import in_place, own_box, published_oracle
from grounding.paper.rotations import quaternions, rotations
from grounding.relation_scene import Placed, RelationScene
from tamp.errors import InputError
from tamp.simulation.engines import open_drops


@pytest.fixture(scope="module", params=["on", "inside"])
def data(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    job = Job(request.param, "test", 40, layout="paper")
    return generate(job, tmp_path_factory.mktemp("paper") / "small.npz", workers=1)


def test_labels_are_what_physics_says_and_kinds_have_their_shares(data: Dataset) -> None:
    items = ItemOf()
    with open_drops() as drops:
        for example in data:
            pose = example.situation.body.matrix[None]
            holds = drop_verdicts(example.situation, pose, drops, items)[0] is Verdict.HOLDS
            assert holds == example.holds == (example.kind in POSITIVE), example.kind
    assert data.card["layout"] == "paper"
    assert set(data.kinds) == set(KINDS[data.relation])


def test_bodies_stand_upright_on_the_papers_supports(data: Dataset) -> None:
    upright = [
        abs(example.situation.body.matrix[2, 2]) > 0.999 for example in data if example.holds
    ]
    assert np.mean(upright) >= (0.8 if data.relation == "on" else 0.4)
    names = {"table", "chest"} if data.relation == "on" else {"square_box", "long_box"}
    assert set(data.card["supports"]) == names


def test_inside_is_labelled_by_the_published_test_and_half_turned_by_nothing(data: Dataset) -> None:
    if data.relation == "on":
        return
    unturned: list[bool] = []
    for example in data:
        pose = example.situation.body.matrix
        if example.kind != "colliding":
            assert in_place(example.situation, pose[None])[0] == example.holds, example.kind
        if example.holds:
            unturned.append(bool(np.abs(pose[:3, :3] - np.eye(3)).max() < 0.05))
    assert 0.25 <= np.mean(unturned) <= 0.75


def test_half_of_the_scenes_have_nothing_else_on_the_support(data: Dataset) -> None:
    alone = 0
    for example in data:
        situation = example.situation
        half = situation.region.size[:2] / 2
        inner = [np.linalg.inv(situation.T_world_region) @ o.matrix[:, 3] for o in situation.others]
        alone += not any((np.abs(p[:2]) <= half).all() and 0 < p[2] < 1.0 for p in inner)
    assert 0.3 * len(data) <= alone <= 0.7 * len(data)


def test_the_published_oracle_is_the_stricter_one_on_what_rests(data: Dataset) -> None:
    ours = theirs = 0
    for example in data:
        pose = example.situation.body.matrix[None]
        judged = published_oracle(example.situation, pose)[0]
        ours += paper_oracle(example.situation, pose)[0]
        theirs += judged
        if not example.holds and example.kind != "colliding" and example.kind != "sticking out":
            assert not judged, example.kind
    assert 0 < theirs <= ours


def test_the_tolerance_is_the_published_oracles_own(data: Dataset) -> None:
    example = next(example for example in data if example.kind == "alone")
    situation = replace(example.situation, others=())
    pose = situation.body.matrix[None].copy()
    low = own_box(situation.body.form).corners[0]
    assert low == pytest.approx(situation.body.form.corners[0])
    pose[0, 2, 3] += 0.045
    if data.relation == "on":
        assert not published_oracle(situation, pose)[0]
        assert published_oracle(situation, pose, near=0.06)[0]


def test_an_ideal_generator_fails_by_the_surroundings_alone(data: Dataset) -> None:
    rng = np.random.default_rng(0)
    model = BlindModel("upright", 0.5)
    seen = with_none = 0.0
    for example in data:
        situation = example.situation
        poses = model.propose(situation, 4, rng)
        seen += paper_oracle(situation, poses).mean()
        with_none += paper_oracle(replace(situation, others=()), poses).mean()
    assert seen < with_none
    if data.relation == "on":
        assert with_none == len(data)  # nothing but other bodies makes it fail
    assert np.isnan(model.classify(data[0].situation, poses)).all()
    ceiling = blind_ceiling(data, range(len(data)), 4, 0)
    assert 0.4 < ceiling.published <= ceiling.mca < 1.0
    assert ceiling.corner > ceiling.published


def test_who_goes_to_a_corner_fails_by_what_is_there_or_does_not_fit(data: Dataset) -> None:
    rng = np.random.default_rng(0)
    for example in data:
        situation = replace(example.situation, others=())
        region, form = situation.region, situation.body.form
        poses = CornerModel().propose(situation, 8, rng)
        inner = np.linalg.inv(situation.T_world_region) @ poses
        low, high = form.corners
        middles = inner[:, :2, 3] + (inner[:, :3, :3] @ (low + high) / 2)[:, :2]
        assert len(np.unique(np.sign(middles), axis=0)) > 1  # more than one of the corners
        edges, box = np.sort(high - low), np.sort(np.ptp(region.box[:, :2], axis=0))
        height = region.box[1, 2] - region.matrix[2, 3]
        room = min(height - edges[0], *(box - edges[1:])) if region.hollow else np.inf
        if abs(room) > 0.01:
            assert published_oracle(situation, poses).all() == (room > 0)


@pytest.mark.parametrize("features", [BoxFeatures(), BoxFeatures(residual=True)])
def test_completed_features_are_those_of_the_pose_that_comes_out(
    data: Dataset, features: BoxFeatures
) -> None:
    rng = np.random.default_rng(1)
    for example in list(data)[:5]:
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


def test_clouds_are_shown_unturned_and_turned_from_where_they_were(data: Dataset) -> None:
    features = CloudFeatures(lambda points: np.resize(points.std(axis=0), 128))
    situation: RelationScene = data[0].situation
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


def test_an_unknown_layout_is_named(tmp_path) -> None:
    with pytest.raises(InputError, match="unknown layout 'papre'"):
        generate(Job("on", "train", 4, layout="papre"), tmp_path / "x.npz", workers=1)


def test_a_code_about_the_middle_is_of_what_the_position_is_the_middle_of(data: Dataset) -> None:
    """Read a table's height off its code: half of it above the middle, whatever the centroid is."""

    def top(points: np.ndarray) -> np.ndarray:
        return np.full(128, points[:, 2].max())

    situation: RelationScene = data[0].situation
    points = cloud(situation.support.form) @ situation.support.matrix[:3, :3].T
    half = np.ptp(points[:, 2]) / 2
    about_middle = CloudFeatures(top, about_middle=True).observe(situation).arguments[0]
    assert about_middle[7:] == pytest.approx(half)
    about_centroid = CloudFeatures(top).observe(situation).arguments[0]
    assert about_centroid[7:] == pytest.approx(points[:, 2].max() - points[:, 2].mean())
    assert about_middle[:7] == pytest.approx(about_centroid[:7])
