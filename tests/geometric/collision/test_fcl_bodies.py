"""FCL's exact answers on shapes whose gaps and depths are known, and bodies placed once for many questions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.collision.fcl_bodies import FclBody, depth, gap, geometry, touch
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Shape, Sphere
from tests.geometric.making import cuboid, hull

SHAPES = [Box((0.2, 0.2, 0.2)), hull(cuboid((0.2, 0.2, 0.2))), Cylinder(0.1, 0.2), Sphere(0.1)]


@pytest.mark.parametrize("first", SHAPES, ids=["box", "hull", "cylinder", "sphere"])
@pytest.mark.parametrize("second", SHAPES, ids=["box", "hull", "cylinder", "sphere"])
def test_fcl_knows_gaps_and_depths_along_an_axis(first: Shape, second: Shape) -> None:
    here, there = FclBody((Part(first),)), FclBody((Part(second),))
    one = here.place(0, np.eye(4))
    apart = there.place(0, Pose((0.25, 0.0, 0.0)).matrix)
    assert gap(one, apart) == pytest.approx(0.05, abs=1e-5)
    assert touch(one, apart, 0.051) and not touch(one, apart, 0.049) and not touch(one, apart, 0.0)
    assert depth(one, apart) == 0.0
    inside = there.place(0, Pose((0.17, 0.0, 0.0)).matrix)
    assert touch(one, inside, 0.0) and gap(one, inside) == 0.0
    assert depth(one, inside) == pytest.approx(0.03, rel=0.05)


def test_a_part_stands_at_its_pose_in_the_body_and_is_moved_with_it() -> None:
    pair = FclBody((Part(Sphere(0.1), Pose((0.5, 0, 0))), Part(Sphere(0.1), Pose((-0.5, 0, 0)))))
    turned = Pose.from_xyz_yaw(1.0, 0.0, 0.0, math.pi / 2).matrix
    assert pair.place(0, turned).getTranslation() == pytest.approx([1.0, 0.5, 0.0])
    assert pair.place(1, turned).getTranslation() == pytest.approx([1.0, -0.5, 0.0])
    assert pair.place(0, np.eye(4)).getTranslation() == pytest.approx([0.5, 0.0, 0.0])


def test_a_shape_has_one_geometry_for_all_its_objects() -> None:
    first, second = FclBody((Part(Box((0.1, 0.2, 0.3))),)), FclBody((Part(Box((0.1, 0.2, 0.3))),))
    assert geometry(Box((0.1, 0.2, 0.3))) is geometry(Box((0.1, 0.2, 0.3)))
    # Each still stands where it was put: 0.5 m apart less half of each.
    one, other = first.place(0, np.eye(4)), second.place(0, Pose((0.5, 0.0, 0.0)).matrix)
    assert gap(one, other) == pytest.approx(0.4)


def test_meshes_touch_by_their_triangles_and_are_hollow() -> None:
    cube = hull(cuboid((0.2, 0.2, 0.2)))
    shell = FclBody.of_meshes([(cube.vertices, cube.faces)])
    pea = FclBody((Part(Sphere(0.01)),))
    skin = shell.place(0, Pose((0.0, 0.0, 1.0)).matrix)
    assert not touch(pea.place(0, Pose((0.0, 0.0, 1.0)).matrix), skin, 0.0)  # in the middle of it
    assert touch(pea.place(0, Pose((0.095, 0.0, 1.0)).matrix), skin, 0.0)
    outside = pea.place(0, Pose((0.15, 0.0, 1.0)).matrix)
    assert not touch(outside, skin, 0.0) and gap(outside, skin) == pytest.approx(0.04, abs=1e-6)


def test_the_deepest_contact_is_the_depth() -> None:
    """A box of 0.2 m leans by a quarter turn about x on an edge: its corner line is 0.1 m sqrt(2) below."""
    box, slab = FclBody((Part(Box((0.2, 0.2, 0.2))),)), FclBody((Part(Box((2.0, 2.0, 1.0))),))
    leaning = box.place(0, Pose.from_xyz_rpy((0.0, 0.0, 0.6), (math.pi / 4, 0.0, 0.0)).matrix)
    under = slab.place(0, np.eye(4))
    assert depth(leaning, under) == pytest.approx(0.1 * math.sqrt(2) - 0.1, abs=1e-4)
