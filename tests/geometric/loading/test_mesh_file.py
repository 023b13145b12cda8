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
from tamp.geometric.loading.mesh_file import MOST_BYTES, Beside
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


pytestmark = pytest.mark.usefixtures("own_cache")


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
