"""Each type of sample is where its name says, in scenes as the paper lays them out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from grounding.body_geometry import BodyGeometry
from grounding.demonstrations import KINDS, POSITIVE
from grounding.paper.demonstrations import (
    CROWDED,
    HALF_CROWDED,
    SHIFT_M,
    TOUCHING,
    PaperDemonstrations,
)
from grounding.paper.edge_negatives import EDGE_KINDS
from grounding.paper.oracle import in_place
from grounding.paper.scenes import AIR_HEIGHTS_M, FLOOR_AREA_M
from grounding.relation_scene import Placed, near
from grounding.scenes import LabelledScene
from tamp.simulation.drops import Drops

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
    for kind in {*KINDS[relation], *EDGE_KINDS[relation]}:
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
    for kind in {*KINDS[relation], *EDGE_KINDS[relation]} - {*HALF_CROWDED}:
        for scene, _ in made(relation, kind):
            region = scene.poses[0] @ scene.support.region.matrix
            local = [np.linalg.inv(region) @ pose[:, 3] for pose in scene.poses[3:]]
            half = scene.support.region.size[:2] / 2
            there = [(np.abs(at[:2]) <= half).all() and at[2] > 0.0 for at in local]
            assert any(there) <= (kind in CROWDED)
            assert kind not in TOUCHING or any(there)


def test_inside_is_labelled_by_where_the_box_is_but_for_contacts(made: Made) -> None:
    for kind in {*KINDS["inside"], *EDGE_KINDS["inside"]}:
        for scene, form in made("inside", kind):
            stand = Placed(
                BodyGeometry(scene.support.parts).scaled(scene.scales[0]), scene.poses[0]
            )
            situation = near(stand, scene.support.region, Placed(form, scene.poses[1]), [])
            there = bool(in_place(situation, scene.poses[1][None])[0])
            assert kind in TOUCHING or there is scene.holds


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
