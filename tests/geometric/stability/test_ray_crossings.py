"""Lines through bodies: where they enter and leave, against closed forms; points uniform over a surface."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Part
from tamp.geometric.stability.ray_crossings import SEAM_WIDTH_M, ConvexUnion
from tests.geometric.making import cuboid, hull

X = np.array([1.0, 0.0, 0.0])


def solid(*parts: Part) -> ConvexUnion:
    return ConvexUnion(Body("thing", parts, Pose((9.0, 9.0, 9.0)), True))


def boxes(*middles: float, width: float = 0.2) -> ConvexUnion:
    """Boxes of one width in a row along x."""
    return solid(*(Part(Box((width, 0.2, 0.2)), Pose((x, 0.0, 0.0))) for x in middles))


def test_a_line_through_a_box_crosses_its_two_faces() -> None:
    contact = boxes(0.0).solid_at(np.array([0.0, 0.05, 0.0]), X)
    assert contact is not None
    assert (contact.start, contact.end) == pytest.approx((-0.1, 0.1))
    assert contact.start_normal == pytest.approx(-X) and contact.end_normal == pytest.approx(X)


def test_lengths_are_measured_along_the_line_from_its_origin() -> None:
    slanted = np.array([math.cos(0.3), math.sin(0.3), 0.0])
    contact = solid(Part(Box((0.2, 2.0, 2.0)))).solid_at(np.array([-0.1, 0.0, 0.0]), slanted)
    assert contact is not None
    assert contact.start == pytest.approx(0.0, abs=1e-12)
    assert contact.end == pytest.approx(0.2 / math.cos(0.3))
    backwards = solid(Part(Box((0.2, 2.0, 2.0)))).solid_at(np.array([-0.1, 0.0, 0.0]), -slanted)
    assert backwards is not None
    assert (backwards.start, backwards.end) == pytest.approx((-0.2 / math.cos(0.3), 0.0), abs=1e-12)


def test_outside_of_the_solid_there_is_no_contact() -> None:
    row = boxes(0.0, 1.0)
    assert row.solid_at(np.array([0.5, 0.0, 0.0]), X) is None  # in the gap between the two
    assert row.solid_at(np.array([0.0, 0.3, 0.0]), X) is None  # beside both, along their faces
    assert row.solid_at(np.array([-2.0, 0.0, 0.0]), X) is None  # the solid is ahead, not here


@pytest.mark.parametrize(
    ("gap", "joined"), [(0.0, True), (0.8 * SEAM_WIDTH_M, True), (1.5 * SEAM_WIDTH_M, False)]
)
def test_parts_join_into_one_stretch_across_a_seam(gap: float, joined: bool) -> None:
    step = 0.2 + gap
    contact = boxes(0.0, step, 2 * step).solid_at(np.zeros(3), X)
    assert contact is not None
    assert contact.end == pytest.approx(2 * step + 0.1 if joined else 0.1)
    back = boxes(-2 * step, -step, 0.0).solid_at(np.zeros(3), X)
    assert back is not None
    assert back.start == pytest.approx(-2 * step - 0.1 if joined else -0.1)


def test_the_order_of_parts_does_not_matter() -> None:
    contact = boxes(0.4, 0.0, 0.6, 0.2).solid_at(np.zeros(3), X)
    assert contact is not None and (contact.start, contact.end) == pytest.approx((-0.1, 0.7))


def test_many_lines_through_a_hull_against_a_look_at_points_along_them() -> None:
    corners = cuboid((0.4, 0.6, 0.8))
    made = solid(Part(hull(corners)), Part(Box((0.3, 0.3, 0.3)), Pose((1.0, 0.0, 0.0))))
    rng = np.random.default_rng(3)
    origins = rng.uniform(-0.6, 0.6, (40, 3))
    ways = rng.normal(size=(40, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    starts, ends, first, last = made.crossings(origins, ways)
    assert starts.shape == ends.shape == (40, 2)

    steps = np.linspace(-2.0, 2.0, 4001)
    for k in range(40):
        points = origins[k] + steps[:, None] * ways[k]
        inside = (np.abs(points) <= [0.2, 0.3, 0.4]).all(axis=1)
        if inside.any():
            assert (starts[k, 0], ends[k, 0]) == pytest.approx(
                (steps[inside][0], steps[inside][-1]), abs=2e-3
            )
            assert made.normals(first)[k, 0] @ ways[k] < 0 < made.normals(last)[k, 0] @ ways[k]
        else:
            assert ends[k, 0] - starts[k, 0] < 2e-3


def test_the_extent_of_a_box_along_a_slant_is_its_support_function() -> None:
    direction = np.array([0.6, 0.0, 0.8])
    assert boxes(0.5).extent(direction) == pytest.approx((0.6 * 0.4 - 0.08, 0.6 * 0.6 + 0.08))


def test_surface_points_are_on_the_faces_and_as_many_as_their_areas_ask(
    rng: np.random.Generator,
) -> None:
    points, normals = solid(Part(Box((0.1, 0.2, 0.4)))).surface_points(rng, 6000)
    half = np.array([0.05, 0.1, 0.2])
    axis = np.abs(normals).argmax(axis=1)
    on = np.einsum("ij,ij->i", points, normals)
    assert on == pytest.approx(half[axis])
    assert (np.abs(points) <= half + 1e-12).all()
    shares = np.bincount(axis, minlength=3) / 6000
    assert shares == pytest.approx(np.array([0.08, 0.04, 0.02]) / 0.14, abs=0.03)
