"""Level slices of convex parts, and how far points are from them, against closed forms and fine sampling."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.geometric.scene.convex import hull_of
from tamp.geometric.stability.slices import cut, distances
from tests.geometric.making import cuboid

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def pyramid() -> tuple[np.ndarray, np.ndarray]:
    """A square of 2 m on the floor and an apex 1 m above its middle."""
    vertices, faces = hull_of(
        np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 1]], dtype=float)
    )
    return vertices, faces.astype(np.int64)


@pytest.mark.parametrize("height", [0.1, 0.5, 0.9])
def test_a_pyramids_slice_shrinks_towards_its_apex(height: float) -> None:
    corners = cut(*pyramid(), height)
    assert corners is not None
    half = 1.0 - height
    assert corners.min(axis=0) == pytest.approx([-half, -half])
    assert corners.max(axis=0) == pytest.approx([half, half])
    assert np.abs(corners).max(axis=1) == pytest.approx(np.full(len(corners), half))


@pytest.mark.parametrize("height", [-0.1, 1.0, 1.5])
def test_a_plane_beside_a_body_or_at_its_apex_cuts_nothing(height: float) -> None:
    assert cut(*pyramid(), height) is None


def test_a_box_on_its_edge_is_widest_in_the_middle() -> None:
    c = math.sqrt(0.5)
    turned = cuboid((1.0, 1.0, 1.0)) @ np.array([[1, 0, 0], [0, c, -c], [0, c, c]])
    vertices, faces = hull_of(turned)
    widths = []
    for height in (0.01, 0.3, 0.6):
        corners = cut(vertices, faces.astype(np.int64), height)
        assert corners is not None
        widths.append(float(np.ptp(corners[:, 1])))
    # A diamond of half diagonal root one half: at height h it is 2 (root one half - h) wide.
    assert widths == pytest.approx([2 * (c - 0.01), 2 * (c - 0.3), 2 * (c - 0.6)])


def test_distances_inside_beside_and_off_a_corner() -> None:
    points = np.array([[1.0, 1.0], [2.0, 1.0], [3.0, 1.0], [1.0, -0.5], [5.0, 6.0]])
    assert distances(points, SQUARE) == pytest.approx([0.0, 0.0, 1.0, 0.5, 5.0])


@given(st.integers(0, 5_000))
@settings(max_examples=30)
def test_distances_are_those_to_the_nearest_of_many_points_of_the_polygon(seed: int) -> None:
    rng = np.random.default_rng(seed)
    corners = np.array([[0.0, 0.0], [1.0, 0.2], [1.3, 1.0], [0.4, 1.5], [-0.3, 0.8]])
    points = rng.uniform(-2.0, 3.0, (20, 2))
    share = np.linspace(0.0, 1.0, 200)[:, None]
    rim = np.concatenate(
        [a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    )
    nearest = np.linalg.norm(points[:, None] - rim[None], axis=2).min(axis=1)

    found = distances(points, corners)
    outside = found > 0.0
    assert found[outside] == pytest.approx(nearest[outside], abs=1e-2)
    for point in points[~outside]:  # a point inside sees the corners all around it
        angles = np.sort(np.arctan2(*(corners - point).T[::-1]))
        assert np.diff(np.append(angles, angles[0] + 2 * np.pi)).max() <= np.pi + 1e-9
