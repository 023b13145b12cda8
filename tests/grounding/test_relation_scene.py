"""The situation that a grounding sees: the region in its support's frame, the boxes, and what is near."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relation_scene import SURROUNDINGS, gap, near, region_of, relation_scene_of
from tamp.errors import InputError
from tamp.geometric.scene.scene import Box, Cylinder
from tests.geometric.making import body, crate, scene, table
from tests.grounding.forms import at, box, can, turned

CUP = body("cup", Cylinder(0.04, 0.1), (0.2, 0.1, 0.551))
SCENE = scene(table(), crate(), CUP, body("book", Box((0.2, 0.1, 0.05)), (-0.3, 0.0, 0.526)))


def test_a_surface_has_its_support_below_it_down_to_the_foot() -> None:
    found = relation_scene_of(SCENE, ("cup", "table"))
    region = found.region
    assert not region.hollow and region.size.tolist() == [1.0, 0.6, math.inf]
    assert found.T_world_region[:3, 3] == pytest.approx([0.0, 0.0, 0.5])
    # In the table's frame, which is in its middle: from its foot at -0.25 to its top at 0.25.
    assert region.box == pytest.approx(np.array([[-0.5, -0.3, -0.25], [0.5, 0.3, 0.25]]))


def test_the_only_cavity_of_a_container_has_all_of_it_around() -> None:
    found = relation_scene_of(SCENE, ("cup", "crate_inside"))
    assert found.region.hollow and found.region.size.tolist() == [0.4, 0.4, 0.3]
    assert found.region.box == pytest.approx(np.array([[-0.2, -0.2, -0.01], [0.2, 0.2, 0.01]]))


def test_of_several_cavities_each_has_its_own_box() -> None:
    double = crate()
    second = type(double.cavities[0])("upper", "crate", double.cavities[0].pose, (0.4, 0.2, 0.25))
    region = region_of(
        type(double)(**{**vars(double), "cavities": (double.cavities[0], second)}), second
    )
    assert region.box == pytest.approx(np.array([[-0.2, -0.1, 0.01], [0.2, 0.1, 0.26]]))


def test_others_are_those_within_a_metre_of_an_argument() -> None:
    support, cup = at(box(1, 1, 1), 0, 0, 0), at(can(0.05, 0.1), 3.0, 0, 0)
    region = relation_scene_of(SCENE, ("cup", "table")).region
    others = [
        at(box(0.2, 0.2, 0.2), x, 0, 0)
        for x in (0.5 + SURROUNDINGS, 0.7 + SURROUNDINGS, 2.0 + SURROUNDINGS, 9)
    ]
    found = near(support, region, cup, others)
    # The second is 1.1 m from the support, and 1.15 m from the cup; the third is at the cup.
    assert found.others == (others[0], others[2])


def test_the_two_arguments_are_none_of_the_others() -> None:
    found = relation_scene_of(SCENE, ("cup", "table"))
    assert [other.form.corners[1].tolist() for other in found.others] == [
        [0.1, 0.05, 0.025]
    ]  # the book; the crate is far


def test_the_body_may_be_seen_elsewhere() -> None:
    elsewhere = at(can(0.04, 0.1), 5.0, 5.0, 0.05).matrix
    assert (relation_scene_of(SCENE, ("cup", "table"), elsewhere).body.matrix == elsewhere).all()
    assert relation_scene_of(SCENE, ("cup", "table")).body.matrix[:3, 3] == pytest.approx(
        [0.2, 0.1, 0.551]
    )


@pytest.mark.parametrize(
    "arguments", [("table", "cup"), ("cup", "crate"), ("ghost", "table"), ("cup", "ghost")]
)
def test_other_arguments_are_refused(arguments: tuple[str, str]) -> None:
    with pytest.raises(
        InputError, match=f"takes a body, and a surface or container: not .{', '.join(arguments)}."
    ):
        relation_scene_of(SCENE, arguments)


@pytest.mark.parametrize("form", [box(0.2, 0.4, 0.6), can(0.1, 0.3)], ids=["box", "can"])
def test_a_placed_forms_box_holds_its_vertices_closely(form: object) -> None:
    placed = type(at(form, 0, 0, 0))(form, turned(0.3, -0.7, 1.1, (1, 2, 3)))  # type: ignore[arg-type]
    points = placed.form.vertices @ placed.matrix[:3, :3].T + placed.matrix[:3, 3]
    assert placed.box == pytest.approx(np.stack([points.min(axis=0), points.max(axis=0)]))


def test_the_gap_of_boxes_is_a_straight_distance() -> None:
    unit = np.array([[0.0, 0, 0], [1, 1, 1]])
    assert gap(unit, unit + 0.5) == 0.0
    assert gap(unit, unit + np.array([1.0, 0, 0])) == 0.0
    away = unit + np.array([4.0, 5.0, 0])
    assert gap(unit, away) == gap(away, unit) == pytest.approx(5.0)
