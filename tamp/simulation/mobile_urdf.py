"""The robot's URDF with the joints that its base drives on."""

from __future__ import annotations

import re
from xml.etree import ElementTree
from xml.sax.saxutils import escape, quoteattr

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.urdf_words import roll_pitch_yaw
from tamp.geometric.scene.scene import Box

BASE_JOINTS = ("base_x", "base_y", "base_yaw")
"""Their names: along x and y of the world, then about z."""

ROOT_LINK = "tamp_ground"
"""The link that the base drives on, which no robot of a user has."""

BASE_MASS = 100.0
"""Kilograms: heavy enough for an arm's swing not to shake it."""

_INERTIAL = (
    '<inertial><mass value="{}"/>'
    '<inertia ixx="5" ixy="0" ixz="0" iyy="5" iyz="0" izz="5"/></inertial>'
)
_LIMIT = '<limit lower="-200000" upper="200000" effort="100000" velocity="10"/>'


def mobile_urdf(robot: Robot) -> str:
    """Write the URDF of the robot's arms and hands on a base that slides along x and y and turns.
    Meshes by full path.

    Raises:
        InputError: The robot's base is not one box.
    """
    base = robot.link(robot.base)
    if len(base.parts) != 1 or not isinstance(base.parts[0].shape, Box):
        raise InputError(f"the base of the robot '{robot.name}' must be one box")

    size = " ".join(map(str, base.parts[0].shape.size))
    at = " ".join(map(str, base.parts[0].pose.position))
    x, y, yaw = BASE_JOINTS
    name = quoteattr(base.name)

    links = f"""
  <link name="{ROOT_LINK}"/>
  <link name="{x}_slide">{_INERTIAL.format(20)}</link>
  <link name="{y}_slide">{_INERTIAL.format(20)}</link>
  <link name={name}>{_INERTIAL.format(BASE_MASS)}
    <collision><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></collision></link>
  <joint name="{x}" type="prismatic"><parent link="{ROOT_LINK}"/><child link="{x}_slide"/>
    <axis xyz="1 0 0"/>{_LIMIT}</joint>
  <joint name="{y}" type="prismatic"><parent link="{x}_slide"/><child link="{y}_slide"/>
    <axis xyz="0 1 0"/>{_LIMIT}</joint>
  <joint name="{yaw}" type="revolute"><parent link="{y}_slide"/><child link={name}/>
    <axis xyz="0 0 1"/>{_LIMIT}</joint>
{"".join(_mount(base.name, arm) for arm in robot.arms)}"""

    if robot.beside:
        arms = "".join(map(_renamed, robot.arms))
        return f"<robot name={quoteattr(robot.name)}>{links}{arms}</robot>"
    return re.sub(r"(<robot[^>]*>)", lambda match: match[1] + links, _text(robot), count=1)


def _mount(base: str, arm: Robot) -> str:
    """Write the joint that fixes an arm's foot to the base."""
    at = " ".join(map(str, arm.T_base_arm.position))
    turned = " ".join(map(str, roll_pitch_yaw(arm.T_base_arm.rotation)))
    name = quoteattr(f"tamp_{arm.prefix}mount")
    return f"""  <joint name={name} type="fixed">
    <parent link={quoteattr(base)}/><child link={quoteattr(arm.foot)}/>
    <origin xyz="{at}" rpy="{turned}"/></joint>
"""


def _text(arm: Robot) -> str:
    """Read an arm's own description, with its meshes by full path."""
    folder = escape(str(arm.urdf.parent), {'"': "&quot;", "'": "&apos;"})
    return arm.urdf.read_text(encoding="utf-8").replace("package://", f"{folder}/")


def _renamed(arm: Robot) -> str:
    """Write the links and joints of one of several arms with names of their own; what is only seen
    is left out, whose colours have names as well.
    """
    root = ElementTree.fromstring(_text(arm))
    kept = [element for element in root if element.tag in ("link", "joint")]
    for element in kept:
        for visual in element.findall("visual"):
            element.remove(visual)
        for one, key in (
            (element, "name"), *((end, "link") for end in element.iterfind("parent")),
            *((end, "link") for end in element.iterfind("child")),
            *((master, "joint") for master in element.iterfind("mimic")),
        ):  # fmt: skip
            one.set(key, arm.prefix + str(one.get(key)))
    return "".join(ElementTree.tostring(element, encoding="unicode") for element in kept)
