"""Facets of hulls: their normals, the turn that puts one down, and the tilt to tip over its edge."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.geometric.scene.convex import hull_of
from tamp.geometric.stability.facets import facet_normals, rotation_to_down, tipping_angle
from tests.geometric.making import cuboid

SQUARE = np.array([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]])
_NUMBER = st.floats(-1.0, 1.0)


def test_a_box_has_six_facets_largest_first() -> None:
    vertices, faces = hull_of(cuboid((0.1, 0.2, 0.4)))
    normals = facet_normals(vertices, faces.astype(np.int64))
    axes = [int(np.argmax(np.abs(normal))) for normal in normals]
    assert axes == [0, 0, 1, 1, 2, 2]  # 0.08, 0.04 and 0.02 square metres
    assert sorted(round(float(normal.sum())) for normal in normals) == [-1, -1, -1, 1, 1, 1]


def test_triangles_of_no_area_have_no_normal() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], dtype=float)
    normals = facet_normals(vertices, np.array([[0, 1, 3], [0, 1, 2]]))
    assert np.array(normals) == pytest.approx(np.array([[0.0, 0.0, 1.0]]))


@given(_NUMBER, _NUMBER, _NUMBER)
def test_the_turn_brings_the_normal_down_by_the_shortest_way(x: float, y: float, z: float) -> None:
    length = math.sqrt(x * x + y * y + z * z)
    if length < 0.1:
        return
    normal = np.array([x, y, z]) / length
    R = rotation_to_down(normal)

    assert np.allclose(R @ R.T, np.eye(3), atol=1e-7) and np.linalg.det(R) == pytest.approx(1.0)
    assert np.allclose(R @ normal, [0.0, 0.0, -1.0], atol=1e-7)
    # A rotation's angle is acos((trace - 1) / 2); the shortest is the angle between the directions.
    angle = math.acos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    assert angle == pytest.approx(math.acos(np.clip(-normal[2], -1, 1)), abs=1e-5)


def test_down_stays_and_up_turns_over() -> None:
    assert (rotation_to_down(np.array([0.0, 0.0, -1.0])) == np.eye(3)).all()
    over = rotation_to_down(np.array([0.0, 0.0, 1.0]))
    assert (over @ [0.0, 0.0, 1.0] == [0.0, 0.0, -1.0]).all() and np.linalg.det(
        over
    ) == pytest.approx(1.0)


def test_a_cube_tips_at_45_degrees_and_a_flat_box_later() -> None:
    assert tipping_angle(SQUARE, np.zeros(2), 0.1) == pytest.approx(math.radians(45))
    assert tipping_angle(SQUARE, np.zeros(2), 0.1 / math.sqrt(3)) == pytest.approx(math.radians(60))


def test_the_nearest_edge_counts_and_beyond_it_nothing_holds() -> None:
    for centre in (
        (0.07, 0.02),
        (-0.07, 0.02),
        (0.02, 0.07),
        (0.02, -0.07),
    ):  # 3 cm from each side in turn
        assert tipping_angle(SQUARE, np.array(centre), 0.03) == pytest.approx(math.radians(45))
    assert tipping_angle(SQUARE, np.array([0.1, 0.0]), 0.2) == pytest.approx(0.0)
    assert tipping_angle(SQUARE, np.array([0.13, 0.0]), 0.03) == pytest.approx(-math.radians(45))


def test_a_centre_on_the_ground_cannot_tip() -> None:
    assert tipping_angle(SQUARE, np.zeros(2), 0.0) == pytest.approx(math.pi / 2, abs=1e-4)
