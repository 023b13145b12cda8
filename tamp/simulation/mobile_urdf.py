"""The robot's URDF with the joints that its base drives on."""

from __future__ import annotations

import re

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.scene import Box

BASE_JOINTS = ("base_x", "base_y", "base_yaw")
"""Their names: along x and y of the world, then about z."""

BASE_MASS = 100.0
"""Kilograms: heavy enough for an arm's swing not to shake it."""

_INERTIAL = (
    '<inertial><mass value="{}"/>'
    '<inertia ixx="5" ixy="0" ixz="0" iyy="5" iyz="0" izz="5"/></inertial>'
)
_LIMIT = '<limit lower="-200000" upper="200000" effort="100000" velocity="10"/>'


def mobile_urdf(robot: Robot) -> str:
    """Write the URDF of the robot's own arm and hand on a base that slides along x and y and turns.
    Meshes by full path.

    Raises:
        InputError: The robot's base is not one box.
    """
    base = robot.link(robot.base)
    if len(base.parts) != 1 or not isinstance(base.parts[0].shape, Box):
        raise InputError(f"the base of the robot '{robot.name}' must be one box")

    size = " ".join(map(str, base.parts[0].shape.size))
    at = " ".join(map(str, base.parts[0].pose.position))
    foot = " ".join(map(str, robot.T_base_arm.position))
    x, y, yaw = BASE_JOINTS

    links = f"""
  <link name="ground"/>
  <link name="{x}_slide">{_INERTIAL.format(20)}</link>
  <link name="{y}_slide">{_INERTIAL.format(20)}</link>
  <link name="{base.name}">{_INERTIAL.format(BASE_MASS)}
    <collision><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></collision></link>
  <joint name="{x}" type="prismatic"><parent link="ground"/><child link="{x}_slide"/>
    <axis xyz="1 0 0"/>{_LIMIT}</joint>
  <joint name="{y}" type="prismatic"><parent link="{x}_slide"/><child link="{y}_slide"/>
    <axis xyz="0 1 0"/>{_LIMIT}</joint>
  <joint name="{yaw}" type="revolute"><parent link="{y}_slide"/><child link="{base.name}"/>
    <axis xyz="0 0 1"/>{_LIMIT}</joint>
  <joint name="mount" type="fixed"><parent link="{base.name}"/><child link="{robot.foot}"/>
    <origin xyz="{foot}"/></joint>
"""

    text = robot.urdf.read_text(encoding="utf-8").replace("package://", f"{robot.urdf.parent}/")
    return re.sub(r"(<robot[^>]*>)", lambda match: match[1] + links, text, count=1)
