"""Mesh files that are odd are read; those that are broken are refused in our words, and soon."""

from __future__ import annotations

import logging
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.exchange.stl import export_stl_ascii

from tamp.errors import InputError
from tamp.geometric.loading.collada import read_collada
from tamp.geometric.loading.mesh_file import MOST_BYTES, Beside, read_triangles
from tamp.geometric.loading.meshes import find_mesh, load_mesh

TETRAHEDRON = "v 0 0 0\nv 0.05 0 0\nv 0 0.06 0\nv 0 0 0.07\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
BOX = trimesh.creation.box((0.06, 0.08, 0.14))
STL = export_stl_ascii(BOX).encode()


def exported(kind: str, **options: str) -> bytes:
    made = BOX.export(file_type=kind, **options)
    assert isinstance(made, bytes)
    return made


PLY, BINARY_PLY = exported("ply", encoding="ascii"), exported("ply")
BINARY_STL, GLB = exported("stl"), exported("glb")


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "cache"))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        (
            "a.obj",
            b"# gr\xfc\xdfe\nmtllib b\xe4r.mtl\no \xc4\nusemtl \xd6l\n" + TETRAHEDRON.encode(),
        ),
        ("a.obj", TETRAHEDRON.encode("utf-16")),
        ("a.obj", b"\xef\xbb\xbf" + TETRAHEDRON.encode()),
        ("a.obj", TETRAHEDRON.replace("\n", "\r").encode()),
        ("a.obj", TETRAHEDRON.replace("f 1 3 2", "f 1 \\\n3 2").encode()),
        ("a.obj", TETRAHEDRON.replace("f 1 3 2", "f -4 -2 -3").encode()),
        ("a.obj", b"mtllib /dev/zero\nusemtl a\n" + TETRAHEDRON.encode()),
        ("a.stl", STL),
        ("a.stl", STL.replace(b"solid", b"solid gr\xfc\xdfe", 1)),
        ("a.stl", BINARY_STL),
        ("a.stl", b"solid \xff" + BINARY_STL[7:]),
        ("a.ply", PLY),
        ("a.ply", PLY.replace(b"ply\n", b"ply\ncomment gr\xfc\xdfe\n", 1)),
        ("a.ply", BINARY_PLY),
        ("a.glb", GLB),
    ],
)
def test_odd_files_are_read(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    mesh = load_mesh(tmp_path / name)
    assert len(mesh.parts) == 1 and not mesh.warnings
    size = (0.05, 0.06, 0.07) if name.endswith("obj") else (0.06, 0.08, 0.14)
    assert np.ptp(mesh.parts[0].shape.vertices, axis=0) == pytest.approx(size)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        (
            "a.obj",
            TETRAHEDRON.replace("v 0 0 0.07", "v 0 0").encode(),
            "no three coordinates|cannot read",
        ),
        (
            "a.obj",
            TETRAHEDRON.replace("f 1 4 3", "f 0 4 3").encode(),
            "corner 0, but they count from 1",
        ),
        (
            "a.obj",
            TETRAHEDRON.replace("f 1 4 3", "f 1 4 99999999999").encode(),
            "missing corner|does not hold",
        ),
        ("a.obj", TETRAHEDRON.replace("0.07", "1e308").encode(), "m large"),
        ("a.stl", STL[: len(STL) // 2], "cut off"),
        ("a.stl", BINARY_STL[:96] + b"\x00\x00\xa0\x7f" + BINARY_STL[100:], "not finite"),
        ("a.stl", BINARY_STL[:-100], "its header tells of 12 triangles, it holds 10"),
        ("a.stl", BINARY_STL[:80] + struct.pack("<I", 4_000_000_000) + BINARY_STL[84:], "cut off"),
        ("a.ply", PLY[:-80], "cut off"),
        ("a.ply", BINARY_PLY[:-50], "cannot read"),
        ("a.ply", BINARY_PLY.replace(b"vertex 8", b"vertex 8000000000"), "cut off"),
        ("a.ply", PLY.replace(b"face 12", b"face 1200000000"), "cut off"),
        ("a.ply", PLY.replace(b"face 12", b"face many"), "no number of elements"),
        ("a.glb", GLB[: len(GLB) // 2], "cut off"),
        ("a.gltf", b"[" * 100_000, "no glTF file"),
        (
            "a.gltf",
            b'{"asset": {"version": "2.0"}, "accessors": [{"count": 4000000000}]}',
            "claims too many",
        ),
        (
            "a.gltf",
            b'{"asset": {"version": "2.0"}, "accessors": [{"count": -1}]}',
            "claims too many",
        ),
        ("a.dae", b"<COLLADA>", "no element found"),
        ("a.dae", b"<svg/>", "it is no COLLADA file, but <svg>"),
        ("a.urdf", b"<a>" * 100_000, "cannot read"),
    ],
)
def test_broken_files_are_refused_in_our_words(
    tmp_path: Path, name: str, content: bytes, message: str, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / name).write_bytes(content)
    with caplog.at_level(logging.DEBUG), pytest.raises(InputError, match=message) as caught:
        load_mesh(tmp_path / name)
    assert (
        name in caught.value.message
        and "\n" not in str(caught.value)
        and len(str(caught.value)) < 400
    )
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


def test_names_that_are_none(tmp_path: Path) -> None:
    for name in ("a" * 300 + ".obj", "a/" * 3000 + "b.obj", "a\0b.obj"):
        with pytest.raises(InputError, match="no mesh file") as caught:
            find_mesh(name, tmp_path)
        assert len(caught.value.message) < 200


def test_what_is_too_large_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "a.obj").open("wb") as stream:
        stream.truncate(MOST_BYTES * 100)
    with pytest.raises(InputError, match=f"larger than {MOST_BYTES / 1e6:g} MB"):
        load_mesh(tmp_path / "a.obj")


def test_files_beside_a_mesh_only(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.mtl").write_bytes(b"newmtl \xe4")
    (tmp_path / "secret").write_text("secret")
    (tmp_path / "in" / "link").symlink_to(tmp_path / "secret")
    beside = Beside(tmp_path / "in")
    assert beside.get("a.mtl") == b"newmtl _"
    for name in ("../secret", str(tmp_path / "secret"), "link", "gone", "/dev/zero"):
        with pytest.raises(InputError):
            beside.get(name)


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 5 0 0 0 6 0 0 0 7</float_array></source>
  <source id="n"><float_array id="na" count="3">0 0 1</float_array></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  GROUP
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node>
  NODE<instance_geometry url="#g"/>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""
INPUTS = '<input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>'
GROUP = f'<triangles count="4">{INPUTS}<p>0 0 2 0 1 0  0 0 1 0 3 0  1 0 2 0 3 0  0 0 3 0 2 0</p></triangles>'


def test_transforms_beyond_all_numbers_are_refused_without_a_warning(tmp_path: Path) -> None:
    far = "<scale>1e200 1e200 1e200</scale>" * 2
    (tmp_path / "a.dae").write_text(DAE.replace("GROUP", GROUP).replace("NODE", far))
    with pytest.raises(InputError, match="not finite"):
        load_mesh(tmp_path / "a.dae")


@pytest.mark.parametrize(
    ("node", "low", "high"),
    [
        ("", (0, 0, 0), (0.05, 0.06, 0.07)),
        ("<translate>100 0 0</translate>", (1, 0, 0), (1.05, 0.06, 0.07)),
        ("<scale>2 1 1</scale>", (0, 0, 0), (0.1, 0.06, 0.07)),
        ("<rotate>0 0 1 90</rotate>", (-0.06, 0, 0), (0, 0.05, 0.07)),
        ("<matrix>1 0 0 0 0 1 0 0 0 0 -1 10 0 0 0 1</matrix>", (0, 0, 0.03), (0.05, 0.06, 0.1)),
        ("<translate>0 0 10</translate><scale>1 1 2</scale>", (0, 0, 0.1), (0.05, 0.06, 0.24)),
    ],
)
def test_colladas_unit_and_nodes_count(
    tmp_path: Path, node: str, low: tuple[float, ...], high: tuple[float, ...]
) -> None:
    (tmp_path / "a.dae").write_text(DAE.replace("NODE", node).replace("GROUP", GROUP))
    vertices, faces = read_triangles(tmp_path / "a.dae")
    assert vertices.min(axis=0) == pytest.approx(low, abs=1e-12) and vertices.max(
        axis=0
    ) == pytest.approx(high)
    a, b, c = vertices[faces].transpose(1, 0, 2)
    volume = (
        np.einsum(
            "ij,ij->", a - vertices.mean(axis=0), np.cross(b, c) - np.cross(b, a) - np.cross(a, c)
        )
        / 6
    )
    assert volume > 0  # outward, mirrored or not


@pytest.mark.parametrize(
    "group",
    [
        GROUP,
        f'<polylist count="4">{INPUTS}<vcount>3 3 3 3</vcount>'
        + GROUP.partition(INPUTS)[2].replace("triangles", "polylist"),
        f"<polygons>{INPUTS}<p>0 0 2 0 1 0</p><p>0 0 1 0 3 0</p><p>1 0 2 0 3 0</p><p>0 0 3 0 2 0</p></polygons>",
        f"<tristrips>{INPUTS}<p>0 0 2 0 1 0 3 0 0 0 2 0</p></tristrips>",
    ],
)
def test_colladas_ways_to_say_triangles(tmp_path: Path, group: str) -> None:
    (tmp_path / "a.dae").write_text(DAE.replace("NODE", "").replace("GROUP", group))
    vertices, faces = read_collada(tmp_path / "a.dae", 10_000)
    assert len(faces) == 4 and len(vertices) == 4
    assert {tuple(sorted(face)) for face in faces.tolist()} == {
        (0, 1, 2),
        (0, 1, 3),
        (1, 2, 3),
        (0, 2, 3),
    }
    assert load_mesh(tmp_path / "a.dae").parts


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('url="#g"', 'url="#h"', "shows '#h', which it does not hold"),
        ('meter="0.01"', 'meter="0"', "its unit is 0 m"),
        ('meter="0.01"', 'meter="far"', "<unit> is not made of numbers"),
        ("0 0 2 0 1 0 ", "0 0 2 0 9 0 ", "a face names a missing corner"),
        ("0 0 2 0 1 0 ", "0 0 2 0 x 0 ", "not made of whole numbers"),
        ("0 0 0 5 0 0", "0 0 0 five 0 0", "<float_array> is not made of numbers"),
        ("NODE", "<translate>1 2</translate>", "<translate> has 2 numbers, not 3"),
        ("NODE", "<node>" * 200 + "</node>" * 200, "nested too deeply"),
        ("<node>\n", '<node id="me"><instance_node url="#me"/>', "nested too deeply"),
    ],
)
def test_broken_collada(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = DAE.replace("GROUP", GROUP)
    assert text.count(old) == 1
    (tmp_path / "a.dae").write_text(text.replace(old, new).replace("NODE", ""))
    with pytest.raises(InputError, match=message):
        load_mesh(tmp_path / "a.dae")
