"""A scene as MuJoCo's model: friction by products, masks, masses, names that MuJoCo takes for itself."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Sphere
from tamp.simulation import mujoco_model
from tamp.simulation.mujoco_model import (
    DEFAULT_FRICTION,
    FELT,
    ROBOT,
    add_body,
    add_floor,
    add_pairs,
    body_name,
    is_link,
    link_body,
    new_model,
    owner_of,
    pose_of,
    wxyz,
)
from tests.simulation.scenes import body, cube_hull, scene_of

PANDA = ROBOTS["panda_mobile"]()


def compiled(*bodies: Body, robot: Robot | None = None, plane: bool = True) -> Any:
    """The model of these bodies on a floor; those that can move are free."""
    model = new_model(robot)
    add_floor(model, scene_of(*bodies), plane=plane)
    for one in bodies:
        add_body(model, one, free=one.movable, placed=not one.movable)
    add_pairs(model)
    return model.compile("the scene")


def box(name: str, friction: float = DEFAULT_FRICTION, *, movable: bool = True) -> Body:
    return replace(body(name, Part(Box((0.1, 0.2, 0.3))), movable=movable), friction=friction)


def pairs_of(model: Any) -> dict[frozenset[str], float]:
    """Friction of the pairs that have an entry of their own, by owners."""
    return {
        frozenset(owner_of(model.geom(int(geom)).name) for geom in (first, second)): friction[0]
        for first, second, friction in zip(
            model.pair_geom1, model.pair_geom2, model.pair_friction, strict=True
        )
    }


def test_pairs_of_unlike_friction_have_their_product_and_likes_their_square() -> None:
    model = compiled(box("a", 0.8), box("b", 0.8), box("c", 0.3), box("wall", 0.9, movable=False))
    assert model.geom("body:a/0").friction[0] == pytest.approx(0.64)
    assert pairs_of(model) == pytest.approx(
        {
            frozenset({"a", "c"}): 0.24,
            frozenset({"b", "c"}): 0.24,
            frozenset({"a", "wall"}): 0.72,
            frozenset({"b", "wall"}): 0.72,
            frozenset({"c", "wall"}): 0.27,
            frozenset({"a", "floor"}): 0.4,
            frozenset({"b", "floor"}): 0.4,
            frozenset({"c", "floor"}): 0.15,
        }
    )  # wall and floor never move


def test_links_have_the_friction_of_their_file_and_feel_bodies_but_not_each_other() -> None:
    model = compiled(box("a", 0.8), robot=PANDA)
    pairs = pairs_of(model)
    links = {link.name for link in PANDA.links}
    assert not any(pair <= links for pair in pairs)
    assert frozenset({"a", PANDA.hand}) in pairs
    geoms = [model.geom(number) for number in range(model.ngeom)]
    assert {
        (int(one.contype[0]), int(one.conaffinity[0])) for one in geoms if is_link(one.name)
    } == {ROBOT}
    assert {
        (int(one.contype[0]), int(one.conaffinity[0])) for one in geoms if not is_link(one.name)
    } == {FELT}


def test_a_body_that_falls_has_its_mass_and_the_inertia_of_its_parts() -> None:
    placed = replace(
        body("a", Part(Box((0.1, 0.2, 0.3))), at=(1.0, 2.0, 3.0)),
        mass=1.2,
        center_of_mass=(0, 0, 0.05),
    )
    model = compiled(placed, box("wall", movable=False))
    made = model.body("body:a")
    assert made.mass[0] == 1.2 and made.pos.tolist() == [1.0, 2.0, 3.0]
    assert made.ipos == pytest.approx([0.0, 0.0, 0.05])
    # Solid boxes: m (b^2 + c^2) / 12.
    assert sorted(made.inertia) == pytest.approx(sorted([0.1 * 0.13, 0.1 * 0.10, 0.1 * 0.05]))
    assert model.njnt == 1 and model.body("body:wall").mocapid[0] == 0


@pytest.mark.parametrize(
    ("part", "kind", "size", "condim"),
    [
        (Part(Box((0.1, 0.2, 0.3))), "mjGEOM_BOX", [0.05, 0.1, 0.15], 4),
        (Part(Cylinder(0.1, 0.4)), "mjGEOM_CYLINDER", [0.1, 0.2, 0.0], 6),
        (Part(Sphere(0.1)), "mjGEOM_SPHERE", [0.1, 0.0, 0.0], 6),
        (Part(cube_hull(0.2)), "mjGEOM_MESH", [0.1, 0.1, 0.1], 4),
    ],
)
def test_shapes_are_told_by_halves_and_round_ones_roll(
    part: Part, kind: str, size: list[float], condim: int
) -> None:
    model = compiled(body("a", replace(part, pose=Pose((0.0, 0.0, 0.7)))))
    geom = model.geom("body:a/0")
    assert geom.type[0] == int(getattr(mujoco_model.load_mujoco().mjtGeom, kind))
    assert geom.size == pytest.approx(size) and geom.pos == pytest.approx([0.0, 0.0, 0.7])
    assert geom.condim[0] == condim


@pytest.mark.parametrize("plane", [True, False])
def test_the_floors_top_is_at_zero(plane: bool) -> None:
    floor = compiled(box("a"), plane=plane).geom("floor/0")
    body_z = -0.5 if not plane else 0.0  # a plate is a metre thick
    assert floor.size[:2] == pytest.approx([53.0, 53.0])
    model = compiled(box("a"), plane=plane)
    assert model.body("floor").pos[2] == body_z
    assert plane or floor.size[2] == 0.5


def test_a_base_whose_name_is_taken_is_called_otherwise_in_the_model_alone() -> None:
    for name in ("world", "floor"):
        renamed = replace(
            PANDA,
            base=name,
            links=tuple(
                replace(one, name=name) if one.name == PANDA.base else one for one in PANDA.links
            ),
        )
        model = compiled(box("a"), robot=renamed)
        assert model.body(f"link:{name}").id > 0
        assert name in {owner_of(model.geom(number).name) for number in range(model.ngeom)}


def test_names_tell_links_bodies_and_the_floor_apart() -> None:
    assert [link_body(name) for name in ("hand", "world", "floor")] == [
        "hand",
        "link:world",
        "link:floor",
    ]
    geoms = [f"{body_name('hand')}/0", "hand/2", "link:floor/0", "floor/0", "body:a/b/1"]
    assert [owner_of(one) for one in geoms] == ["hand", "hand", "floor", "floor", "a/b"]
    assert [is_link(one) for one in geoms] == [False, True, True, False, False]


def test_quaternions_have_their_real_part_first() -> None:
    assert wxyz((0.1, 0.2, 0.3, 0.9)) == [0.9, 0.1, 0.2, 0.3]
    half = math.sqrt(0.5)
    T = pose_of(np.array([1.0, 2.0, 3.0]), np.array([half, 0.0, 0.0, half]))
    assert pytest.approx(np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])) == T


def test_what_mujoco_refuses_is_said_in_one_line_with_another_engine() -> None:
    nothing = replace(box("a"), mass=-1.0)
    with pytest.raises(InputError, match=r"MuJoCo refuses the scene: [^\n]*$") as said:
        compiled(nothing)
    assert "--engine pybullet" in said.value.remedy
