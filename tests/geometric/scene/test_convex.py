"""Hulls are closed, outward and convex, simplified ones to half a millimetre, flat ones a millimetre thick."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.geometric.scene.convex import HULL_TOLERANCE_M, directions, hull_of, simplified, thickened
from tests.geometric.making import cuboid


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Of a closed surface, by the divergence theorem: positive when its faces look outward."""
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def edges(faces: np.ndarray) -> set[tuple[int, int]]:
    return {(int(face[i]), int(face[(i + 1) % 3])) for face in faces for i in range(3)}


def test_the_hull_of_a_box_is_the_box() -> None:
    inside = np.random.default_rng(0).uniform(-0.5, 0.5, (50, 3)) * [0.2, 0.3, 0.4]
    vertices, faces = hull_of(np.concatenate([inside, cuboid((0.2, 0.3, 0.4))]))
    assert len(vertices) == 8 and len(faces) == 12
    assert volume(vertices, faces) == pytest.approx(0.2 * 0.3 * 0.4)


@given(st.integers(0, 10_000))
@settings(max_examples=25)
def test_a_hull_is_closed_outward_and_holds_every_point(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(30, 3))
    vertices, faces = hull_of(points)
    once = edges(faces)
    assert len(once) == 3 * len(faces)  # no edge twice the same way
    assert once == {(b, a) for a, b in once}  # each once the other way: closed, and turned alike
    for a, b, c in vertices[faces]:
        normal = np.cross(b - a, c - a)
        assert ((points - a) @ normal <= 1e-9).all()


def test_a_flat_square_becomes_a_plate_of_a_millimetre() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    vertices, faces = hull_of(square)
    assert np.ptp(vertices[:, 2]) == pytest.approx(0.001)
    assert volume(vertices, faces) == pytest.approx(0.001)
    assert thickened(square).mean(axis=0) == pytest.approx([0.5, 0.5, 0.0])


def test_what_is_thicker_than_a_millimetre_stays_as_it_is() -> None:
    points = cuboid((1.0, 1.0, 0.0011))
    assert thickened(points) is points


def test_points_on_a_line_have_no_hull() -> None:
    with pytest.raises(ValueError, match="all its points lie on one line"):
        hull_of(np.outer(np.arange(5.0), [1.0, 2.0, 3.0]))


def test_a_simplified_ball_has_fewer_corners_and_lies_within_half_a_millimetre() -> None:
    ball = 0.05 * directions(3000)
    fewer = simplified(ball)
    assert len(fewer) < 0.2 * len(ball)
    assert {tuple(point) for point in fewer.tolist()} <= {tuple(point) for point in ball.tolist()}

    vertices, faces = hull_of(fewer)
    a, b, c = vertices[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    beyond = ball @ normals.T - np.einsum("ij,ij->i", a, normals)
    assert beyond.max() <= HULL_TOLERANCE_M + 1e-12


def test_a_simplified_box_keeps_its_corners() -> None:
    assert len(simplified(cuboid((0.3, 0.2, 0.1)))) == 8


def test_directions_are_unit_vectors_that_leave_no_large_hole() -> None:
    some = directions(100)
    assert len(some) == 106
    assert np.linalg.norm(some, axis=1) == pytest.approx(np.ones(106))
    asked = np.random.default_rng(1).normal(size=(2000, 3))
    asked /= np.linalg.norm(asked, axis=1, keepdims=True)
    nearest = np.arccos(np.clip((asked @ some.T).max(axis=1), -1.0, 1.0))
    assert nearest.max() < math.radians(20.0)  # 100 caps of 11.5 degrees have the sphere's area
