"""Shapes of an MJCF as a URDF's collision elements: sizes whole instead of half, poses, meshes as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from tamp.commands.robot_folder.convex import solids
from tamp.commands.robot_folder.mjcf_shapes import Shapes, add_origin, pose_matrix
from tamp.geometric.loading.urdf_link import Capsule, Element, elements
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere
from tamp.simulation.mujoco_model import load_mujoco

MUJOCO: Any = load_mujoco()
XML = """<mujoco><compiler angle="radian"/><asset>
  <mesh name="wedge" vertex="0 0 0  .1 0 0  0 .05 0  0 0 .3"/>
  <hfield name="hills" nrow="2" ncol="2" size="1 1 1 1" elevation="0 1 1 0"/></asset>
 <worldbody><body name="b">{}</body></worldbody></mujoco>"""


def read(
    geoms: str, folder: Path, anchor: tuple[float, ...] = (0.0, 0.0, 0.0)
) -> tuple[Any, tuple[Element, ...]]:
    """The compiled model, and all its shapes as the URDF reader reads them."""
    model = MUJOCO.MjModel.from_xml_string(XML.format(geoms))
    link, shapes = ElementTree.Element("link"), Shapes(MUJOCO, model, folder)
    for geom in range(model.ngeom):
        shapes.add(link, geom, np.array(anchor))
    return model, elements(folder / "made.urdf", link, "collision")


@pytest.mark.parametrize(
    ("geom", "shape"),
    [
        ('type="box" size=".1 .2 .3"', Box((0.2, 0.4, 0.6))),
        ('type="sphere" size=".1"', Sphere(0.1)),
        ('type="cylinder" size=".1 .2"', Cylinder(0.1, 0.4)),
        ('type="capsule" size=".1 .2"', Capsule(0.1, 0.4)),
    ],
)
def test_sizes_are_whole(geom: str, shape: object, tmp_path: Path) -> None:
    """MuJoCo counts from the middle; a capsule's length is that of its cylinder in both."""
    _, (found,) = read(f"<geom {geom}/>", tmp_path)
    assert found == Element(Pose(), shape)  # type: ignore[arg-type]


def test_a_pose_is_that_of_the_geom_from_the_links_anchor(tmp_path: Path) -> None:
    text = '<geom type="box" size=".1 .2 .3" pos="1 2 3" euler=".3 -.4 .5"/>'
    model, (found,) = read(text, tmp_path, anchor=(0.5, 0.0, -1.0))
    assert found.pose.position == pytest.approx((0.5, 2.0, 4.0))
    data = MUJOCO.MjData(model)
    MUJOCO.mj_kinematics(model, data)
    assert found.pose.rotation == pytest.approx(data.geom_xmat[0].reshape(3, 3))


def test_a_quaternion_of_mujoco_has_its_real_part_first_and_any_length() -> None:
    half = np.sqrt(0.5)
    for length in (1.0, 3.0):
        T = pose_matrix(np.array([1.0, 2.0, 3.0]), length * np.array([half, 0.0, 0.0, half]))
        assert T[:3, :3] == pytest.approx(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]), abs=1e-9)
        assert T[:3, 3].tolist() == [1.0, 2.0, 3.0]


def test_an_origin_is_read_back_as_the_pose() -> None:
    for angles in np.random.default_rng(0).uniform(-3.0, 3.0, (20, 3)):
        T = Pose.from_xyz_rpy((0.1, -0.2, 1 / 3), tuple(angles)).matrix
        element = ElementTree.Element("collision")
        add_origin(element, T)
        origin = element.find("origin")
        assert origin is not None
        xyz, rpy = ([float(word) for word in origin.get(key, "").split()] for key in ("xyz", "rpy"))
        again = Pose.from_xyz_rpy((xyz[0], xyz[1], xyz[2]), (rpy[0], rpy[1], rpy[2])).matrix
        assert again == pytest.approx(T, abs=1e-9)


def test_planes_and_hills_have_no_end_and_are_left_out(tmp_path: Path) -> None:
    geoms = '<geom type="hfield" hfield="hills"/><geom type="sphere" size=".1"/>'
    model = MUJOCO.MjModel.from_xml_string(
        XML.format(geoms).replace("<worldbody>", '<worldbody><geom type="plane" size="1 1 1"/>')
    )
    link, shapes = ElementTree.Element("link"), Shapes(MUJOCO, model, tmp_path)
    for geom in range(model.ngeom):
        shapes.add(link, geom, np.zeros(3))
    assert [one.tag for one in link.iter() if one.tag in ("sphere", "box", "mesh")] == ["sphere"]
    assert len(link) == 1


def test_a_mesh_is_written_once_where_mujoco_has_it(tmp_path: Path) -> None:
    """MuJoCo moves a mesh to its middle and turns it to its axes: shape and pose together are the file's."""
    geoms = '<geom type="mesh" mesh="wedge"/><geom type="mesh" mesh="wedge" pos="1 0 0"/>'
    _, found = read(geoms, tmp_path)
    assert found[0].mesh == found[1].mesh
    assert len(list(tmp_path.iterdir())) == 1
    for element, x in zip(found, (0.0, 1.0), strict=True):
        (solid,) = solids([element], "b")
        corners = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.05, 0], [0, 0, 0.3]])
        corners = corners + np.array([x, 0.0, 0.0])
        near = np.linalg.norm(solid.vertices[:, None] - corners[None], axis=2)
        assert near.min(axis=0).max() < 1e-6 and near.min(axis=1).max() < 1e-6
        a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        assert volume == pytest.approx(0.1 * 0.05 * 0.3 / 6)


def test_an_ellipsoid_is_a_mesh_of_about_its_size(tmp_path: Path) -> None:
    _, (found,) = read('<geom type="ellipsoid" size=".1 .2 .3" pos="0 0 1"/>', tmp_path)
    (solid,) = solids([found], "b")
    low, high = bounds((Part(solid.hulls[0]),), Pose())
    assert (low + high) / 2 == pytest.approx([0.0, 0.0, 1.0], abs=2e-3)
    assert (high - low) / 2 == pytest.approx([0.1, 0.2, 0.3], rel=0.06)
    scaled = (solid.vertices - [0.0, 0.0, 1.0]) / [0.1, 0.2, 0.3]
    assert np.linalg.norm(scaled, axis=1).min() >= 1.0 - 1e-6  # around it
