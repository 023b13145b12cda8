"""Joints and collision meshes of a URDF file: what is left out has its defaults, frames are applied."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import ParseError

import numpy as np
import pytest

from tamp.geometric.robot.urdf import Joint, read_collision_vertices, read_joints
from tamp.geometric.scene.pose import Pose

URDF = """<?xml version="1.0"?>
<robot name="arm">
  <link name="foot"/>
  <link name="upper">
    <visual><geometry><mesh filename="package://upper.obj"/></geometry></visual>
    <collision>
      <origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
      <geometry><mesh filename="package://meshes/upper.obj"/></geometry>
    </collision>
  </link>
  <link name="lower"><collision><geometry><mesh filename="meshes/upper.obj"/></geometry></collision></link>
  <link name="box"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <joint name="turn" type="revolute">
    <origin xyz="0.1 0.2 0.3" rpy="0 0.5 0"/><axis xyz="0 0 -1"/>
    <parent link="foot"/><child link="upper"/>
    <limit lower="-1.5" upper="2" velocity="3" effort="9"/>
  </joint>
  <joint name="weld" type="fixed"><parent link="upper"/><child link="lower"/></joint>
  <joint name="half" type="prismatic">
    <origin xyz="0 0 1"/><parent link="lower"/><child link="box"/><limit upper="0.4"/>
  </joint>
  <transmission><joint name="turn"><hardwareInterface>Effort</hardwareInterface></joint></transmission>
</robot>
"""
OBJ = "# cube\nv 1 0 0\nv 0 2.5 0 1.0\nvn 9 9 9\nvt 8 8\n v 7 7 7\nv 0 0 -3e-1\nf 1 2 3\n"


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "upper.obj").write_text(OBJ)
    file = tmp_path / "arm.urdf"
    file.write_text(URDF)
    return file


def test_joints_are_read_by_name_in_the_file_s_order(urdf: Path) -> None:
    joints = read_joints(urdf)
    assert list(joints) == ["turn", "weld", "half"]
    assert joints["turn"] == Joint(
        "turn", "revolute", "foot", "upper", Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.0, 0.5, 0.0)),
        (0.0, 0.0, -1.0), -1.5, 2.0, 3.0,
    )  # fmt: skip


def test_what_is_left_out_is_at_the_origin_along_x_and_without_way(urdf: Path) -> None:
    joints = read_joints(urdf)
    assert joints["weld"] == Joint(
        "weld", "fixed", "upper", "lower", Pose(), (1.0, 0.0, 0.0), 0.0, 0.0, 0.0
    )
    half = joints["half"]
    assert (half.lower, half.upper, half.velocity) == (0.0, 0.4, 0.0)
    assert half.origin == Pose((0.0, 0.0, 1.0))


def test_a_meshs_vertices_are_in_the_links_frame(urdf: Path) -> None:
    """A quarter turn about z and (1, 2, 3) further; lines of other kinds are no vertices."""
    vertices = read_collision_vertices(urdf)
    assert vertices.keys() == {"upper", "lower"}
    assert vertices["lower"] == pytest.approx(np.array([[1, 0, 0], [0, 2.5, 0], [0, 0, -0.3]]))
    assert vertices["upper"] == pytest.approx(np.array([[1, 3, 3], [-1.5, 2, 3], [1, 2, 2.7]]))
    assert math.isclose(float(vertices["upper"][2, 2]), 2.7)


def test_files_that_are_missing_or_no_xml_are_errors(urdf: Path) -> None:
    (urdf.parent / "meshes" / "upper.obj").unlink()
    with pytest.raises(FileNotFoundError):
        read_collision_vertices(urdf)
    urdf.write_text("<robot>")
    for read in (read_joints, read_collision_vertices):
        with pytest.raises(ParseError):
            read(urdf)
        with pytest.raises(FileNotFoundError):
            read(urdf.parent / "gone.urdf")
