"""Each type of sample in household scenes is where its name says, and holds or does not as physics has it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grounding import demonstrations as module
from grounding.body_geometry import BodyGeometry
from grounding.demonstrations import KINDS, POSITIVE, DemonstrationGenerator, sticking_out
from grounding.oracles import Verdict
from grounding.relation_scene import Placed
from grounding.scenes import LabelledScene, SampledScene
from grounding.separation import Obstacles, separations
from grounding.supports import FurnitureSupport
from tamp.geometric.scene.pose import Array
from tamp.simulation.drops import Drops
from tests.grounding.forms import TOP, at, box, on_table

Made = Callable[[str, str], tuple[LabelledScene, BodyGeometry]]


@pytest.fixture(scope="module")
def made(drops: Drops) -> Made:
    """One scene of a relation and a kind, with the form of what was placed."""
    makers = {name: DemonstrationGenerator(name, "train", drops) for name in KINDS}
    kept: dict[tuple[str, str], tuple[LabelledScene, BodyGeometry]] = {}

    def scene(relation: str, kind: str) -> tuple[LabelledScene, BodyGeometry]:
        if (relation, kind) not in kept:
            found = makers[relation].make(kind, np.random.default_rng(0))
            form = makers[relation]._scenes._form(found.names[1], found.scales[1])
            kept[relation, kind] = found, form
        return kept[relation, kind]

    return scene


def points(scene: LabelledScene, form: BodyGeometry) -> Array:
    """The body's corners in the region's frame."""
    T_region_body = np.linalg.inv(scene.poses[0] @ scene.support.region.matrix) @ scene.poses[1]
    return form.vertices @ T_region_body[:3, :3].T + T_region_body[:3, 3]


@pytest.mark.parametrize("relation", KINDS)
def test_a_kind_holds_or_does_not(made: Made, relation: str) -> None:
    for kind in KINDS[relation]:
        scene, _ = made(relation, kind)
        assert scene.kind == kind and scene.holds is (kind in POSITIVE) and scene.feasible


@pytest.mark.parametrize("relation", KINDS)
def test_what_was_let_go_came_to_rest_at_the_regions_height(made: Made, relation: str) -> None:
    for kind in POSITIVE:
        assert points(*made(relation, kind))[:, 2].min() == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("relation", KINDS)
@pytest.mark.parametrize(
    ("kind", "least", "most"), [("above", 0.035, 0.25), ("sunken", -0.12, -0.005)]
)
def test_what_is_moved_from_rest_is_moved_by_so_much(
    made: Made, relation: str, kind: str, least: float, most: float
) -> None:
    assert least - 0.003 <= points(*made(relation, kind))[:, 2].min() <= most + 0.003


@pytest.mark.parametrize("relation", KINDS)
def test_what_lies_on_the_ground_or_on_the_other_support_lies_there(
    made: Made, relation: str
) -> None:
    scene, form = made(relation, "on the ground")
    assert Placed(form, scene.poses[1]).box[0, 2] == pytest.approx(0.0, abs=0.005)
    scene, form = made(relation, "on another support")
    away = np.abs(points(scene, form)[:, :2]).max(axis=0)
    assert (away > scene.support.region.size[:2] / 2).any()


def test_what_is_in_the_middle_is_in_the_middle_of_the_support(made: Made) -> None:
    scene, _ = made("on", "in the middle")
    stand = Placed(BodyGeometry(scene.support.parts).scaled(scene.scales[0]), scene.poses[0])
    low, high = stand.box
    assert (np.abs(scene.poses[1][:3, 3] - (low + high) / 2) <= 0.151 * (high - low)).all()


@pytest.mark.parametrize("split", ["train", "test"])
def test_only_of_test_scenes_somebody_asks_whether_they_can_be_solved(
    split: str, drops: Drops, monkeypatch: pytest.MonkeyPatch
) -> None:
    maker, asked = DemonstrationGenerator("on", split, drops), list[int]()
    monkeypatch.setattr(maker, "_feasible", lambda scene, rng: bool(asked.append(1)))
    rng = np.random.default_rng(0)
    assert maker.make("alone", rng).feasible and asked == []
    assert maker.make("afloat", rng).feasible is (split == "train")
    assert len(asked) == (split == "test")


def hollow(size: tuple[float, float, float], *others: Placed, height: float = 0.1) -> SampledScene:
    """A body for a cavity of 0.8 x 0.6 m and `height` above a table."""
    body = box(*size)
    situation = on_table(at(body, 0.0, 0.0, 1.0), height=height)
    support = FurnitureSupport(situation.support.form.parts, replace(situation.region, hollow=True))
    return SampledScene(
        ("box", "brick"), (1.0, 1.0), situation.support, support, body,
        tuple(("cube", 1.0, one) for one in others), Obstacles(others), situation.T_world_region,
    )  # fmt: skip


def test_what_sticks_out_is_across_one_side_by_at_most_ten_centimetres() -> None:
    rng, beyond = np.random.default_rng(0), []
    for _ in range(40):
        low, high = Placed(box(0.08, 0.06, 0.05), sticking_out(hollow((0.08, 0.06, 0.05)), rng)).box
        assert low[2] == pytest.approx(TOP, abs=0.002)
        beyond.append(np.concatenate([-low[:2] - [0.4, 0.3], high[:2] - [0.4, 0.3]]).max())
    assert min(beyond) >= 0.004 and max(beyond) <= 0.101 and np.ptp(beyond) > 0.05


def test_what_is_too_tall_may_stand_in_it_too() -> None:
    """0.2 m tall in 0.1 m: half of the time it stands there, its top out."""
    rng, size = np.random.default_rng(0), (0.05, 0.05, 0.2)
    tall = 0
    for _ in range(60):
        low, high = Placed(box(*size), sticking_out(hollow(size), rng)).box
        stands = high[2] - low[2] > 0.19 and (np.abs([low, high])[:, :2] < [0.4, 0.3]).all()
        tall += stands
    assert 15 <= tall <= 45


def test_what_collides_is_in_one_of_the_others(drops: Drops) -> None:
    """Cubes cover most of the region: where the body comes to rest among them it is in one of them."""
    cubes = [at(box(0.3, 0.5, 0.1), x, 0.0, TOP + 0.05) for x in (-0.2, 0.2)]
    maker, rng = DemonstrationGenerator("on", "train", drops), np.random.default_rng(0)
    scene = hollow((0.1, 0.1, 0.05), *cubes, height=np.inf)
    pose = maker._colliding(scene, rng)
    assert pose is not None
    assert (separations(scene.body, pose[None], scene.obstacles) < -0.002).any()
    assert maker._colliding(hollow((0.1, 0.1, 0.05), height=np.inf), rng) is None
    away = at(box(0.1, 0.1, 0.1), 3.0, 0.0, TOP)
    assert maker._colliding(hollow((0.1, 0.1, 0.05), away, height=np.inf), rng) is None


@pytest.mark.parametrize("kind", ["alone", "afloat"])
def test_what_physics_contradicts_is_drawn_anew(
    kind: str, drops: Drops, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether it is to hold or not: what the first two verdicts say is the opposite."""
    opposite, so = (Verdict.TIPS, Verdict.HOLDS)[:: 1 if kind in POSITIVE else -1]
    verdicts = [opposite, opposite, so]
    monkeypatch.setattr(module, "drop_verdicts", lambda *_: [verdicts.pop(0)])
    scene = DemonstrationGenerator("on", "train", drops).make(kind, np.random.default_rng(0))
    assert verdicts == [] and scene.holds is (kind in POSITIVE)
