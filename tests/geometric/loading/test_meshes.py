"""Meshes: convex pieces cover them closely, whatever the file looks like; what is no solid is refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from tamp.errors import InputError
from tamp.geometric.loading.decomposition import MOST_PIECES, decompose
from tamp.geometric.loading.mesh_pieces import compute_pieces, mesh_pieces, pieces_name
from tamp.geometric.loading.mesh_surface import open_edges, read_surface
from tamp.geometric.loading.meshes import MeshGeometry, find_mesh, load_mesh
from tamp.geometric.scene.convex import hull_of
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Sphere, Visual
from tamp.system.files import cache_folder, shipped
from tests.clock import unhindered
from tests.needs import MESHES, NEEDS_PYBULLET

ONE = (1.0, 1.0, 1.0)
CUBE = [(x, y, z) for x in (0, 0.1) for y in (0, 0.1) for z in (0, 0.1)]
CUBE_FACES = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
    (1, 5, 7), (1, 7, 3),
]  # fmt: skip


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "cache"))


def write_obj(path: Path, vertices: object, faces: object) -> Path:
    rows = [f"v {' '.join(str(float(c)) for c in vertex)}" for vertex in np.asarray(vertices)]
    rows += [f"f {' '.join(str(int(i) + 1) for i in face)}" for face in np.asarray(faces)]
    path.write_text("\n".join(rows) + "\n")
    return path


def corner(width: float = 0.2) -> tuple[Array, Array]:
    """A cube without one octant, closed, (n, 3) and (m, 3): cuts along the notch meet inside it."""
    half = width / 2
    full = [
        (i, j, k) for i in range(2) for j in range(2) for k in range(2) if (i, j, k) != (1, 1, 1)
    ]
    squares = []
    for cell in full:
        for axis in range(3):
            for side in (0, 1):
                beside = tuple(c + (2 * side - 1) * (a == axis) for a, c in enumerate(cell))
                if beside in full:
                    continue
                u, v = (axis + 1) % 3, (axis + 2) % 3
                base = np.array(cell, dtype=float)
                base[axis] += side
                steps = [np.eye(3)[u], np.eye(3)[v]]
                square = [base, base + steps[0], base + steps[0] + steps[1], base + steps[1]]
                squares.append(square if side else square[::-1])
    points = np.array(squares).reshape(-1, 3) * half
    vertices, index = np.unique(points, axis=0, return_inverse=True)
    quads = index.reshape(-1, 4)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def beyond(points: Array, pieces: list[Array]) -> Array:
    """How far each point (n, 3) lies outside of the nearest piece, metres; negative inside."""
    distances = [
        (points @ e[:, :3].T + e[:, 3]).max(axis=1)
        for e in (ConvexHull(piece).equations for piece in pieces)
    ]
    return np.min(distances, axis=0)


def on_surface(vertices: Array, faces: Array, count: int) -> Array:
    """Random points (count, 3) on a surface."""
    rng = np.random.default_rng(0)
    corners = vertices[faces]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    weights = rng.dirichlet((1, 1, 1), size=count)
    return np.einsum(
        "ij,ijk->ik", weights, corners[rng.choice(len(faces), size=count, p=areas / areas.sum())]
    )


def hulls(mesh: MeshGeometry) -> list[Array]:
    return [part.shape.vertices for part in mesh.parts if isinstance(part.shape, Hull)]


@pytest.mark.parametrize("name", ["objects/bowl.obj", "objects/mug.obj"])
def test_pieces_contain_a_hollow_mesh_closely(name: str) -> None:
    scale = (0.05,) * 3 if "duck" in name else ONE
    surface = read_surface(find_mesh(name, Path()), scale)  # type: ignore[arg-type]
    pieces = decompose(surface.vertices, surface.faces)
    assert 1 < len(pieces) <= MOST_PIECES
    assert beyond(on_surface(surface.vertices, surface.faces, 5000), pieces).max() < 0.001
    total = sum(ConvexHull(piece).volume for piece in pieces)
    assert total < 0.5 * ConvexHull(surface.vertices).volume or "duck" in name
    assert total < 0.9 * ConvexHull(surface.vertices).volume


def test_pieces_contain_the_solid_where_cuts_meet_inside_it() -> None:
    vertices, faces = corner()
    assert open_edges(faces) == 0
    pieces = decompose(vertices, faces)
    points = np.random.default_rng(0).uniform(0, 0.2, size=(4000, 3))
    solid = points[(points < 0.1).any(axis=1)]
    assert len(solid) > 3000
    assert beyond(solid, pieces).max() < 1e-6
    assert sum(ConvexHull(piece).volume for piece in pieces) == pytest.approx(
        0.2**3 * 7 / 8, rel=0.02
    )


def test_a_nearly_convex_mesh_is_one_hull() -> None:
    mesh = load_mesh(find_mesh("objects/mustard_bottle.obj", Path()))
    assert len(mesh.parts) == 1 and not mesh.warnings
    assert np.ptp(hulls(mesh)[0], axis=0) == pytest.approx((0.095, 0.058, 0.19), abs=1e-6)


def test_hulls_are_closed_turned_outward_and_read_only() -> None:
    mesh = load_mesh(find_mesh("objects/bowl.obj", Path()))
    assert mesh.parts
    for part in mesh.parts:
        assert isinstance(part.shape, Hull)
        vertices, faces = part.shape.vertices, part.shape.faces
        assert open_edges(faces) == 0
        a, b, c = vertices[faces].transpose(1, 0, 2)
        outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - vertices.mean(axis=0))
        assert (outward > 0).all()
        with pytest.raises(ValueError, match="read-only"):
            vertices[0, 0] = 1.0


def test_the_same_file_gives_the_same_pieces() -> None:
    path = find_mesh("objects/mustard_bottle.obj", Path())
    vertices, faces = corner()
    for first, second in ((compute_pieces(path, ONE)[0], compute_pieces(path, ONE)[0]),):
        assert all(
            np.array_equal(a.vertices, b.vertices) for a, b in zip(first, second, strict=True)
        )
    again = decompose(vertices, faces)
    assert all(np.array_equal(a, b) for a, b in zip(decompose(vertices, faces), again, strict=True))


def test_shipped_pieces_are_what_would_be_computed() -> None:
    folder = shipped("problems") / "assets" / "pieces"
    for name, factor in (("objects/mustard_bottle.obj", 1.0), ("objects/mug_col.obj", 0.85)):
        path, scale = find_mesh(name, Path()), (factor,) * 3
        assert (folder / pieces_name(path, scale)).is_file()
        kept, _ = mesh_pieces(path, scale)
        new, _ = compute_pieces(path, scale)
        assert all(np.allclose(a.vertices, b.vertices) for a, b in zip(kept, new, strict=True))
    assert not cache_folder().exists()


def test_the_second_load_reads_the_cache(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "corner.obj", *corner())
    first = load_mesh(path)
    kept = list((cache_folder() / "meshes").iterdir())
    assert [file.suffix for file in kept] == [".npz"]
    started = unhindered()
    second = load_mesh(path)
    assert unhindered() - started < 0.1
    assert all(np.array_equal(a, b) for a, b in zip(hulls(first), hulls(second), strict=True))
    code = (
        "import sys; from pathlib import Path; from tamp.geometric.loading.meshes import load_mesh;"
    )
    code += f"load_mesh(Path({str(path)!r}));"
    code += "print([name for name in ('trimesh', 'scipy') if name in sys.modules])"
    assert (
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        ).stdout
        == "[]\n"
    )
    kept[0].write_bytes(b"broken")
    third = load_mesh(path)
    assert all(np.array_equal(a, b) for a, b in zip(hulls(first), hulls(third), strict=True))
    assert kept[0].stat().st_size > 100


def test_another_content_or_scale_is_another_entry(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    assert np.ptp(hulls(load_mesh(path))[0], axis=0) == pytest.approx((0.1, 0.1, 0.1))
    assert np.ptp(hulls(load_mesh(path, (2.0, 1.0, 0.5)))[0], axis=0) == pytest.approx(
        (0.2, 0.1, 0.05)
    )
    write_obj(path, np.array(CUBE) * 3, CUBE_FACES)
    assert np.ptp(hulls(load_mesh(path))[0], axis=0) == pytest.approx((0.3, 0.3, 0.3))


def test_a_cache_that_cannot_be_written_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "file" / "below"))
    assert load_mesh(write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)).parts


def test_an_open_mesh_is_closed_with_a_warning(tmp_path: Path) -> None:
    mesh = load_mesh(write_obj(tmp_path / "open.obj", CUBE, CUBE_FACES[:-1]))
    assert len(mesh.parts) == 1 and ConvexHull(hulls(mesh)[0]).volume == pytest.approx(0.001)
    assert (
        len(mesh.warnings) == 1
        and "not watertight (3 open edges): they were closed" in mesh.warnings[0]
    )


def test_a_mesh_that_stays_open_is_taken_as_a_surface(tmp_path: Path) -> None:
    vertices, faces = corner()
    keep = ~((vertices[faces][:, :, 2] == 0).all(axis=1))
    keep[:6] &= np.arange(6) % 3 > 0
    mesh = load_mesh(write_obj(tmp_path / "open.obj", vertices, faces[keep]))
    assert mesh.warnings and "not watertight" in mesh.warnings[0]
    assert beyond(on_surface(vertices, faces[keep], 2000), hulls(mesh)).max() < 0.001


def test_corners_apart_and_inside_out_are_repaired(tmp_path: Path) -> None:
    """A triangle soup, as STL holds it, with its corners rounded apart, and a cube turned inside out."""
    soup = np.array(CUBE)[np.array(CUBE_FACES)].reshape(-1, 3)
    apart = soup + np.random.default_rng(0).uniform(-1e-7, 1e-7, soup.shape)
    for points in (soup, apart):
        mesh = load_mesh(write_obj(tmp_path / "soup.obj", points, np.arange(36).reshape(-1, 3)))
        assert len(mesh.parts) == 1
    surface = read_surface(
        write_obj(tmp_path / "out.obj", CUBE, np.array(CUBE_FACES)[:, ::-1]), ONE
    )
    assert surface.volume == pytest.approx(0.001) and not surface.warnings


def test_two_bodies_that_touch_are_closed(tmp_path: Path) -> None:
    vertices = np.concatenate([CUBE, np.add(CUBE, (0.1, 0.1, 0))])
    faces = np.concatenate([CUBE_FACES, np.array(CUBE_FACES) + 8])
    mesh = load_mesh(write_obj(tmp_path / "two.obj", vertices, faces))
    assert not mesh.warnings and len(mesh.parts) == 2
    assert sum(ConvexHull(piece).volume for piece in hulls(mesh)) == pytest.approx(0.002, rel=0.01)


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


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        ([], [], "empty|cannot read"),
        (CUBE, [], "empty|cannot read"),
        ([*CUBE[:-1], (float("nan"), 0, 0)], CUBE_FACES, "not finite"),
        ([*CUBE[:-1], (float("inf"), 0, 0)], CUBE_FACES, "not finite"),
        ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)], "flat"),
        ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)], "one line"),
        ([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 1)], "no area|one line"),
        (np.array(CUBE) * 1000, CUBE_FACES, "100 x 100 x 100 m large.*scale: 0.001"),
        (np.where(np.array(CUBE) > 0, 1e308, -1e308), CUBE_FACES, "inf x inf x inf m large"),
        (np.array(CUBE) / 1000, CUBE_FACES, "m small.*scale: 1000"),
    ],
)
def test_what_is_no_solid_is_refused(
    tmp_path: Path, vertices: object, faces: object, message: str
) -> None:
    path = write_obj(tmp_path / "bad.obj", vertices, faces)
    with pytest.raises(InputError, match=message) as caught:
        load_mesh(path)
    assert "bad.obj" in caught.value.message and "\n" not in str(caught.value)
    assert not cache_folder().exists()


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
