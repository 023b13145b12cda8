"""Extents, volumes, centres and inertias of shapes, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Shape, Sphere
from tamp.simulation.shapes import (
    body_points,
    centre_of_mass,
    floor_under,
    half_extents,
    inertia,
    link_frame,
    mass_centre,
    obj,
    points,
)
from tests.simulation.scenes import body, cube_hull, scene_of


def test_centre_of_mass_of_two_parts() -> None:
    parts = (Part(cube_hull(0.1)), Part(Box((0.1, 0.1, 0.1)), Pose((0.2, 0.0, 0.0))))
    assert np.allclose(centre_of_mass(parts), [0.1, 0.0, 0.0], atol=1e-9)


def test_inertia_of_a_hull_is_that_of_the_same_box() -> None:
    size = np.array([0.1, 0.2, 0.3])
    corners = (
        np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    )
    squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([(a, b, c) for a, b, c, _ in squares] + [(a, c, d) for a, _, c, d in squares])
    expected = 2.0 / 12 * np.diag([0.2**2 + 0.3**2, 0.1**2 + 0.3**2, 0.1**2 + 0.2**2])
    at = Pose((0.5, -0.2, 0.1))
    assert inertia((Part(Box((0.1, 0.2, 0.3)), at),), 2.0) == pytest.approx(expected)
    assert inertia((Part(Hull(corners, faces), at),), 2.0) == pytest.approx(expected)


def test_inertia_of_two_parts_is_that_of_the_whole() -> None:
    turned = Pose.from_xyz_rpy((0.3, 0.1, -0.2), (0.4, -0.7, 1.1))
    halves = [
        Part(Cylinder(0.03, 0.05), turned @ Pose((0.0, 0.0, side * 0.025))) for side in (-1, 1)
    ]
    whole = (Part(Cylinder(0.03, 0.1), turned),)
    assert inertia(halves, 1.5) == pytest.approx(inertia(whole, 1.5))
    assert centre_of_mass(halves) == pytest.approx(centre_of_mass(whole))
    across, along = np.linalg.eigvalsh(inertia(whole, 1.5))[[1, 0]]
    assert along == pytest.approx(1.5 * 0.03**2 / 2) and across == pytest.approx(
        1.5 * (3 * 0.03**2 + 0.1**2) / 12
    )


QUARTER = Hull(  # of a cube of 0.2 m, the corner at the origin cut off from it
    np.array([[0.0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]),
)


@pytest.mark.parametrize(
    ("shape", "centre", "half"),
    [
        (Box((0.2, 0.4, 0.6)), (0, 0, 0), (0.1, 0.2, 0.3)),
        (Cylinder(0.1, 0.6), (0, 0, 0), (0.1, 0.1, 0.3)),
        (Sphere(0.1), (0, 0, 0), (0.1, 0.1, 0.1)),
        (QUARTER, (0.1, 0.1, 0.1), (0.1, 0.1, 0.1)),
    ],
)
def test_points_reach_as_far_as_the_box_around_a_shape(
    shape: Shape, centre: tuple[float, ...], half: tuple[float, ...]
) -> None:
    told = half_extents(shape)
    assert told[0] == pytest.approx(centre) and told[1] == pytest.approx(half)
    reached = points(shape)
    assert reached.min(axis=0) == pytest.approx(np.subtract(centre, half))
    assert reached.max(axis=0) == pytest.approx(np.add(centre, half))
    moved = body_points((Part(shape, Pose((1.0, 0.0, 0.0))), Part(Sphere(0.01))))
    assert moved[: len(reached)] == pytest.approx(reached + np.array([1.0, 0.0, 0.0]))
    assert np.linalg.norm(moved[len(reached) :], axis=1) == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (Box((0.2, 0.4, 0.6)), np.diag([0.4**2 + 0.6**2, 0.2**2 + 0.6**2, 0.2**2 + 0.4**2]) / 12),
        (Sphere(0.1), 2 / 5 * 0.1**2 * np.eye(3)),
        # Of a tetrahedron with three legs a at right angles, each variance is 3 a^2 / 80 and each
        # covariance -a^2 / 80.
        (QUARTER, 0.2**2 / 80 * (6 * np.eye(3) + (np.ones((3, 3)) - np.eye(3)))),
    ],
)
def test_inertia_of_a_kilogram(shape: Shape, expected: np.ndarray) -> None:
    assert inertia((Part(shape),), 1.0) == pytest.approx(expected)


def test_the_centre_of_mass_is_the_files_where_it_says_one() -> None:
    assert centre_of_mass((Part(QUARTER),)) == pytest.approx([0.05, 0.05, 0.05])
    assert mass_centre(body("a", Part(QUARTER))) == pytest.approx([0.05, 0.05, 0.05])
    told = replace(body("a", Part(QUARTER)), center_of_mass=(0.0, 0.0, 0.1))
    assert mass_centre(told).tolist() == [0.0, 0.0, 0.1]


def test_the_floor_reaches_beyond_the_room_and_all_bodies() -> None:
    centre, half = floor_under(scene_of(body("far", Part(Sphere(0.1)), at=(103.0, 0.0, 1.0))))
    # The room is 6 m wide about the origin: from -3 m to 103 m, and 50 m more on each side.
    assert centre.tolist() == [50.0, 0.0, -0.5] and half.tolist() == [103.0, 53.0, 0.5]


@pytest.mark.parametrize(
    ("at", "told"),
    [
        ((99.0, -99.0, 3.0), (99.01, -99.0, 3.0)),
        ((101.0, 0.0, 3.0), (101.0, 0.0, 3.0)),
        ((0.0, -101.0, 3.0), (0.0, -101.0, 3.0)),
    ],
)
def test_far_from_the_origin_a_links_frame_is_reckoned_from_its_mass(
    at: tuple[float, float, float], told: tuple[float, float, float]
) -> None:
    """There pybullet's own frame is coarse: here it is 1 cm off. The mass is half a metre above."""
    x, y, z = at
    upright = (0.0, 0.0, 0.0, 1.0)
    state = ((x, y, z + 0.5), upright, (0.0, 0.0, 0.5), upright, (x + 0.01, y, z), upright)
    assert link_frame(state) == pytest.approx((*told, *upright))


def test_a_hull_is_written_with_faces_counted_from_one() -> None:
    lines = obj(QUARTER).splitlines()
    assert lines[1] == "v 0.2 0 0" and lines[4] == "f 1 3 2" and len(lines) == 8
    with pytest.raises(TypeError, match="not a hull"):
        obj(Sphere(0.1))
