"""The geometry of a form, and that a scaled one is the same in another unit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.body_geometry import DIRECTIONS, FEW, BodyGeometry, geometry_of, sphere
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere
from tests.grounding.forms import box

L_SHAPE = (Part(Box((0.1, 0.1, 0.3))), Part(Box((0.3, 0.1, 0.1)), Pose((0.2, 0.0, -0.1))))


def test_a_box_in_figures() -> None:
    form = box(0.2, 0.4, 0.6)
    assert form.corners.tolist() == [[-0.1, -0.2, -0.3], [0.1, 0.2, 0.3]]
    assert form.radius == pytest.approx(math.sqrt(0.01 + 0.04 + 0.09))
    assert form.centre_of_mass == pytest.approx([0, 0, 0], abs=1e-12)
    assert len(form.vertices) == len(form.outer) == 8
    # Steadiest first: on its largest side, 0.4 x 0.6 m, its centre is lowest.
    assert [round(face.extent, 6) for face in form.faces] == [0.2, 0.2, 0.4, 0.4, 0.6, 0.6]


def test_parts_are_forms_of_their_own() -> None:
    form = geometry_of(L_SHAPE)
    assert [piece.corners[1].tolist() for piece in form.pieces] == [
        pytest.approx([0.05, 0.05, 0.15]),
        pytest.approx([0.35, 0.05, -0.05]),
    ]
    assert form.piece_boxes.shape == (2, 2, 3)
    # 3 litres about the origin and 3 about (0.2, 0, -0.1).
    assert form.centre_of_mass == pytest.approx([0.1, 0.0, -0.05])


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_scaled_form_is_what_its_scaled_parts_would_be(factor: float) -> None:
    form = geometry_of(L_SHAPE)
    scaled, anew = form.scaled(factor), BodyGeometry(form.scaled(factor).parts)
    for name in (
        "corners",
        "vertices",
        "outer",
        "outer_box",
        "radius",
        "centre_of_mass",
        "piece_boxes",
    ):
        assert getattr(scaled, name) == pytest.approx(getattr(anew, name)), name
    assert len(scaled.faces) == len(anew.faces)
    for one, other in zip(scaled.faces, anew.faces, strict=True):
        assert (one.height, one.extent, one.angle) == pytest.approx(
            (other.height, other.extent, other.angle)
        )
        assert one.outline == pytest.approx(other.outline) and one.centre == pytest.approx(
            other.centre
        )


def test_scaling_again_starts_from_the_unit() -> None:
    form = geometry_of(L_SHAPE)
    assert form.scaled(1.0) is form
    twice = form.scaled(2.0).scaled(3.0)
    assert twice.scale == pytest.approx(6.0) and twice.unit is form
    assert twice.corners == pytest.approx(6.0 * form.corners)


def test_few_vertices_stand_for_a_round_form_and_nearly_reach_as_far() -> None:
    form = geometry_of((Part(Sphere(0.1)), Part(Cylinder(0.1, 0.3))))
    assert len(form.vertices) <= DIRECTIONS and len(form.outer) <= FEW + 6 < len(form.vertices)
    asked = sphere(500)
    reach = (form.vertices @ asked.T).max(axis=0)
    few = (form.outer @ asked.T).max(axis=0)
    assert (few <= reach + 1e-12).all() and (few > 0.9 * reach).all()


def test_the_same_parts_are_the_same_form() -> None:
    assert geometry_of(L_SHAPE) is geometry_of(L_SHAPE)


def test_directions_are_even() -> None:
    some = sphere(200)
    assert np.linalg.norm(some, axis=1) == pytest.approx(np.ones(200))
    assert np.abs(some.mean(axis=0)).max() < 0.01
    assert (some.T @ some / 200) == pytest.approx(np.eye(3) / 3, abs=0.01)
