"""The centre of mass against textbook centroids, and against the judge's own computation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.scene.centre_of_mass import (
    LEAST_VOLUME_M3,
    centre_of_mass,
    volume_and_centroid,
)
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, Shape, Sphere
from tamp.simulation.shapes import mass_centre as judges_centre
from tests.geometric.making import cuboid, hull

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
SHAPES = (Box((0.2, 0.3, 0.4)), Cylinder(0.1, 0.5), Sphere(0.2), hull(TETRAHEDRON * 0.3))


def of(*parts: Part, **more: object) -> Body:
    return Body("thing", parts, Pose((5.0, 5.0, 5.0)), True, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("shape", "volume"),
    [
        (Box((0.2, 0.3, 0.4)), 0.024),
        (Cylinder(0.1, 0.5), math.pi * 0.01 * 0.5),
        (Sphere(0.2), 4 / 3 * math.pi * 0.008),
        (hull(TETRAHEDRON), 1 / 6),
        (hull(TETRAHEDRON + 7.0), 1 / 6),
    ],
)
def test_volumes_are_the_textbooks(shape: Shape, volume: float) -> None:
    assert volume_and_centroid(shape)[0] == pytest.approx(volume)


def test_a_flat_hull_has_a_centre() -> None:
    square = np.array([[0, 0, 0.5], [1, 0, 0.5], [1, 1, 0.5], [0, 1, 0.5]], dtype=float)
    volume, centroid = volume_and_centroid(Hull(square, np.array([[0, 1, 2], [0, 2, 3]])))
    assert volume == LEAST_VOLUME_M3
    assert centroid == pytest.approx([0.5, 0.5, 0.5])


def test_the_centre_of_two_parts_is_weighed_by_volume() -> None:
    uneven = of(
        Part(Box((0.1, 0.1, 0.1)), Pose((0, 0, 0))), Part(Box((0.1, 0.1, 0.3)), Pose((0, 0, 0.4)))
    )
    assert centre_of_mass(uneven) == pytest.approx([0.0, 0.0, 0.3])  # 1 at 0 and 3 at 0.4


@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), (3.0, -2.0, 1.0)])
def test_the_centre_of_a_tetrahedron_is_the_mean_of_its_corners(
    at: tuple[float, float, float],
) -> None:
    body = of(Part(hull(TETRAHEDRON), Pose(at)))
    assert centre_of_mass(body) == pytest.approx(np.array(at) + 0.25)


@pytest.mark.parametrize("shape", [*SHAPES[:3], hull(cuboid((1, 2, 3)))])
def test_the_centre_of_what_is_symmetric_is_its_middle(shape: Shape) -> None:
    pose = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))
    assert centre_of_mass(of(Part(shape, pose))) == pytest.approx([0.1, 0.2, 0.3])


def test_what_a_file_says_counts() -> None:
    said = of(Part(Box((1, 1, 1))), center_of_mass=(0.1, 0.0, -0.4))
    assert centre_of_mass(said) == pytest.approx([0.1, 0, -0.4])


def test_the_judge_finds_the_same_by_code_of_its_own() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        parts = tuple(
            Part(shape, Pose.from_xyz_rpy(tuple(rng.normal(size=3)), tuple(rng.normal(size=3))))
            for shape in SHAPES
        )
        for few in (parts, parts[:1], parts[2:]):
            assert centre_of_mass(of(*few)) == pytest.approx(judges_centre(of(*few)), abs=1e-12)
