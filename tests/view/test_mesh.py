"""Triangles of shapes and files: closed, outward, of the right size, and simplified by cells."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Shape, Sphere
from tamp.view.mesh import ROUND, Mesh, read_mesh, shape_mesh, simplified, unit
from tests.geometric.making import cuboid, hull

RED = (1.0, 0.0, 0.0, 1.0)


def volume(mesh: Mesh) -> float:
    """By the divergence theorem: positive where the faces look outward."""
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


CIRCLE = ROUND / (2 * math.pi) * math.sin(2 * math.pi / ROUND)
"""The share of a circle that its polygon has."""


@pytest.mark.parametrize(
    ("shape", "expected", "close"),
    [
        (Box((0.2, 0.3, 0.4)), 0.024, 1e-9),
        (Cylinder(0.1, 0.5), CIRCLE * math.pi * 0.01 * 0.5, 1e-9),
        (Sphere(0.3), 4 / 3 * math.pi * 0.027, 0.02),
        (hull(cuboid((1.0, 2.0, 3.0))), 6.0, 1e-9),
    ],
    ids=["box", "cylinder", "sphere", "hull"],
)
def test_shapes_are_closed_and_outward(shape: Shape, expected: float, close: float) -> None:
    mesh = shape_mesh(shape, RED)
    assert volume(mesh) == pytest.approx(expected, rel=close)
    assert mesh.colour == RED


def test_a_moved_mesh_is_rigid() -> None:
    mesh = shape_mesh(Box((0.2, 0.3, 0.4)), RED)
    moved = mesh.moved(Pose.from_xyz_yaw(1.0, 2.0, 3.0, math.pi / 2).matrix)
    assert volume(moved) == pytest.approx(0.024)
    assert np.ptp(moved.vertices, axis=0) == pytest.approx([0.3, 0.2, 0.4])
    assert moved.vertices.mean(axis=0) == pytest.approx([1.0, 2.0, 3.0])


def test_unit_vectors_and_what_has_no_direction() -> None:
    given = np.array([[3.0, 0.0, 4.0], [0.0, 0.0, 0.0]])
    assert unit(given) == pytest.approx(np.array([[0.6, 0.0, 0.8], [0.0, 0.0, 0.0]]))


TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "t.obj"
    path.write_text(TETRAHEDRON)
    return path


def test_a_file_is_read_at_a_scale(file: Path) -> None:
    (mesh,) = read_mesh(file, (0.1, 0.1, 0.2), RED)
    assert volume(mesh) == pytest.approx(1 / 6 * 0.1 * 0.1 * 0.2)


def test_a_mirrored_file_still_looks_outward(file: Path) -> None:
    (mesh,) = read_mesh(file, (-1.0, 1.0, 1.0), RED)
    assert volume(mesh) == pytest.approx(1 / 6)
    assert mesh.vertices[:, 0].min() == -1.0


def test_each_colour_of_a_file_is_a_mesh(file: Path) -> None:
    file.with_suffix(".mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0 1\n")
    rows = TETRAHEDRON.split("\n")
    file.write_text(
        "\n".join(["mtllib t.mtl", *rows[:4], "usemtl a", *rows[4:6], "usemtl b", *rows[6:]])
    )
    meshes = read_mesh(file, (1.0, 1.0, 1.0), None)
    assert sorted(mesh.colour[:3] for mesh in meshes) == [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    assert [len(mesh.faces) for mesh in meshes] == [2, 2]
    assert len(read_mesh(file, (1.0, 1.0, 1.0), RED)) == 1  # the body's own counts more


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("v 0 0 1e308\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "farther than can be drawn"),
        ("nothing\n", "t.obj"),
    ],
)
def test_what_is_no_mesh_is_refused(file: Path, text: str, words: str) -> None:
    file.write_text(text)
    with pytest.raises(InputError, match=words):
        read_mesh(file, (1.0, 1.0, 1.0), RED)


def test_cells_merge_vertices_to_their_mean_and_drop_what_collapses() -> None:
    # Two pairs of vertices 1 mm apart, joined by triangles of which one falls together.
    vertices = np.array([[0, 0, 0], [0.001, 0, 0], [1, 0, 0], [1, 0.001, 0], [0, 1, 0]])
    faces = np.array([[0, 2, 4], [1, 3, 4], [0, 1, 2]])
    coarse = simplified(Mesh(vertices, faces, RED), 0.1)
    assert len(coarse.vertices) == 3 and len(coarse.faces) == 2
    assert {tuple(row) for row in coarse.vertices.round(6).tolist()} == {
        (0.0005, 0, 0),
        (1, 0.0005, 0),
        (0, 1, 0),
    }


def test_a_cell_smaller_than_all_details_changes_nothing() -> None:
    mesh = shape_mesh(Box((1.0, 1.0, 1.0)), RED)
    fine = simplified(mesh, 0.01)
    assert len(fine.vertices) == 8 and volume(fine) == pytest.approx(1.0)


def test_a_ball_in_cells_keeps_nearly_its_volume() -> None:
    ball = shape_mesh(Sphere(0.5), RED)
    coarse = simplified(ball, 0.1)
    assert len(coarse.faces) < 0.6 * len(ball.faces)
    assert volume(coarse) == pytest.approx(volume(ball), rel=0.1)
