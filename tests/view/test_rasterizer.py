"""Pictures of plain things: where they are seen, in which colour, what hides what, and shadows."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Sphere
from tamp.view.mesh import ROUND, Mesh, shape_mesh
from tamp.view.rasterizer import BACKGROUND, Camera, Triangles, render, triangles

SIZE = (80, 60)
ABOVE = Camera((0.0, -0.01, 10.0), (0.0, 0.0, 0.0), 40.0)
"""Looks straight down; the picture's top is the world's +y."""
RED, GREEN, WHITE = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (1.0, 1.0, 1.0, 1.0)


def box(
    size: tuple[float, float, float], at: tuple[float, float, float], colour: tuple
) -> Triangles:
    return triangles(shape_mesh(Box(size), colour).moved(Pose(at).matrix))


def coloured(picture: np.ndarray, channel: int) -> np.ndarray:
    """Where one channel is much brighter than the others, rows x columns."""
    others = np.delete(picture.astype(int), channel, axis=2).max(axis=2)
    return picture[:, :, channel].astype(int) > others + 60


def test_nothing_in_view_leaves_the_background() -> None:
    picture = render([box((1, 1, 1), (0, 0, 30), RED)], ABOVE, SIZE)  # behind the eye
    assert picture.shape == (60, 80, 3) and picture.dtype == np.uint8
    assert np.abs(picture - 255 * np.array(BACKGROUND)).max() <= 1


def test_a_thing_has_the_size_that_perspective_gives_it() -> None:
    picture = render([box((2, 1, 0.01), (0, 0, 0), RED)], ABOVE, SIZE)
    seen = coloured(picture, 0)
    scale = 60 / (2 * 10 * math.tan(math.radians(20)))  # pixels a metre at 10 m
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    assert len(columns) == pytest.approx(2 * scale, abs=1.5)
    assert len(rows) == pytest.approx(1 * scale, abs=1.5)
    assert columns.mean() == pytest.approx(39.5, abs=1.0) and rows.mean() == pytest.approx(
        29.5, abs=1.0
    )


def test_right_is_plus_x_and_up_is_plus_y() -> None:
    picture = render(
        [box((0.5, 0.5, 0.1), (2, 0, 0), RED), box((0.5, 0.5, 0.1), (0, 2, 0), GREEN)], ABOVE, SIZE
    )
    assert np.argwhere(coloured(picture, 0)).mean(axis=0)[1] > 50
    assert np.argwhere(coloured(picture, 1)).mean(axis=0)[0] < 20


def test_the_nearer_thing_hides_the_farther_one_in_whatever_order() -> None:
    near, far = box((1, 1, 0.1), (0, 0, 1), RED), box((1, 1, 0.1), (0, 0, 0), GREEN)
    for parts in ([near, far], [far, near]):
        picture = render(parts, ABOVE, SIZE)
        assert coloured(picture, 0)[30, 40] and not coloured(picture, 1)[30, 40]


def test_what_is_lit_is_brighter_than_what_is_in_the_shadow() -> None:
    floor = box((8, 8, 0.01), (0, 0, -0.005), WHITE)
    alone = render([floor], ABOVE, SIZE).astype(int)
    shaded = render([floor, box((0.6, 0.6, 0.05), (0, 0, 1.5), RED)], ABOVE, SIZE).astype(int)
    darker = (alone - shaded).min(axis=2) > 20
    red = coloured(shaded.astype(np.uint8), 0)
    assert (darker & ~red).sum() > 20
    # The sun stands at (0.35, -0.5, 0.8): the shadow falls to -x and +y of what throws it.
    row, column = np.argwhere(darker & ~red).mean(axis=0)
    assert column < 39 and row < 29


def test_a_side_towards_the_sun_is_brighter_than_one_away_from_it() -> None:
    block = [box((2, 2, 2), (0, 0, 0), WHITE)]
    front = render(block, Camera((0.0, -10.0, 0.1), (0.0, 0.0, 0.0)), SIZE)[30, 40].mean()
    behind = render(block, Camera((0.0, 10.0, 0.1), (0.0, 0.0, 0.0)), SIZE)[30, 40].mean()
    assert front > behind + 20


def test_a_balls_normals_are_smooth_and_a_boxes_are_not() -> None:
    ball = triangles(shape_mesh(Sphere(1.0), RED))
    outward = ball.corners / np.linalg.norm(ball.corners, axis=2, keepdims=True)
    broad = np.linalg.norm(ball.normals, axis=2) > 0.5  # triangles at the poles have no area
    assert (np.einsum("nij,nij->ni", ball.normals, outward)[broad] > 0.99).all()
    cube = triangles(shape_mesh(Box((1, 1, 1)), RED))
    assert (np.abs(cube.normals).max(axis=2) > 1 - 1e-9).all()  # each along an axis


@pytest.mark.parametrize("height", [0.02, 0.3, 5.0])
def test_a_cans_rim_is_sharp_however_high_it_is(height: float) -> None:
    can = triangles(shape_mesh(Cylinder(0.1, height), RED))
    level = np.abs(can.normals[:, :, 2])
    assert ((level < 1e-9) | (level > 1 - 1e-9)).all()  # of the lid or of the side, nothing between
    side = (level < 1e-9) & (np.linalg.norm(can.normals, axis=2) > 0.5)
    radial = can.corners[side][:, :2] / 0.1
    assert (
        np.einsum("ni,ni->n", can.normals[side][:, :2], radial) > math.cos(math.pi / ROUND) - 1e-9
    ).all()


def test_triangles_move_with_their_normals() -> None:
    turned = box((1, 1, 1), (0, 0, 0), RED).moved(Pose.from_xyz_yaw(3, 0, 0, math.pi / 4).matrix)
    assert turned.corners.mean(axis=(0, 1)) == pytest.approx([3, 0, 0])
    assert np.linalg.norm(turned.normals, axis=2) == pytest.approx(np.ones((12, 3)))
    sides = turned.normals[np.abs(turned.normals[:, 0, 2]) < 0.5]
    assert np.abs(sides[:, :, :2]) == pytest.approx(np.full((8, 3, 2), math.sqrt(0.5)))


def test_an_empty_mesh_has_no_triangles() -> None:
    none = triangles(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int), RED))
    assert none.corners.shape == (0, 3, 3) and none.colours.shape == (0, 3)
