"""Meshes: found where they may be, read in all formats, placed as a URDF says; what is none is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from tamp.errors import InputError
from tamp.geometric.loading.mesh_surface import read_surface
from tamp.geometric.loading.meshes import find_mesh, load_mesh
from tamp.geometric.scene.convex import hull_of
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere, Visual
from tests.geometric.loading.mesh_files import CUBE, CUBE_FACES, ONE, hulls, write_obj
from tests.needs import MESHES, NEEDS_PYBULLET

pytestmark = pytest.mark.usefixtures("own_cache")


def test_stl_in_both_ways(tmp_path: Path) -> None:
    triangles = np.array(CUBE)[np.array(CUBE_FACES)].astype("<f4")
    records = np.zeros(
        12, dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]
    )
    records["corners"] = triangles
    (tmp_path / "binary.stl").write_bytes(b"\0" * 80 + np.uint32(12).tobytes() + records.tobytes())
    text = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in t)
        + "endloop\nendfacet\n"
        for t in triangles
    )
    (tmp_path / "text.stl").write_text(f"solid cube\n{text}endsolid cube\n")
    for name in ("binary.stl", "text.stl"):
        assert ConvexHull(hulls(load_mesh(tmp_path / name))[0]).volume == pytest.approx(
            0.001, rel=1e-5
        )


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_ply_in_both_ways(tmp_path: Path, encoding: str) -> None:
    mesh = trimesh.Trimesh(CUBE, CUBE_FACES, process=False)
    mesh.export(tmp_path / "cube.ply", encoding=encoding)
    assert ConvexHull(hulls(load_mesh(tmp_path / "cube.ply"))[0]).volume == pytest.approx(
        0.001, rel=1e-5
    )


@pytest.mark.parametrize("name", ["bad.obj", "bad.stl", "bad.ply", "bad.urdf"])
@pytest.mark.parametrize("content", [b"", b"\x00\x01\x02", b"<not", b"hello there\n" * 20])
def test_files_that_are_no_mesh_are_refused(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=name):
        load_mesh(tmp_path / name)


def test_where_meshes_are_looked_for(tmp_path: Path) -> None:
    (tmp_path / "assets" / "objects").mkdir(parents=True)
    mine = write_obj(tmp_path / "assets" / "objects" / "mine.obj", CUBE, CUBE_FACES)
    assert find_mesh("objects/mine.obj", tmp_path) == mine
    assert find_mesh(str(mine), Path()) == mine
    assert find_mesh("objects/bowl.obj", tmp_path).is_file()
    with pytest.raises(
        InputError, match=r"no mesh file 'objects/mime.obj'. Did you mean 'objects/mine.obj'"
    ):
        find_mesh("objects/mime.obj", tmp_path)


@NEEDS_PYBULLET
def test_meshes_of_pybullet_data_are_found_where_it_is_installed(tmp_path: Path) -> None:
    assert find_mesh("pybullet_data/duck.obj", tmp_path).is_file()


def test_pybullet_datas_mug_comes_with_us(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tamp.geometric.loading.meshes._bullet_roots", list)
    assert find_mesh("pybullet_data/objects/mug.urdf", tmp_path) == find_mesh(
        "objects/mug.urdf", tmp_path
    )
    with pytest.raises(InputError, match=r"pybullet_data/duck\.obj") as said:
        find_mesh("pybullet_data/duck.obj", tmp_path)
    assert "not installed" in said.value.remedy


URDF = """<?xml version="1.0"?>
<robot name="lamp">
  <material name="warm"><color rgba="1 0.5 0 1"/></material>
  <link name="lamp">
    <visual>
      <origin xyz="0 0 0.1"/><geometry><mesh filename="cube.obj" scale="2 2 2"/></geometry><material name="warm"/>
    </visual>
    <collision><origin xyz="0 0 0.05" rpy="0 0 1.5707963"/><geometry><box size="0.2 0.1 0.1"/></geometry></collision>
    <collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.01" length="0.2"/></geometry></collision>
    <collision><origin xyz="0 0 0.3"/><geometry><sphere radius="0.05"/></geometry></collision>
    <collision><origin xyz="0.1 0 0"/><geometry><mesh filename="package://lamps/cube.obj"/></geometry></collision>
  </link>
</robot>
"""


def test_urdf_of_one_link(tmp_path: Path) -> None:
    cube = write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    (tmp_path / "lamp.urdf").write_text(URDF)
    mesh = load_mesh(tmp_path / "lamp.urdf", (0.5, 0.5, 0.5))
    assert [part.shape for part in mesh.parts[:3]] == [
        Box((0.1, 0.05, 0.05)),
        Cylinder(0.005, 0.1),
        Sphere(0.025),
    ]
    assert mesh.parts[0].pose.position == (0, 0, 0.025) and mesh.parts[0].pose.yaw == pytest.approx(
        np.pi / 2
    )
    assert np.ptp(hulls(mesh)[0], axis=0) == pytest.approx((0.05, 0.05, 0.05))
    assert mesh.parts[3].pose.position == (0.05, 0, 0)
    warm = (1.0, 0.5, 0.0, 1.0)
    assert mesh.visuals == (Visual(cube, scale=ONE, pose=Pose((0.0, 0.0, 0.05)), colour=warm),)
    assert mesh.colour == (1, 0.5, 0, 1) and set(mesh.files) == {tmp_path / "lamp.urdf", cube}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "</robot>",
            '<link name="shade"/></robot>',
            r"2 links \(lamp, shade\) that no joint holds together",
        ),
        ("0.2 0.1 0.1", "0.2 0.1", "size of <box>: expected 3 numbers"),
        ("0.2 0.1 0.1", "0.2 0.1 -1", "not positive"),
        ("0.2 0.1 0.1", "0.2 0.1 nan", "not positive and finite"),
        ('radius="0.05"', 'radius="x"', "'x' is not made of numbers"),
        (
            "lamps/cube.obj",
            "lamps/cub.obj",
            "names the mesh 'package://lamps/cub.obj', which does not exist",
        ),
        ("</robot>", "", "cannot read 'lamp.urdf'"),
    ],
)
def test_urdf_mistakes(tmp_path: Path, old: str, new: str, message: str) -> None:
    write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    (tmp_path / "lamp.urdf").write_text(URDF.replace(old, new))
    with pytest.raises(InputError, match=message):
        load_mesh(tmp_path / "lamp.urdf")


def test_urdf_is_scaled_alike(tmp_path: Path) -> None:
    (tmp_path / "lamp.urdf").write_text(URDF)
    with pytest.raises(InputError, match="alike in all directions"):
        load_mesh(tmp_path / "lamp.urdf", (1.0, 1.0, 2.0))


def test_flat_points_become_a_thin_hull() -> None:
    square = np.array([(0, 0, 0), (0.1, 0, 0), (0.1, 0.1, 0), (0, 0.1, 0)], dtype=float)
    vertices, _ = hull_of(square)
    assert ConvexHull(vertices).volume == pytest.approx(0.1 * 0.1 * 0.001)
    with pytest.raises(ValueError, match="one line"):
        hull_of(square[:1] * [[1], [2], [3], [4]] + np.arange(4)[:, None] * [1.0, 0, 0])


def test_parts_of_a_mesh_are_in_the_files_frame() -> None:
    mesh = load_mesh(MESHES / "duck_vhacd.obj", (0.05, 0.05, 0.05))
    points = np.concatenate(hulls(mesh))
    surface = read_surface(MESHES / "duck_vhacd.obj", (0.05, 0.05, 0.05))
    assert points.min(axis=0) == pytest.approx(surface.vertices.min(axis=0), abs=0.001)
    assert points.max(axis=0) == pytest.approx(surface.vertices.max(axis=0), abs=0.001)
    assert all(part == Part(part.shape) for part in mesh.parts)
