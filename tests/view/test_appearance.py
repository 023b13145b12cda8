"""What a body's file shows: all its visual elements, or its collision shape when one cannot be read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from tamp.geometric.loading.meshes import load_mesh
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Visual
from tamp.view.appearance import body_meshes, undrawable

TETRAHEDRON = "v 0 0 0\nv 0.05 0 0\nv 0 0.06 0\nv 0 0 0.07\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
URDF = """
<robot name="lamp"><link name="a">
<visual><geometry><mesh filename="shown.{}"/></geometry><material name="m"><color rgba="1 0 0 1"/></material></visual>
<visual><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
<collision><geometry><box size="0.06 0.08 0.14"/></geometry></collision></link></robot>
"""


def body_of(folder: Path, suffix: str, content: bytes) -> Body:
    (folder / f"shown.{suffix}").write_bytes(content)
    (folder / "lamp.urdf").write_text(URDF.format(suffix))
    mesh = load_mesh(folder / "lamp.urdf")
    return Body("lamp", mesh.parts, Pose(), True, visuals=mesh.visuals)


@pytest.mark.parametrize("suffix", ["obj", "stl", "ply", "glb"])
def test_every_visual_element_is_drawn(tmp_path: Path, suffix: str) -> None:
    box = trimesh.creation.box((0.2, 0.3, 0.4))
    exported = box.export(file_type=suffix)
    content = exported.encode() if isinstance(exported, str) else bytes(exported)
    body = body_of(tmp_path, suffix, content)
    first, second = body_meshes(body)
    assert np.ptp(first.vertices, axis=0) == pytest.approx((0.2, 0.3, 0.4)) and first.colour == (
        1,
        0,
        0,
        1,
    )
    assert second.vertices.mean(axis=0) == pytest.approx((0, 0, 1)) and second.colour == body.colour
    assert undrawable([body]) == ()


@pytest.mark.parametrize(
    ("suffix", "content"),
    [
        ("obj", b"hello"),
        ("obj", b"\0" * 500),
        ("obj", TETRAHEDRON.replace("0.07", "nan").encode()),
        ("stl", b"x" * 50),
        ("dae", b"<COLLADA"),
        ("glb", b"glTF" + b"\xff" * 50),
        ("gltf", b"{}"),
        ("fbx", b"x"),
    ],
)
def test_a_broken_drawing_gives_way_to_the_collision_shape(
    tmp_path: Path, suffix: str, content: bytes
) -> None:
    body = body_of(tmp_path, suffix, content)
    (mesh,) = body_meshes(body)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx((0.06, 0.08, 0.14))
    (sentence,) = undrawable([body])
    assert sentence.startswith("lamp: ") and sentence.endswith(": its collision shape is drawn")


def test_a_mirrored_drawing_stays_outside(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(TETRAHEDRON)
    parts = load_mesh(tmp_path / "a.obj").parts
    body = Body("a", parts, Pose(), True, visuals=(Visual(tmp_path / "a.obj"),))
    for scale in ((1.0, 1.0, 1.0), (-1.0, 1.0, 1.0)):
        (mesh,) = body_meshes(replace(body, visuals=(Visual(tmp_path / "a.obj", scale=scale),)))
        a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
        assert float(np.einsum("ij,ij->", a, np.cross(b, c))) > 0
        assert (mesh.vertices[:, 0].min() < 0) == (scale[0] < 0)
