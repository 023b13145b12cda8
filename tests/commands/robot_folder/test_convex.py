"""Convex hulls of a link: few corners, none left outside, merged where that adds no volume."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tamp.commands.robot_folder import convex
from tamp.commands.robot_folder.convex import MOST_VERTICES, ball, hull_of, joined
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull


def box(*low: float, size: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Hull:
    corners = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    return hull_of(np.array(low) + np.array(corners) * size, "link")


def volume(hull: Hull) -> float:
    return float(ConvexHull(hull.vertices).volume)


def outside(points: Array, hull: Hull) -> float:
    """How far the farthest point is beyond a face."""
    planes = ConvexHull(hull.vertices).equations
    return float((points @ planes[:, :3].T + planes[:, 3]).max())


def test_boxes_in_a_row_are_one_and_a_corner_stays_two() -> None:
    row = joined([box(i, 0, 0) for i in range(5)], "link")
    assert len(row) == 1 and volume(row[0]) == pytest.approx(5.0)
    corner = joined([box(0, 0, 0, size=(3, 1, 1)), box(0, 1, 0, size=(1, 2, 1))], "link")
    assert len(corner) == 2 and sum(map(volume, corner)) == pytest.approx(5.0)


def test_a_merged_piece_is_merged_further() -> None:
    # Neither pair of opposite quarters, but two halves, and then the whole.
    quarters = [box(0, 0, 0), box(1, 1, 0), box(1, 0, 0), box(0, 1, 0)]
    (whole,) = joined(quarters, "link")
    assert volume(whole) == pytest.approx(4.0)


def test_two_pieces_are_asked_about_once(monkeypatch: pytest.MonkeyPatch) -> None:
    apart = [box(10.0 * i, 7.0 * i * i, 0) for i in range(8)]
    asked = 0

    def counted(points: Array, link: str) -> Hull:
        nonlocal asked
        asked += 1
        return hull_of(points, link)

    monkeypatch.setattr(convex, "hull_of", counted)
    pair = [box(0, 0, 100), box(1, 0, 100)]
    assert len(convex.joined([*apart, *pair], "link")) == 9
    assert asked <= 45 + 8  # all pairs of ten, and the new piece with each other one


def test_a_coarse_hull_leaves_nothing_outside() -> None:
    points = np.random.default_rng(0).normal(size=(4000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    hull = hull_of(points, "link")
    assert len(hull.vertices) <= MOST_VERTICES
    assert outside(points, hull) < 1e-6
    assert volume(hull) < 1.25 * 4.0 / 3.0 * np.pi


def test_faces_look_outwards() -> None:
    hull = hull_of(np.random.default_rng(1).normal(size=(60, 3)), "link")
    corners = hull.vertices[hull.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outwards = np.einsum("ij,ij->i", normals, corners.mean(axis=1) - hull.vertices.mean(axis=0))
    assert np.all(outwards > 0)


def test_what_is_flat_gets_a_thickness_and_a_line_is_refused_by_its_link() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
    assert volume(hull_of(square, "plate")) == pytest.approx(1.001**2 * 0.001)
    with pytest.raises(InputError, match="link 'dot': a collision shape has no volume"):
        hull_of(np.full((3, 3), np.nan), "dot")


def test_a_ball_and_a_capsule_are_contained() -> None:
    rng = np.random.default_rng(2)
    on_it = rng.normal(size=(3000, 3))
    on_it *= 0.2 / np.linalg.norm(on_it, axis=1)[:, None]
    assert outside(on_it, hull_of(ball(0.2, 0.0), "link")) < 1e-6
    up = np.array([0.0, 0.0, 0.5])
    ends = np.concatenate([on_it + up, on_it - up])
    assert outside(ends, hull_of(ball(0.2, 0.5), "link")) < 1e-6
