"""One entry of `bodies:` read into parts and properties, or refused with what is wrong with it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.bodies import COLOURS, UnplacedBody
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Sphere
from tests.geometric.making import drafts


def read(folder: Path, text: str) -> UnplacedBody:
    (draft,) = drafts(folder, f"thing: {text}").values()
    return draft


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ("{box: [0.1, 0.2, 0.3]}", Box((0.1, 0.2, 0.3))),
        ("{cylinder: {radius: 0.03, height: 0.1}}", Cylinder(0.03, 0.1)),
        ("{sphere: 0.05}", Sphere(0.05)),
    ],
)
def test_primitives_have_one_part_at_the_bodys_frame(
    tmp_path: Path, text: str, shape: object
) -> None:
    body = read(tmp_path, text).body
    assert [part.shape for part in body.parts] == [shape]
    assert body.parts[0].pose == Pose() and body.pose == Pose()
    assert (body.name, body.movable, body.surfaces) == ("thing", True, ())


def test_a_capsule_is_as_high_as_it_says_round_ends_included(tmp_path: Path) -> None:
    low, high = bounds(read(tmp_path, "{capsule: {radius: 0.02, height: 0.1}}").body.parts, Pose())
    assert high - low == pytest.approx([0.04, 0.04, 0.1])


def test_defaults_and_what_the_problem_says_of_mass_friction_and_colour(tmp_path: Path) -> None:
    plain = read(tmp_path, "{sphere: 0.05}").body
    assert (plain.mass, plain.friction, plain.colour) == (0.2, 0.5, (0.6, 0.6, 0.6, 1.0))
    given = read(tmp_path, "{sphere: 0.05, mass: 1.5, friction: 0, colour: red}").body
    assert (given.mass, given.friction, given.colour) == (1.5, 0.0, (*COLOURS["red"], 1.0))
    assert read(tmp_path, "{sphere: 0.05, colour: [0.1, 0.2, 0.3]}").body.colour == (
        0.1,
        0.2,
        0.3,
        1.0,
    )
    assert read(tmp_path, "{sphere: 0.05, colour: [0.1, 0.2, 0.3, 0.4]}").body.colour == (
        0.1,
        0.2,
        0.3,
        0.4,
    )


def test_a_fixed_block_has_its_top_as_a_surface_and_a_movable_or_narrow_one_none(
    tmp_path: Path,
) -> None:
    (top,) = read(tmp_path, "{box: [0.5, 0.4, 0.3], fixed: true}").body.surfaces
    assert (top.name, top.body, top.size) == ("thing", "thing", pytest.approx((0.5, 0.4)))
    assert top.pose.position == pytest.approx((0.0, 0.0, 0.15))
    assert read(tmp_path, "{box: [0.5, 0.4, 0.3]}").body.surfaces == ()
    assert read(tmp_path, "{box: [0.5, 0.04, 0.3], fixed: true}").body.surfaces == ()
    assert read(tmp_path, "{box: [0.5, 0.4, 0.3], fixed: true, surfaces: {}}").body.surfaces == ()


def test_the_top_is_the_side_that_is_up_as_it_stands(tmp_path: Path) -> None:
    (top,) = read(
        tmp_path, "{box: [0.5, 0.4, 0.3], fixed: true, rpy: [90 deg, 0, 0]}"
    ).body.surfaces
    # Rolled by a quarter its +y looks up: the top is 0.2 m along y of its own frame.
    assert top.pose.position == pytest.approx((0.0, 0.2, 0.0), abs=1e-12)
    assert sorted(top.size) == pytest.approx([0.3, 0.5])


def test_what_places_it_is_kept_for_later(tmp_path: Path) -> None:
    draft = read(tmp_path, "{sphere: 0.05, on: table, at: [0, 0], mass: 1, yaw: 0}")
    assert list(draft.entries) == ["on", "at", "yaw"]
    assert draft.node.name == "thing" and draft.mesh is None


def test_furniture_is_fixed_and_wooden_with_named_places(tmp_path: Path) -> None:
    body = read(tmp_path, "{furniture: cupboard, size: [0.9, 0.4, 1.0], compartments: [2, 1]}").body
    assert not body.movable and body.colour == (*COLOURS["wood"], 1.0)
    low, high = bounds(body.parts, Pose())
    assert low == pytest.approx([-0.45, -0.2, 0.0]) and high == pytest.approx([0.45, 0.2, 1.0])
    assert len(body.cavities) == 2 and math.isclose(
        body.cavities[0].size[0], body.cavities[1].size[0]
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{}", "thing: it has no shape. Choices: box, cylinder, sphere, capsule, mesh, furniture"),
        ("{bx: [1, 1, 1]}", "thing: it has no shape.*Did you mean 'box'?"),
        ("{box: [1, 1, 1], sphere: 1}", "'box' and 'sphere' both give a shape: keep one"),
        ("{box: [1, 1, 1], scale: 2}", "unknown key 'scale'"),
        ("{box: [1, 1, 0]}", r"thing.box\[2\]: must be positive, found 0"),
        (
            "{box: [6, 1, 1]}",
            "thing.box: it is 6 m large, too large to be moved. Lengths are metres",
        ),
        ("{box: [200000, 1, 1], fixed: true}", "it is 200000 m large. Lengths are metres"),
        ("{box: [1, 1, 0.000001]}", "it is 1e-06 m thin"),
        ("{cylinder: {radius: 1}}", "thing.cylinder: 'height' is missing"),
        (
            "{capsule: {radius: 0.05, height: 0.1}}",
            "a capsule of radius 0.05 is higher than 0.1.*it is a sphere",
        ),
        ("{sphere: 0.05, mass: 0}", "thing.mass: must be positive"),
        ("{sphere: 0.05, friction: -1}", "thing.friction: must be at least 0, found -1"),
        ("{sphere: 0.05, friction: 101}", "thing.friction: must be at most 100, found 101"),
        ("{sphere: 0.05, colour: rad}", "unknown colour 'rad'.*Did you mean 'red'?"),
        ("{sphere: 0.05, colour: [1, 0]}", "expected a name, .* found 2 numbers"),
        ("{sphere: 0.05, colour: [2, 0, 0]}", r"colour\[0\]: must be at most 1, found 2"),
        ("{furniture: table}", "'size' is missing. size: .width, depth, height. in metres"),
        ("{furniture: tabel, size: [1, 1, 1]}", "unknown furniture 'tabel'.*Did you mean 'table'?"),
        (
            "{furniture: table, size: [1, 1, 1], fixed: false}",
            "thing.fixed: furniture is fixed, but for open_box",
        ),
        (
            "{furniture: cupboard, size: [1, 1, 1], compartments: 101}",
            "must be at most 100, found 101",
        ),
        ("{mesh: gone.obj}", "thing.mesh: no mesh file 'gone.obj'"),
        ("{mesh: gone.obj, scale: 0}", "thing.scale: must be positive, found 0"),
        (
            "{mesh: gone.obj, scale: [1, 0, 1]}",
            "thing.scale: a factor of 0 leaves nothing of the mesh",
        ),
    ],
)
def test_mistakes_are_said_at_their_line(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as told:
        read(tmp_path, text)
    assert told.value.line == 1


@pytest.mark.parametrize("name", ["9lives", "two words", "-x"])
def test_a_bodys_name_is_one_of_pddl(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match=f"'{name}' is not a name"):
        drafts(tmp_path, f"{name}: {{sphere: 0.1}}")
