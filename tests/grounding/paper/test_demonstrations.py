"""Each type of sample is where its name says, in scenes as the paper lays them out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from grounding.body_geometry import BodyGeometry
from grounding.demonstrations import KINDS, POSITIVE
from grounding.paper.demonstrations import CROWDED, SHIFT_M, PaperDemonstrations, _over
from grounding.paper.oracle import in_place
from grounding.paper.scenes import AIR_HEIGHTS_M, FLOOR_AREA_M, paper_supports
from grounding.relation_scene import Placed, near
from grounding.scenes import LabelledScene, SampledScene
from grounding.separation import Obstacles
from tamp.geometric.scene.pose import Array, Pose
from tamp.simulation.drops import Drops
from tests.grounding.forms import box

SCENES = 2
"""Of each kind."""

Made = Callable[[str, str], list[tuple[LabelledScene, BodyGeometry]]]


@pytest.fixture(scope="module")
def made(drops: Drops) -> Made:
    """Scenes of a relation and a kind, each with the form of what was placed."""
    makers = {name: PaperDemonstrations(name, "train", drops) for name in KINDS}
    kept: dict[tuple[str, str], list[tuple[LabelledScene, BodyGeometry]]] = {}

    def scenes(relation: str, kind: str) -> list[tuple[LabelledScene, BodyGeometry]]:
        if (relation, kind) not in kept:
            maker, rng = makers[relation], np.random.default_rng(0)
            found = [maker.make(kind, rng) for _ in range(SCENES)]
            forms = maker._scenes._objects
            kept[relation, kind] = [
                (one, forms[one.names[1]].scaled(one.scales[1])) for one in found
            ]
        return kept[relation, kind]

    return scenes


def lowest(scene: LabelledScene, form: BodyGeometry) -> float:
    """How high the body's lowest point is above the region, metres."""
    region = scene.poses[0] @ scene.support.region.matrix
    points = form.vertices @ scene.poses[1][:3, :3].T + scene.poses[1][:3, 3]
    return float(points[:, 2].min() - region[2, 3])


@pytest.mark.parametrize("relation", KINDS)
def test_a_kind_holds_or_does_not(made: Made, relation: str) -> None:
    for kind in KINDS[relation]:
        for scene, _ in made(relation, kind):
            assert scene.kind == kind and scene.holds is (kind in POSITIVE) and scene.feasible


@pytest.mark.parametrize("kind", POSITIVE)
def test_what_is_on_a_support_came_to_rest_at_its_height(made: Made, kind: str) -> None:
    for scene, form in made("on", kind):
        assert lowest(scene, form) == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize(
    ("kind", "sign", "least", "most"),
    [
        ("above", 1, *SHIFT_M["on"]),
        ("sunken", -1, *SHIFT_M["on"]),
        ("in the middle", -1, 0.45, 0.65),
    ],
)
def test_what_is_moved_from_rest_is_moved_by_so_much(
    made: Made, kind: str, sign: int, least: float, most: float
) -> None:
    for scene, form in made("on", kind):
        assert least - 0.005 <= sign * lowest(scene, form) <= most + 0.005


@pytest.mark.parametrize("relation", KINDS)
def test_what_is_afloat_is_in_the_air_and_what_is_on_the_ground_lies_there(
    made: Made, relation: str
) -> None:
    for scene, _ in made(relation, "afloat"):
        assert (np.abs(scene.poses[1][:2, 3]) <= FLOOR_AREA_M).all()
        assert AIR_HEIGHTS_M[0] <= scene.poses[1][2, 3] <= AIR_HEIGHTS_M[1]
    for scene, form in made(relation, "on the ground"):
        points = form.vertices @ scene.poses[1][:3, :3].T + scene.poses[1][:3, 3]
        assert abs(points[:, 2].min()) < 0.005


@pytest.mark.parametrize("relation", KINDS)
def test_only_crowded_scenes_have_bodies_on_their_support(made: Made, relation: str) -> None:
    for kind in KINDS[relation]:
        if kind == "sticking out":
            continue  # half of them are
        for scene, _ in made(relation, kind):
            region = scene.poses[0] @ scene.support.region.matrix
            local = [np.linalg.inv(region) @ pose[:, 3] for pose in scene.poses[3:]]
            half = scene.support.region.size[:2] / 2
            there = [(np.abs(at[:2]) <= half).all() and at[2] > 0.0 for at in local]
            assert any(there) <= (kind in CROWDED)
            assert kind != "colliding" or any(there)


def test_inside_is_labelled_by_where_the_box_is_but_for_contacts(made: Made) -> None:
    for kind in KINDS["inside"]:
        for scene, form in made("inside", kind):
            stand = Placed(
                BodyGeometry(scene.support.parts).scaled(scene.scales[0]), scene.poses[0]
            )
            situation = near(stand, scene.support.region, Placed(form, scene.poses[1]), [])
            there = bool(in_place(situation, scene.poses[1][None])[0])
            assert kind == "colliding" or there is scene.holds


@pytest.mark.parametrize("split", ["train", "test"])
def test_only_of_test_scenes_somebody_asks_whether_they_can_be_solved(
    split: str, drops: Drops, monkeypatch: pytest.MonkeyPatch
) -> None:
    maker, asked = PaperDemonstrations("on", split, drops), list[int]()
    monkeypatch.setattr(maker, "_feasible", lambda scene, rng: bool(asked.append(1)))
    rng = np.random.default_rng(0)
    assert maker.make("alone", rng).feasible and asked == []
    assert maker.make("afloat", rng).feasible is (split == "train")
    assert len(asked) == (split == "test")


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
        assert _over(*scene_with(np.array([x * half[0], y * half[1], z]))) is over
