"""One link's geometry in a URDF: shapes, poses, scales, colours, where a mesh is looked for, what is refused."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tamp.errors import InputError
from tamp.geometric.loading import urdf_link
from tamp.geometric.loading.urdf_link import (
    Capsule,
    Element,
    UnknownGeometry,
    elements,
    named_colours,
    origin_pose,
    read_visuals,
)
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Sphere

FILE = Path("folder/thing.urdf")


def link(inside: str, kind: str = "collision") -> ElementTree.Element:
    return ElementTree.fromstring(f"<link><{kind}>{inside}</{kind}></link>")


def one(geometry: str, file: Path = FILE, before: str = "") -> Element:
    (found,) = elements(file, link(f"{before}<geometry>{geometry}</geometry>"), "collision")
    return found


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ('<box size="0.1 0.2 0.3"/>', Box((0.1, 0.2, 0.3))),
        ('<box size=" 0.1,0.2,  0.3 "/>', Box((0.1, 0.2, 0.3))),
        ('<cylinder radius="0.1" length="0.5"/>', Cylinder(0.1, 0.5)),
        ('<sphere radius="1e-2"/>', Sphere(0.01)),
        ('<capsule radius="0.1" length="0.5"/>', Capsule(0.1, 0.5)),
    ],
)
def test_primitives(text: str, shape: object) -> None:
    assert one(text) == Element(Pose(), shape)  # type: ignore[arg-type]


def test_a_pose_is_position_and_angles_about_fixed_axes() -> None:
    """Roll, then pitch, then yaw: x goes by yaw 90 degrees to y; missing parts are nothing."""
    origin = '<origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>'
    pose = one('<sphere radius="1"/>', before=origin).pose
    assert pose.position == (1.0, 2.0, 3.0)
    assert pose.rotation[:, 0] == pytest.approx([0.0, 1.0, 0.0])
    half = one(
        '<sphere radius="1"/>', before='<origin rpy="1.5707963267948966 0 1.5707963267948966"/>'
    ).pose
    assert half.position == (0.0, 0.0, 0.0)
    assert half.rotation[:, 2] == pytest.approx([1.0, 0.0, 0.0])
    assert one('<sphere radius="1"/>', before='<origin xyz=" "/>').pose == Pose()
    assert origin_pose(FILE, None) == Pose()
    assert origin_pose(FILE, ElementTree.fromstring("<joint/>")) == Pose()


def test_only_the_wanted_kind_is_read_and_what_has_no_geometry_is_left() -> None:
    both = ElementTree.fromstring(
        '<link><visual><geometry><sphere radius="1"/></geometry></visual><collision/>'
        '<collision><geometry><sphere radius="2"/></geometry></collision>'
        '<collision><geometry><sphere radius="3"/></geometry></collision></link>'
    )
    assert [one.shape for one in elements(FILE, both, "collision")] == [Sphere(2.0), Sphere(3.0)]
    assert [one.shape for one in elements(FILE, both, "visual")] == [Sphere(1.0)]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('<box size="0.1 0.2"/>', "size of <box>: expected 3 numbers"),
        ('<box size="0.1 0.2 0"/>', "not positive and finite"),
        ('<box size="0.1 0.2 -1"/>', "not positive and finite"),
        ('<box size="0.1 0.2 nan"/>', "not positive and finite"),
        ('<sphere radius="inf"/>', "not positive and finite"),
        ('<sphere radius="2e6"/>', "beyond 1e+06"),
        ("<sphere/>", "expected 1 numbers"),
        ('<sphere radius="${r}"/>', "Expand it with xacro first"),
        ('<sphere radius="big"/>', "not made of numbers"),
        ('<mesh filename=" "/>', "without a file name"),
        ('<mesh filename="none.obj"/>', "'none.obj', which does not exist"),
        ("", "empty <geometry>"),
        ("<plane/>", "which has no end"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(text: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        one(text)
    assert said in str(caught.value)
    assert "thing.urdf" in str(caught.value)


@pytest.mark.parametrize("origin", ['xyz="1 2"', 'rpy="0 0 inf"', 'xyz="a b c"', 'xyz="1e7 0 0"'])
def test_poses_that_are_none(origin: str) -> None:
    with pytest.raises(InputError, match="of <origin>"):
        one('<sphere radius="1"/>', before=f"<origin {origin}/>")


def test_a_simulators_own_geometry_is_told_apart() -> None:
    with pytest.raises(UnknownGeometry, match="<cone>, which is none of box, cylinder"):
        one('<cone radius="1"/>')


def test_too_many_elements_are_refused_before_they_are_all_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(urdf_link, "MOST_ELEMENTS", 3)
    ball = '<collision><geometry><sphere radius="1"/></geometry></collision>'
    wrong = "<collision><geometry/></collision>"
    assert len(elements(FILE, ElementTree.fromstring(f"<link>{ball * 3}</link>"), "collision")) == 3
    with pytest.raises(InputError, match="more than 3 collision elements"):
        elements(FILE, ElementTree.fromstring(f"<link>{ball * 4}{wrong}</link>"), "collision")


@pytest.mark.parametrize(
    ("text", "scale"),
    [
        ("", (1.0, 1.0, 1.0)), ('scale="0.001"', (0.001, 0.001, 0.001)),
        ('scale="1 -1 2"', (1.0, -1.0, 2.0)),
    ],
)  # fmt: skip
def test_scales_are_three_factors_or_one_for_all(
    text: str, scale: tuple[float, ...], tmp_path: Path
) -> None:
    (tmp_path / "m.obj").write_text("")
    found = one(f'<mesh filename="m.obj" {text}/>', tmp_path / "thing.urdf")
    assert (found.scale, found.mesh, found.shape) == (scale, tmp_path / "m.obj", None)


@pytest.mark.parametrize("text", ["1 2", "0", "1 0 1", "1 1 1 1", "nan"])
def test_scales_that_are_none(text: str, tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text("")
    with pytest.raises(InputError, match="scale of <mesh>"):
        one(f'<mesh filename="m.obj" scale="{text}"/>', tmp_path / "thing.urdf")


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("m.obj", "pack/urdf/m.obj"), ("../meshes/m.obj", "pack/meshes/m.obj"),
        ("..\\meshes\\m.obj", "pack/meshes/m.obj"), ("package://pack/meshes/m.obj", "pack/meshes/m.obj"),
        ("model://pack/meshes/m.obj", "pack/meshes/m.obj"), ("package://m.obj", "pack/urdf/m.obj"),
        ("package://renamed/meshes/m.obj", "pack/meshes/m.obj"), ("  m.obj ", "pack/urdf/m.obj"),
    ],
)  # fmt: skip
def test_a_mesh_is_beside_the_file_or_in_a_package_above(
    name: str, file: str, tmp_path: Path
) -> None:
    """A package may lie under another name: then what it contains is looked for above."""
    for place in ("pack/urdf/m.obj", "pack/meshes/m.obj"):
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / place).write_text("")
    found = one(f'<mesh filename="{name}"/>', tmp_path / "pack" / "urdf" / "thing.urdf").mesh
    assert found is not None
    assert found.resolve() == (tmp_path / file).resolve()


def test_a_mesh_by_its_full_path(tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text("")
    other = tmp_path / "elsewhere" / "thing.urdf"
    for name in (f"{tmp_path}/m.obj", f"file://{tmp_path}/m.obj"):
        assert one(f'<mesh filename="{name}"/>', other).mesh == tmp_path / "m.obj"
    with pytest.raises(InputError, match=r"x\.\.\.', which does not exist"):
        one(f'<mesh filename="{"x" * 5000}"/>', other)


MATERIALS = """<robot name="r">
  <material name="red"><color rgba="1 0 0 1"/></material>
  <material name="loud"><color rgba="2 -1 0.5 1"/></material>
  <material name="odd"><color rgba="1 0 0"/></material>
  <material name="words"><color rgba="a b c d"/></material>
  <link name="a"><visual><geometry><sphere radius="1"/></geometry>
    <material name="blue"><color rgba="0 0 1 1"/></material></visual></link>
  <link name="b"><visual><geometry><sphere radius="1"/></geometry><material name="blue"/></visual>
    <visual><geometry><sphere radius="1"/></geometry><material name="red"><color rgba="0 1 0 1"/></material></visual>
    <visual><geometry><sphere radius="1"/></geometry></visual>
    <visual><geometry><sphere radius="1"/></geometry><material name="nobody"/></visual></link>
  <link name="c"/>
</robot>"""


def test_colours_are_an_elements_own_then_by_name_of_the_file_then_of_other_links(
    tmp_path: Path,
) -> None:
    named = named_colours(ElementTree.fromstring(MATERIALS))
    assert named == {
        "red": (1.0, 0.0, 0.0, 1.0), "loud": (1.0, 0.0, 0.5, 1.0), "blue": (0.0, 0.0, 1.0, 1.0),
    }  # fmt: skip
    file = tmp_path / "r.urdf"
    file.write_text(MATERIALS)
    found = read_visuals(file)
    assert [one.colour for one in found["a"]] == [(0.0, 0.0, 1.0, 1.0)]
    assert [one.colour for one in found["b"]] == [
        (0.0, 0.0, 1.0, 1.0), (0.0, 1.0, 0.0, 1.0), None, None,
    ]  # fmt: skip
    assert found["c"] == ()


def test_not_a_number_in_a_colour_is_no_colour_that_spreads() -> None:
    material = ElementTree.fromstring(
        '<r><material name="m"><color rgba="nan 1 1 1"/></material></r>'
    )
    assert all(
        0.0 <= value <= 1.0 and not math.isnan(value) for value in named_colours(material)["m"]
    )
