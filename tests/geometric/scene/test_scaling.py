"""A scaled body is the same one in another unit: every point moves to `factor` times where it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scaling import scale_part, scale_pose, scale_visual
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Shape, Sphere, Visual
from tests.geometric.making import cuboid, hull

TURNED = Pose.from_xyz_rpy((0.2, -0.3, 0.5), (0.4, 0.5, 0.6))


@pytest.mark.parametrize("factor", [0.001, 0.5, 3.0])
@pytest.mark.parametrize(
    "shape",
    [Box((0.1, 0.2, 0.3)), Cylinder(0.1, 0.4), Sphere(0.15), hull(cuboid((0.1, 0.3, 0.2)))],
    ids=type,
)
def test_the_bounds_of_a_part_scale_about_the_bodys_origin(shape: Shape, factor: float) -> None:
    part = Part(shape, TURNED)
    before, after = bounds([part], Pose()), bounds([scale_part(part, factor)], Pose())
    assert np.array(after) == pytest.approx(factor * np.array(before))


def test_a_pose_keeps_its_rotation() -> None:
    scaled = scale_pose(TURNED, 10.0)
    assert scaled.position == pytest.approx((2.0, -3.0, 5.0))
    assert scaled.quaternion == TURNED.quaternion


def test_a_scaled_hull_keeps_its_faces_and_cannot_be_written_to() -> None:
    given = hull(cuboid((1.0, 1.0, 1.0)))
    kept = given.vertices.copy()
    scaled = scale_part(Part(given), 2.0).shape

    assert isinstance(scaled, Hull)
    assert scaled.faces is given.faces
    assert (given.vertices == kept).all()
    with pytest.raises(ValueError, match="read-only"):
        scaled.vertices[0] = 0.0


def test_a_drawing_scales_its_mesh_its_pose_and_its_shapes() -> None:
    visual = Visual(
        Path("drawn.obj"),
        (Part(Sphere(1.0), Pose((0.0, 1.0, 0.0))),),
        (1.0, -1.0, 2.0),
        TURNED,
        (1.0, 0.0, 0.0, 1.0),
    )
    scaled = scale_visual(visual, 0.5)
    assert scaled.scale == (0.5, -0.5, 1.0)  # what was mirrored stays mirrored
    assert scaled.pose.position == pytest.approx((0.1, -0.15, 0.25))
    assert scaled.shapes == (Part(Sphere(0.5), Pose((0.0, 0.5, 0.0))),)
    assert (scaled.mesh, scaled.colour) == (visual.mesh, visual.colour)
