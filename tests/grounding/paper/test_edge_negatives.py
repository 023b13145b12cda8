"""Samples close by the limits: each is as far over its limit as it says, and no farther."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from grounding.body_geometry import BodyGeometry
from grounding.demonstrations import KINDS, POSITIVE
from grounding.paper.edge_negatives import (
    BESIDE_M,
    EDGE_KINDS,
    EDGE_NEGATIVES,
    GRAZE_M,
    POKE_M,
    beside,
    grazing,
    is_with,
    poking_out,
)
from grounding.paper.scenes import PaperScenes, paper_supports
from grounding.relation_scene import Placed
from grounding.scenes import SampledScene
from grounding.separation import Obstacles, separations
from tamp.geometric.scene.pose import Array, Pose
from tests.grounding.forms import box

SAMPLES = 8


@pytest.fixture(scope="module")
def scenes() -> dict[str, PaperScenes]:
    return {relation: PaperScenes(relation, "train") for relation in KINDS}


def samples(scenes: PaperScenes, kind: str) -> list[tuple[SampledScene, Array]]:
    """Crowded scenes, each with a sample of this kind."""
    rng, found = np.random.default_rng(0), list[tuple[SampledScene, Array]]()
    while len(found) < SAMPLES:
        scene = scenes.draw(rng)
        pose = EDGE_NEGATIVES[kind](scenes, scene, rng)
        if pose is not None:
            found.append((scene, pose))
    return found


@pytest.mark.parametrize("relation", KINDS)
def test_shares_are_of_all_and_half_of_the_samples_hold(relation: str) -> None:
    shares = EDGE_KINDS[relation]
    assert sum(shares.values()) == pytest.approx(1.0)
    assert {kind: shares[kind] for kind in POSITIVE} == {
        kind: KINDS[relation][kind] for kind in POSITIVE
    }
    assert {*shares} - {*KINDS[relation]} <= {*EDGE_NEGATIVES}


def test_a_body_beside_a_surface_stands_at_its_height(scenes: dict[str, PaperScenes]) -> None:
    for scene, pose in samples(scenes["on"], "beside"):
        inner = np.linalg.inv(scene.T_world_region) @ pose
        points = scene.body.vertices @ inner[:3, :3].T + inner[:3, 3]
        assert points[:, 2].min() == pytest.approx(0.0, abs=0.003)
        middle = inner[:2, :3] @ scene.body.corners.mean(axis=0) + inner[:2, 3]
        out = (np.abs(middle) - scene.support.region.size[:2] / 2).max()
        assert 0.0 < out <= BESIDE_M


@pytest.mark.parametrize("relation", KINDS)
def test_a_body_that_grazes_another_is_a_little_in_it(
    scenes: dict[str, PaperScenes], relation: str
) -> None:
    for scene, pose in samples(scenes[relation], "grazing"):
        with_it = [item for item in scene.placed[1:] if is_with(scene, item)]
        gaps = separations(scene.body, pose[None], Obstacles(with_it))
        assert ((gaps < -GRAZE_M[0]) & (gaps > -GRAZE_M[1])).any()


def test_a_body_that_pokes_out_does_so_by_one_side_at_least(
    scenes: dict[str, PaperScenes],
) -> None:
    for scene, pose in samples(scenes["inside"], "poking out"):
        inner = np.linalg.inv(scene.stand.matrix) @ pose
        corners = np.array([*product(*scene.body.corners.T)]) @ inner[:3, :3].T + inner[:3, 3]
        low, high = scene.support.region.box
        over = np.concatenate([low - corners.min(axis=0), corners.max(axis=0) - high])
        assert ((over >= POKE_M[0] - 1e-9) & (over <= POKE_M[1] + 1e-9)).any()


def test_nothing_is_sampled_where_nothing_rests_or_nothing_is_in_the_way(
    scenes: dict[str, PaperScenes], monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(0)
    empty = scenes["inside"].draw(rng, crowded=False)
    assert grazing(scenes["inside"], empty, rng) is None
    monkeypatch.setattr(PaperScenes, "resting", lambda *_: np.zeros((0, 4, 4)))
    for kind in (beside, grazing, poking_out):
        assert kind(scenes["inside"], empty, rng) is None


def scene_with(at: Array) -> tuple[SampledScene, Placed]:
    """A body somewhere about a support that is turned."""
    support = next(iter(paper_supports("on", "train").values()))
    form, T_world_stand = BodyGeometry(support.parts), Pose.from_xyz_yaw(1.0, -0.5, 0.0, 0.7).matrix
    region = T_world_stand @ support.region.matrix
    other = Placed(box(0.05, 0.05, 0.05), region @ Pose(tuple(at)).matrix)
    scene = SampledScene(
        ("stand", "cube"), (1.0, 1.0), Placed(form, T_world_stand), support, other.form,
        (("cube", 1.0, other),), Obstacles([other]), region,
    )  # fmt: skip
    return scene, other


def test_a_body_over_the_region_is_on_it() -> None:
    half = next(iter(paper_supports("on", "train").values())).region.size[:2] / 2
    for x, y, z, over in (
        (0.0, 0.0, 0.025, True), (0.99, -0.99, 0.025, True), (1.01, 0.0, 0.025, False),
        (0.0, -1.01, 0.025, False), (0.0, 0.0, -0.3, False),
    ):  # fmt: skip
        assert is_with(*scene_with(np.array([x * half[0], y * half[1], z]))) is over
