"""The highest level face of a body, wherever its parts stand and however it is turned."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.meshes import load_mesh, mesh_triangles
from tamp.geometric.loading.tops import top_of
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere
from tests.needs import MESHES

TOP = Part(Box((0.4, 0.4, 0.04)), Pose((0.0, 0.0, 0.42)))
LEG = Part(Box((0.06, 0.06, 0.4)), Pose((0.15, 0.15, 0.2)))


def box(size: tuple[float, float, float], at: tuple[float, float, float], yaw: float = 0.0) -> Part:
    return Part(Box(size), Pose.from_xyz_yaw(*at, yaw))


def test_the_seat_is_the_top_and_not_the_first_leg() -> None:
    top = top_of("stool", (LEG, TOP))
    assert top is not None and top.name == top.body == "stool"
    assert top.pose.position == pytest.approx((0, 0, 0.44)) and top.size == pytest.approx(
        (0.4, 0.4)
    )
    assert top.pose.quaternion == (0.0, 0.0, 0.0, 1.0) and top.clearance == math.inf


def test_one_box_or_cylinder_is_as_it_was() -> None:
    assert top_of("a", (Part(Box((0.1, 0.2, 0.3))),)) is not None
    top = top_of("can", (Part(Cylinder(0.1, 0.2)),))
    assert (
        top is not None
        and top.size == pytest.approx((0.1 * 2**0.5,) * 2)
        and top.pose.position[2] == 0.1
    )
    assert top_of("ball", (Part(Sphere(0.1)),)) is None


def test_a_seat_is_preferred_to_the_edge_of_its_back() -> None:
    back = box((0.4, 0.03, 0.5), (0.0, 0.185, 0.65))
    top = top_of("chair", (TOP, back))
    assert top is not None and top.pose.position == pytest.approx((0.0, -0.015, 0.44))
    assert top.size == pytest.approx((0.4, 0.37))


def test_two_boards_at_one_height_are_one_top() -> None:
    top = top_of(
        "desk", (box((0.3, 0.4, 0.02), (-0.15, 0, 0.5)), box((0.3, 0.4, 0.02), (0.15, 0, 0.5)))
    )
    assert (
        top is not None
        and top.size == pytest.approx((0.6, 0.4))
        and top.pose.position == pytest.approx((0, 0, 0.51))
    )


def test_a_turned_board_keeps_its_sides() -> None:
    yaw = math.radians(30)
    top = top_of("board", (LEG, box((0.6, 0.2, 0.02), (0.1, 0.2, 0.5), yaw)))
    assert top is not None and sorted(top.size) == pytest.approx([0.2, 0.6])
    corners = top.pose.apply(
        np.array([[x * top.size[0] / 2, y * top.size[1] / 2, 0] for x in (-1, 1) for y in (-1, 1)])
    )
    local = box((1, 1, 1), (0.1, 0.2, 0.5), yaw).pose.inverse().apply(corners)
    assert np.abs(local) == pytest.approx(np.tile([0.3, 0.1, 0.01], (4, 1)))


@pytest.mark.parametrize(
    "rpy", [(90, 0, 0), (0, 90, 0), (180, 0, 30), (-90, 0, 77), (0, -90, -160)]
)
def test_however_it_lies_the_top_is_level(rpy: tuple[float, float, float]) -> None:
    stance = Pose.from_xyz_rpy((3, -2, 1), tuple(math.radians(angle) for angle in rpy))  # type: ignore[arg-type]
    parts = (box((0.2, 0.3, 0.4), (0.1, 0.0, 0.2)),)
    top = top_of("block", parts, stance)
    assert top is not None
    placed = stance @ top.pose
    assert placed.rotation[2] == pytest.approx((0, 0, 1), abs=1e-9)
    corners = stance.apply(
        parts[0].pose.apply(
            np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.15, 0.15) for z in (-0.2, 0.2)])
        )
    )
    assert placed.position[2] == pytest.approx(corners[:, 2].max())
    assert placed.position[:2] == pytest.approx(corners[:, :2].mean(axis=0))


def test_what_hangs_over_it_is_its_clearance() -> None:
    roof = box((0.4, 0.04, 0.02), (0.0, 0.0, 0.80))
    top = top_of("desk", (TOP, roof))
    assert top is not None and top.pose.position[2] == pytest.approx(0.44)
    assert top.clearance == pytest.approx(0.79 - 0.44)


def test_an_edge_or_a_slope_is_no_top() -> None:
    assert (
        top_of("edges", (box((0.3, 0.005, 0.2), (0, 0, 0)), box((0.005, 0.3, 0.2), (0, 0, 0))))
        is None
    )
    assert (
        top_of("slope", (Part(Box((0.3, 0.3, 0.1)), Pose.from_xyz_rpy((0, 0, 0), (0.2, 0, 0))),))
        is None
    )


def test_pybullets_table_and_tray() -> None:
    table = load_mesh(MESHES / "table" / "table.urdf")
    top = top_of("table", table.parts)
    assert (
        top is not None
        and top.pose.position == pytest.approx((0, 0, 0.625))
        and top.size == pytest.approx((1.5, 1))
    )
    tray = load_mesh(MESHES / "tray" / "tray.urdf")
    inner = top_of("tray", tray.parts, triangles=mesh_triangles(tray))
    assert inner is not None and inner.pose.position[2] < 0.02 < min(
        inner.size
    )  # its floor, not the air in its corners
    assert top_of("tray", tray.parts) is None  # without the triangles nobody knows


URDF = """
<robot name="stool"><link name="stool">
<collision><origin xyz="0.15 0.15 0.2"/><geometry><box size="0.06 0.06 0.4"/></geometry></collision>
<collision><origin xyz="0 0 0.42"/><geometry><box size="0.4 0.4 0.04"/></geometry></collision>
</link></robot>
"""
SCENE = """
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  stand: {mesh: stool.urdf, at: [1.2, 0, 0], fixed: true}
  can: {cylinder: {radius: 0.03, height: 0.1}, on: stand}
  block: {box: [0.1, 0.2, 0.4], at: [-1, 0, 0.051], rpy: [90 deg, 0, 0], fixed: true}
  pill: {capsule: {radius: 0.02, height: 0.1}, on: block}
  tin: {cylinder: {radius: 0.03, height: 0.1}, at: [1.3, 0.1, 0.491]}
goal: (on can stand)
"""


def test_bodies_stand_on_a_urdf_and_on_a_block_that_lies(tmp_path: Path) -> None:
    (tmp_path / "stool.urdf").write_text(URDF)
    (tmp_path / "scene.yaml").write_text(SCENE)
    loaded = load_scene(tmp_path / "scene.yaml")
    bodies = loaded.scene.bodies
    assert (
        bodies["can"].pose.position == pytest.approx((1.2, 0, 0.44 + 0.05 + 0.001))
        and bodies["can"].support == "stand"
    )
    assert bodies["tin"].support == "stand"
    assert loaded.scene.surfaces["stand"].size == pytest.approx((0.4, 0.4))
    assert bodies["pill"].pose.position[2] == pytest.approx(0.051 + 0.1 + 0.05 + 0.001)
    assert loaded.scene.surfaces["block"].size == pytest.approx((0.1, 0.4))
