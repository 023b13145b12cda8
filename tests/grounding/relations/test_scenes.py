"""Generated scenes of a demonstration's kind: bodies of other sizes, on the furniture, apart."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding.body_geometry import geometry_of
from grounding.relation_scene import Placed
from grounding.relations.demonstration_file import Demonstration, demonstrations_of
from grounding.relations.demonstration_text import BodyEntry
from grounding.relations.scenes import (
    AIR,
    EXAMPLES,
    DemonstratedBodies,
    _owner,
    _resized,
    examples_of,
    loaded,
    made,
    otherwise,
    read_examples,
)
from grounding.separation import Obstacles, separations
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tests.grounding.relations.shown import write_demos

BODIES = {
    "desk": BodyEntry(
        {"furniture": "table", "size": [0.35, 0.3, 0.7]}, Pose.from_xyz_yaw(1.0, 0, 0, 0)
    ),
    "shelf": BodyEntry(
        {"furniture": "table", "size": [0.5, 0.4, 0.4]}, Pose.from_xyz_yaw(-1.0, 0, 0, 0)
    ),
    "cup": BodyEntry({"box": [0.06, 0.06, 0.1]}, Pose.from_xyz_yaw(1.0, 0.1, 0.751, 0.5)),
    "plate": BodyEntry({"box": [0.12, 0.1, 0.02]}, Pose.from_xyz_yaw(1.1, -0.08, 0.711, 0)),
    "other": BodyEntry({"box": [0.05, 0.05, 0.05]}, Pose.from_xyz_yaw(-1.0, 0, 0.426, 0)),
}
EXAMPLE = DemonstratedBodies(("cup", "plate"), BODIES)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ({"box": [0.1, 0.2, 0.3]}, {"box": [0.2, 0.1, 0.9]}),
        ({"furniture": "table", "size": [1, 1, 1]}, {"furniture": "table", "size": [2, 0.5, 3]}),
        (
            {"cylinder": {"radius": 0.04, "height": 0.1}},
            {"cylinder": {"radius": 0.08, "height": 0.2}},
        ),
        (
            {"capsule": {"radius": 0.04, "height": 0.1}, "colour": "red"},
            {"capsule": {"radius": 0.08, "height": 0.2}, "colour": "red"},
        ),
        ({"sphere": 0.05}, {"sphere": 0.1}),
        ({"mesh": "bowl.obj"}, {"mesh": "bowl.obj", "scale": 2.0}),
        ({"mesh": "bowl.obj", "scale": "0.5"}, {"mesh": "bowl.obj", "scale": 1.0}),
        ({"mesh": "bowl.obj", "scale": [1, 2, 1]}, {"mesh": "bowl.obj", "scale": [2, 1, 3]}),
        (
            {"box": [1, 1, 1], "surfaces": {"top": {"size": [1, 1]}}},
            {"box": [1, 1, 1], "surfaces": {"top": {"size": [1, 1]}}},
        ),
        ({"box": [1, 1, 1], "cavities": {}}, {"box": [1, 1, 1], "cavities": {}}),
    ],
    ids=lambda one: next(iter(one)),
)
def test_each_kind_of_shape_gets_another_size(
    shape: dict[str, Any], expected: dict[str, Any]
) -> None:
    before = repr(shape)
    assert _resized(shape, np.array([2.0, 0.5, 3.0])) == expected
    assert repr(shape) == before


def test_the_furniture_is_what_the_second_argument_stands_on() -> None:
    scene = loaded(BODIES, ("cup", "plate"))
    assert _owner(scene, ("cup", "plate")) == "desk"
    assert _owner(scene, ("cup", "other")) == "shelf"
    assert _owner(scene, ("cup", "shelf")) == "shelf"
    assert _owner(scene, ("other",)) == "shelf"
    lying = {"can": BodyEntry({"box": [0.1, 0.1, 0.1]}, Pose((2.0, 2.0, 0.051)))}
    assert _owner(loaded({**BODIES, **lying}, ("can",)), ("can",)) is None


@pytest.mark.parametrize("seed", range(6))
def test_a_scene_has_the_arguments_apart_on_furniture_of_another_size(seed: int) -> None:
    bodies = made(EXAMPLE, np.random.default_rng(seed))
    assert {*bodies} == {"desk", "cup", "plate"}
    assert bodies["desk"].shape["size"] != BODIES["desk"].shape["size"]
    scene = loaded(bodies, EXAMPLE.arguments)
    desk = scene.surfaces["desk"]
    T_desk_world = scene.world_pose(desk).inverse()
    for name in EXAMPLE.arguments:
        x, y, _ = (T_desk_world @ scene.bodies[name].pose).position
        assert abs(x) <= 0.4 * desk.size[0] and abs(y) <= 0.4 * desk.size[1]
        assert scene.bodies[name].support == "desk"

    cup, plate = (scene.bodies[name] for name in EXAMPLE.arguments)
    around = Obstacles([Placed(geometry_of(plate.parts), plate.pose.matrix)])
    form = geometry_of(cup.parts)
    assert separations(form, cup.pose.matrix[None], around).min() > AIR - 0.003  # what it is set by


def test_the_same_seed_makes_the_same_scene() -> None:
    one, same, other = (made(EXAMPLE, np.random.default_rng(seed)) for seed in (3, 3, 4))
    assert one == same and one["cup"].pose != other["cup"].pose


def test_examples_are_those_that_hold_and_not_too_many(tmp_path: Path) -> None:
    shown = list(demonstrations_of("left_of", [write_demos(tmp_path, good=20, bad=2)]))
    found = examples_of(shown)
    assert len(found) == EXAMPLES and all(one.arguments == ("cup", "plate") for one in found)
    at = [one.bodies["cup"].pose.position for one in found]
    wanted = [one.scene.bodies["cup"].pose.position for one in shown if one.holds][:16:2]
    assert at == pytest.approx(np.array(wanted), abs=2e-3)
    assert len(examples_of(shown[-2:])) == 0
    assert len(examples_of([shown[0], shown[-1]])) == 1


def test_examples_go_through_a_card() -> None:
    (again,) = read_examples([EXAMPLE.plain()])
    assert again.arguments == EXAMPLE.arguments and {*again.bodies} == {*BODIES}
    assert all(again.bodies[name].pose == entry.pose for name, entry in BODIES.items())
    assert again.bodies["cup"].shape == BODIES["cup"].shape


@pytest.mark.parametrize(
    "card",
    [
        None,
        [None],
        [{"arguments": ["cup"]}],
        [{"arguments": ["cup"], "bodies": {"cup": [{"box": [1, 1, 1]}]}}],
        [{"arguments": ["cup"], "bodies": {"cup": [{"box": [1, 1, 1]}, [0, 0, 0]]}}],
        [{"arguments": ["cup"], "bodies": {"cup": [{"box": [1, 1, 1]}, [0] * 6 + ["a"]]}}],
        [{"arguments": ["cup"], "bodies": ["cup"]}],
    ],
)
def test_a_card_without_examples_is_refused(card: object) -> None:
    with pytest.raises(InputError, match="'examples' are not those of a relation"):
        read_examples(card)


def test_another_pose_is_moved_or_turned_or_on_another_side() -> None:
    start, kinds = Pose.from_xyz_yaw(1.0, 2.0, 0.5, 0.3), set[str]()
    for seed in range(30):
        found = otherwise(start, np.random.default_rng(seed))
        moved = np.linalg.norm(np.subtract(found.position, start.position))
        upright = found.rotation[2, 2]
        same = np.allclose(found.rotation, start.rotation)
        assert found.position[2] == 0.5
        if moved > 0.0:
            assert 0.03 <= moved <= 0.2 and same
            kinds.add("moved")
        else:
            assert not same
            kinds.add("turned" if upright == pytest.approx(1.0) else "on another side")
    assert kinds == {"moved", "turned", "on another side"}


def test_a_demonstration_of_a_file_says_where_it_is(demos: list[Demonstration]) -> None:
    (one,) = examples_of(demos[:1])
    assert {*one.bodies} == {"table", "plate", "cup"}
