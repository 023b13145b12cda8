"""Rows of convex parts as the kernels read them: a part's box, sphere and leaves, and the world's box around it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.geometric.collision.tables import (
    BOX,
    CENTRE,
    COVER_COUNT,
    COVER_ERROR,
    COVER_SPHERES,
    CYLINDER,
    HULL,
    KIND,
    PART_COLUMNS,
    POINT,
    RADIUS,
    RADIUS_OFFSET,
    SIZE,
    VERTEX_COUNT,
    VERTICES,
    TableRows,
    pose_rows,
    world_box,
)
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Shape, Sphere
from tests.geometric.making import cuboid, hull

_ANGLE = st.floats(-math.pi, math.pi)
OFF_CENTRE = hull(cuboid((0.2, 0.4, 0.6)) + np.array([1.0, 2.0, 3.0]))


@pytest.mark.parametrize(
    ("shape", "kind", "half", "centre", "radius", "margin"),
    [
        (Sphere(0.3), POINT, [0.3] * 3, [0, 0, 0], 0.3, 0.3),
        (Box((0.2, 0.4, 0.4)), BOX, [0.1, 0.2, 0.2], [0, 0, 0], 0.3, 0.0),
        (Cylinder(0.3, 0.8), CYLINDER, [0.3, 0.3, 0.4], [0, 0, 0], 0.5, 0.0),
        (OFF_CENTRE, HULL, [0.1, 0.2, 0.3], [1, 2, 3], math.sqrt(0.14), 0.0),
    ],
    ids=["sphere", "box", "cylinder", "hull"],
)
def test_a_row_has_the_box_and_the_sphere_around_a_part(
    shape: Shape, kind: int, half: list, centre: list, radius: float, margin: float
) -> None:
    row = TableRows().row(Part(shape))
    assert row.shape == (PART_COLUMNS,) and row[KIND] == kind
    assert row[SIZE : SIZE + 3] == pytest.approx(half) and row[
        CENTRE : CENTRE + 3
    ] == pytest.approx(centre)
    assert (row[RADIUS], row[RADIUS_OFFSET], row[COVER_ERROR]) == pytest.approx(
        (radius, margin, radius)
    )


def test_hulls_point_to_their_vertices_and_covers_to_their_leaves() -> None:
    rows = TableRows()
    first, second = rows.row(Part(OFF_CENTRE)), rows.row(Part(hull(cuboid((1, 1, 1)))))
    assert (first[VERTICES], first[VERTEX_COUNT], second[VERTICES], second[VERTEX_COUNT]) == (
        0,
        8,
        8,
        8,
    )
    vertices = rows.vertices()
    assert vertices.shape == (3, 16) and vertices.flags.c_contiguous
    assert np.abs(vertices[:, 8:]) == pytest.approx(np.full((3, 8), 0.5))

    leaves = np.array([[0.0, 0.0, 0.1, 0.05], [0.0, 0.0, -0.1, 0.05]])
    rows.row(Part(Sphere(1.0)), (leaves[:1], 0.01))
    covered = rows.row(Part(Box((1, 1, 1))), (leaves, 0.02))
    assert (covered[COVER_SPHERES], covered[COVER_COUNT], covered[COVER_ERROR]) == (1, 2, 0.02)
    assert (rows.leaves()[1:] == leaves).all()


def test_nothing_collected_is_empty_tables() -> None:
    assert TableRows().vertices().shape == (3, 0) and TableRows().leaves().shape == (0, 4)


def test_a_pose_is_a_rotation_row_by_row_and_a_position() -> None:
    T = Pose.from_xyz_yaw(1.0, 2.0, 3.0, math.pi / 2).matrix
    assert pose_rows(T[None])[0] == pytest.approx([0, -1, 0, 1, 0, 0, 0, 0, 1, 1, 2, 3], abs=1e-12)


@given(_ANGLE, _ANGLE, _ANGLE)
@settings(max_examples=30)
def test_the_worlds_box_holds_the_part_and_is_exact_for_boxes(
    roll: float, pitch: float, yaw: float
) -> None:
    pose = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (roll, pitch, yaw))
    for shape in (Box((0.2, 0.4, 0.6)), OFF_CENTRE, Cylinder(0.1, 0.3)):
        low, high = world_box(TableRows().row(Part(shape))[None], pose_rows(pose.matrix[None]))
        least, most = bounds([Part(shape)], pose)
        assert (low[0] <= least + 1e-12).all() and (high[0] >= most - 1e-12).all()
        if not isinstance(shape, Cylinder):
            assert low[0] == pytest.approx(least) and high[0] == pytest.approx(most)
