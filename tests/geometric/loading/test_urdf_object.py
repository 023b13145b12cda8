"""A URDF file as one body: links held together, inertia, friction, drawings that are not there, odd text."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.meshes import load_mesh
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere

BRICK = (
    '<robot name="brick"><link name="b">{}<collision><geometry>'
    '<box size="0.06 0.08 0.14"/></geometry></collision></link></robot>'
)
TETRAHEDRON = "v 0 0 0\nv 0.05 0 0\nv 0 0.06 0\nv 0 0 0.07\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


pytestmark = pytest.mark.usefixtures("own_cache")


def written(folder: Path, text: str | bytes, name: str = "thing.urdf") -> Path:
    file = folder / name
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return file


TREE = """
<robot name="tree">
  <link name="world"/>
  <link name="leaf"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision></link>
  <link name="trunk"><collision><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
  <joint name="b" type="TYPE"><parent link="trunk"/><child link="leaf"/>
    <origin xyz="0 0 0.5" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="a" type="fixed"><parent link="world"/><child link="trunk"/>
    <origin xyz="1 0 0.5" rpy="0 0 1.5707963267948966"/></joint>
</robot>
"""


def test_fixed_joints_hold_links_together(tmp_path: Path) -> None:
    mesh = load_mesh(written(tmp_path, TREE.replace("TYPE", "fixed")))
    leaf, trunk = mesh.parts
    assert trunk.pose.position == pytest.approx((1, 0, 0.5)) and not mesh.warnings
    # Yaw 90 degrees, then roll 90 degrees: the leaf's z points along the world's x.
    assert leaf.pose.position == pytest.approx((1.1, 0, 1.0))
    low, high = bounds((leaf,), Pose())
    assert high - low == pytest.approx((0.3, 0.1, 0.2))


@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic", "floating"])
def test_movable_joints_are_held_at_zero_and_said(tmp_path: Path, kind: str) -> None:
    mesh = load_mesh(written(tmp_path, TREE.replace("TYPE", kind)))
    assert mesh.warnings == (
        "'thing.urdf': its joint b is held at 0, for an object is one rigid body",
    )
    assert mesh.parts == load_mesh(written(tmp_path, TREE.replace("TYPE", "fixed"))).parts


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<child link="leaf"/>', '<child link="world"/>', "1 links|joints in a circle|hold"),
        ('<child link="leaf"/>', '<child link="trunk"/>', "hangs on two joints"),
        ('<child link="leaf"/>', '<child link="leef"/>', "joint 'b' names the link 'leef'"),
        ('<link name="leaf">', '<link name="trunk">', "two links of the name 'trunk'"),
        ('<box size="0.1 0.2 0.3"/>', "", "empty <geometry>"),
        ('xyz="0 0 0.5"', 'xyz="${h} 0 0"', "Expand it with xacro first"),
    ],
)
def test_what_is_no_one_piece_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert TREE.count(old) == 1
    with pytest.raises(InputError, match=message):
        load_mesh(written(tmp_path, TREE.replace(old, new)))


def test_mass_centre_and_friction_are_read(tmp_path: Path) -> None:
    text = (
        TREE.replace("TYPE", "fixed")
        .replace(
            '<link name="leaf">',
            '<link name="leaf"><inertial><origin xyz="0 0 0.1"/><mass value="1"/></inertial>'
            '<contact><lateral_friction value="0.8"/></contact>',
        )
        .replace('<link name="trunk">', '<link name="trunk"><inertial><mass value="3"/></inertial>')
    )
    mesh = load_mesh(written(tmp_path, text))
    assert mesh.mass == 4 and mesh.friction == 0.8
    assert mesh.center_of_mass == pytest.approx((1.025, 0, 0.625))
    half = load_mesh(tmp_path / "thing.urdf", (0.5, 0.5, 0.5))
    assert half.mass == 4 and half.center_of_mass == pytest.approx((0.5125, 0, 0.3125))


def test_the_problem_counts_more_than_the_file(tmp_path: Path) -> None:
    inertial = (
        '<inertial><origin xyz="0.01 0 0"/><mass value="0.7"/></inertial>'
        '<contact><lateral_friction value="0.9"/></contact>'
    )
    written(tmp_path, BRICK.format(inertial))
    body = "{mesh: thing.urdf, on: table%s}"
    for more, mass, friction in (("", 0.7, 0.9), (", mass: 2, friction: 0.1", 2.0, 0.1)):
        loaded = load_scene(written(tmp_path, SCENE.replace("BRICK", body % more), "scene.yaml"))
        brick = loaded.scene.bodies["a"]
        assert (brick.mass, brick.friction, brick.center_of_mass) == (
            mass,
            friction,
            (0.01, 0.0, 0.0),
        )


@pytest.mark.parametrize(
    ("inertial", "message"),
    [
        ('<inertial><mass value="-1"/></inertial>', "the mass -1 kg of link 'b'"),
        ('<inertial><mass value="x"/></inertial>', "value of <mass>: 'x'"),
        ('<inertial><mass value="nan"/></inertial>', "value of <mass>: 'nan'"),
        ('<inertial><mass value="1"/><origin xyz="a b c"/></inertial>', "xyz of <origin>"),
        (
            '<contact><lateral_friction value="-1"/></contact>',
            "lateral_friction -1 of link 'b' is negative",
        ),
    ],
)
def test_impossible_inertia_is_refused(tmp_path: Path, inertial: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        load_mesh(written(tmp_path, BRICK.format(inertial)))


def test_a_centre_of_mass_out_of_the_shape_is_said(tmp_path: Path) -> None:
    mesh = load_mesh(
        written(
            tmp_path, BRICK.format('<inertial><origin xyz="3 0 0"/><mass value="0"/></inertial>')
        )
    )
    assert (
        mesh.mass is None and mesh.center_of_mass is None and not mesh.warnings
    )  # a mass of 0 says nothing
    mesh = load_mesh(
        written(
            tmp_path, BRICK.format('<inertial><origin xyz="3 0 0"/><mass value="1"/></inertial>')
        )
    )
    assert mesh.mass == 1 and mesh.center_of_mass is None and "out of its shape" in mesh.warnings[0]


@pytest.mark.parametrize(
    "visual",
    [
        '<mesh filename="gone.obj"/>',
        '<mesh filename="package://nowhere/gone.dae"/>',
        '<mesh filename=""/>',
        f'<mesh filename="{"a" * 300}.obj"/>',
        '<mesh filename="empty.obj"/>',
        '<mesh filename="empty.obj" scale="1 x 1"/>',
        '<torus radius="1"/>',
        '<box size="0 1 1"/>',
    ],
)
def test_a_drawing_never_stops_planning(tmp_path: Path, visual: str) -> None:
    written(tmp_path, "", "empty.obj")
    mesh = load_mesh(
        written(tmp_path, BRICK.format(f"<visual><geometry>{visual}</geometry></visual>"))
    )
    assert mesh.parts == (Part(Box((0.06, 0.08, 0.14))),) and mesh.visuals == ()
    assert len(mesh.warnings) == 1 and mesh.warnings[0].endswith(": the collision shape is drawn")


def test_only_visuals_is_said(tmp_path: Path) -> None:
    text = BRICK.format("").replace("collision", "visual")
    mesh = load_mesh(written(tmp_path, text))
    assert (
        len(mesh.parts) == 1
        and "has no collision geometry: what it shows is taken for it" in mesh.warnings[0]
    )
    with pytest.raises(InputError, match=r"neither collision nor visual geometry: .*'gone.obj'"):
        load_mesh(
            written(
                tmp_path,
                text.replace('<box size="0.06 0.08 0.14"/>', '<mesh filename="gone.obj"/>'),
            )
        )


def test_a_simulators_own_geometry_is_replaced_by_what_is_shown(tmp_path: Path) -> None:
    shown = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    text = BRICK.format(shown).replace('<box size="0.06 0.08 0.14"/>', '<cdf filename="x.cdf"/>')
    mesh = load_mesh(written(tmp_path, text))
    assert mesh.parts == (Part(Box((0.1, 0.1, 0.1))),) and "<cdf>" in mesh.warnings[0]
    with pytest.raises(InputError, match="the geometry <cdf>"):
        load_mesh(written(tmp_path, text.replace(shown, "")))


def test_a_capsule_is_a_cylinder_with_balls(tmp_path: Path) -> None:
    text = BRICK.format("").replace(
        '<box size="0.06 0.08 0.14"/>', '<capsule radius="0.03" length="0.1"/>'
    )
    mesh = load_mesh(written(tmp_path, text))
    assert [part.shape for part in mesh.parts] == [Cylinder(0.03, 0.1), Sphere(0.03), Sphere(0.03)]
    low, high = bounds(mesh.parts, Pose())
    assert high - low == pytest.approx((0.06, 0.06, 0.16))


@pytest.mark.parametrize(
    "content",
    [
        b'\n\n<?xml version="1.0"?>\n' + BRICK.format("").encode(),
        b"\xef\xbb\xbf" + b'<?xml version="1.0" encoding="utf-8"?>' + BRICK.format("").encode(),
        b"\xef\xbb\xbf\r\n  " + BRICK.format("").encode() + b"\r\n\0",
        b'<?xml version="1.0" encoding="ISO-8859-1"?>'
        + BRICK.replace("brick", "kr\xfcmel").format("").encode("latin-1"),
        BRICK.replace("brick", "kr\xfcmel").format("").encode("latin-1"),
        b'<?xml version="1.0" encoding="no-such"?>' + BRICK.format("").encode(),
        ('<?xml version="1.0" encoding="utf-16"?>' + BRICK.format("")).encode("utf-16"),
    ],
)
def test_text_as_people_have_it(tmp_path: Path, content: bytes) -> None:
    assert load_mesh(written(tmp_path, content)).parts == (Part(Box((0.06, 0.08, 0.14))),)


@pytest.mark.parametrize(
    ("mesh", "size"),
    [
        ('<mesh filename="t.obj"/>', (0.05, 0.06, 0.07)),
        ('<mesh filename="t.obj" scale="2"/>', (0.1, 0.12, 0.14)),
        ('<mesh filename="t.obj" scale="1, 2, 1"/>', (0.05, 0.12, 0.07)),
        ('<mesh filename=".\\t.obj" scale="-1 1 1"/>', (0.05, 0.06, 0.07)),
        ('<mesh filename="package://things/t.obj" scale="1 1 -2"/>', (0.05, 0.06, 0.14)),
    ],
)
def test_scales_and_mirrors(tmp_path: Path, mesh: str, size: tuple[float, float, float]) -> None:
    written(tmp_path, TETRAHEDRON, "t.obj")
    made = load_mesh(
        written(tmp_path, BRICK.format("").replace('<box size="0.06 0.08 0.14"/>', mesh))
    )
    low, high = bounds(made.parts, Pose())
    assert high - low == pytest.approx(size) and not made.warnings
    assert (low[0] < -0.04) == ("-1 1 1" in mesh) and (low[2] < -0.1) == ("-2" in mesh)
    for part in made.parts:  # outward still
        a, b, c = part.shape.vertices[part.shape.faces].transpose(1, 0, 2)  # type: ignore[union-attr]
        assert float(np.einsum("ij,ij->", a, np.cross(b, c))) > 0


def test_a_turned_mesh_has_the_box_of_its_corners(tmp_path: Path) -> None:
    """The box of a simplified ball is exact to a tenth of a millimetre, however it is turned."""
    angles = np.linspace(0, 2 * math.pi, 120, endpoint=False)
    rows = [
        f"v {0.2 * math.cos(a) * math.cos(t)} {0.3 * math.sin(a) * math.cos(t)} {0.1 * math.sin(t)}"
        for t in np.linspace(-1.5, 1.5, 60)
        for a in angles
    ]
    quads = [
        (120 * i + j, 120 * i + (j + 1) % 120, 120 * (i + 1) + (j + 1) % 120, 120 * (i + 1) + j)
        for i in range(59)
        for j in range(120)
    ]
    written(
        tmp_path,
        "\n".join(rows + ["f " + " ".join(str(k + 1) for k in quad) for quad in quads]),
        "t.obj",
    )
    points = np.array([[float(word) for word in row.split()[1:]] for row in rows])
    rpy = (0.4, -0.7, 1.1)
    mesh = f'<mesh filename="t.obj"/></geometry><origin rpy="{rpy[0]} {rpy[1]} {rpy[2]}" xyz="1 2 3"/><geometry>'
    made = load_mesh(
        written(
            tmp_path,
            BRICK.format("")
            .replace('<box size="0.06 0.08 0.14"/>', mesh)
            .replace("<geometry></geometry>", ""),
        )
    )
    turned = Pose.from_xyz_rpy((1, 2, 3), rpy).apply(points)
    low, high = bounds(made.parts, Pose())
    assert low == pytest.approx(turned.min(axis=0), abs=1e-4) and high == pytest.approx(
        turned.max(axis=0), abs=1e-4
    )


SCENE = """
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [0.8, 0.6, 0.7], at: [1.2, 0, 0]}
  a: BRICK
goal: (on a table)
"""
