"""Resting faces and their mathematics, against closed forms and trimesh."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Shape, Sphere
from tamp.geometric.stability.hulls import body_hull, outline
from tamp.geometric.stability.stable_poses import Face, stable_faces_of
from tests.geometric.streams.scenes import THINGS, problem_with


def body(*parts: Part) -> Body:
    return Body("thing", parts, Pose(), movable=True)


def faces(shape: Shape) -> tuple[Face, ...]:
    return stable_faces_of(body(Part(shape))).faces


def test_a_box_rests_on_six_faces() -> None:
    size = (0.06, 0.16, 0.21)
    found = faces(Box(size))
    assert len(found) == 6
    downs = {tuple(np.round(-face.rotation[2]).astype(int)) for face in found}
    assert len(downs) == 6
    for face in found:
        axis = int(np.argmax(np.abs(face.rotation[2])))
        others = [size[i] for i in range(3) if i != axis]
        assert face.height == pytest.approx(size[axis] / 2) and face.extent == pytest.approx(
            size[axis]
        )
        assert face.angle == pytest.approx(math.atan2(min(others) / 2, size[axis] / 2))
        assert (
            np.allclose(face.rotation @ face.rotation.T, np.eye(3))
            and np.linalg.det(face.rotation) > 0
        )


def test_the_present_face_comes_first() -> None:
    lying = Body(
        "thing",
        (Part(Box((0.05, 0.05, 0.3))),),
        Pose.from_xyz_rpy((0, 0, 1), (math.pi / 2, 0, 0)),
        True,
    )
    first = stable_faces_of(lying).faces[0]
    assert first.extent == pytest.approx(0.05)
    assert -first.rotation[2] @ -lying.pose.rotation[2] > 0.99


def test_a_tower_does_not_stand_on_its_edge() -> None:
    assert all(
        face.extent < 0.2 for face in faces(Box((0.02, 0.3, 0.02)))
    )  # 0.3 m on 2 cm tips at 4 degrees


def test_a_can_stands_and_a_ball_does_not() -> None:
    upright = [face for face in faces(Cylinder(0.033, 0.102)) if abs(face.rotation[2, 2]) > 0.99]
    assert len(upright) == 2
    assert upright[0].angle == pytest.approx(math.atan2(0.033, 0.051), abs=0.01)
    assert faces(Sphere(0.04)) == ()


def test_a_part_at_a_side_moves_the_centre_and_the_tipping_edge() -> None:
    """An L: a foot 0.2 m long and a tower at its end."""
    shape = body(
        Part(Box((0.2, 0.06, 0.02)), Pose((0.0, 0.0, 0.01))),
        Part(Box((0.04, 0.06, 0.2)), Pose((0.08, 0.0, 0.12))),
    )
    centre = centre_of_mass(shape)
    foot, tower = 0.2 * 0.06 * 0.02, 0.04 * 0.06 * 0.2
    assert centre == pytest.approx(
        [0.08 * tower / (foot + tower), 0.0, (0.01 * foot + 0.12 * tower) / (foot + tower)]
    )
    standing = stable_faces_of(shape).faces[0]
    assert standing.height == pytest.approx(0.0, abs=1e-9)
    assert standing.angle == pytest.approx(math.atan2(min(0.03, 0.1 - centre[0]), centre[2]))


@pytest.mark.parametrize("name", sorted(THINGS))
def test_hull_and_centre_are_those_of_trimesh(name: str, tmp_path: Path) -> None:
    thing = problem_with(name, tmp_path).scene.bodies[name]
    vertices, triangles = body_hull(thing)
    ours = trimesh.Trimesh(vertices, triangles, process=False)
    hull = trimesh.convex.convex_hull(vertices)
    assert ours.volume == pytest.approx(hull.volume, rel=1e-6)
    if len(thing.parts) == 1:
        assert centre_of_mass(thing) == pytest.approx(hull.center_mass, abs=1e-5)
    found = stable_faces_of(thing).faces
    assert found
    for face in found:
        turned = vertices @ face.rotation.T
        assert turned[:, 2].min() == pytest.approx(-face.height, abs=1e-9)
        assert np.ptp(turned[:, 2]) == pytest.approx(face.extent, abs=1e-9)
        # the centre of mass is over the face
        edges = np.roll(face.base, -1, axis=0) - face.base
        offsets = face.centre - face.base
        assert (edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0] > 0).all()


def test_the_outline_is_the_hull() -> None:
    points = np.random.default_rng(0).normal(size=(200, 2))
    ours = outline(points)
    theirs = points[ConvexHull(points).vertices]
    assert {tuple(p) for p in ours.round(6)} == {tuple(p) for p in theirs.round(6)}
