"""A robot's URDF: its links with their collision elements, its joints with their limits."""

from __future__ import annotations

import importlib.util
import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from tamp.errors import InputError
from tamp.geometric.loading.urdf_link import Element, elements, origin_pose
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.robot.urdf_words import roll_pitch_yaw
from tamp.geometric.scene.pose import Pose

MOVING = ("revolute", "continuous", "prismatic")
KINDS = (*MOVING, "fixed", "floating", "planar")

NEARLY = 2e-4
"""Radians by which an angle of a file may be off a multiple of GRID that was surely meant: the tool
moves by less than 10 um."""

GRID = math.radians(15.0)


@dataclass(frozen=True)
class Description:
    """The contents of a URDF.

    Attributes:
        file: Where it stands.
        links: Collision elements by link.
        masses: Kilograms by link; 0 where the file has none.
        joints: By name.
        efforts: By joint, newton metres or newtons; 0 where the file has none.
        mimics: By joint that follows another: its name, factor and offset.
        root: The link that is no joint's child.
        name: The robot's; empty where the file has none.
    """

    file: Path
    links: Mapping[str, tuple[Element, ...]]
    masses: Mapping[str, float]
    joints: Mapping[str, Joint]
    efforts: Mapping[str, float]
    mimics: Mapping[str, tuple[str, float, float]]
    root: str
    name: str = ""

    def joint_to(self, link: str) -> Joint | None:
        """Return the joint whose child a link is."""
        return next((joint for joint in self.joints.values() if joint.child == link), None)


def find_urdf(name: str) -> Path:
    """Find a URDF or an MJCF: a file, one of the package example-robot-data by its name
    (ur5_robot), or one of pybullet_data by its place there (pybullet_data/kuka_iiwa/model.urdf).

    Raises:
        InputError: There is none.
    """
    file = Path(name)
    if file.is_file():
        return file

    spec = importlib.util.find_spec("pybullet_data")
    if name.startswith("pybullet_data/") and spec is not None and spec.origin is not None:
        file = Path(spec.origin).parent / name.removeprefix("pybullet_data/")
        if file.is_file():
            return file

    if "/" not in name and not name.endswith(".urdf"):
        robots: dict[str, Path] = {}
        for folder in sys.path:
            data = Path(folder) / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
            robots |= {found.stem: found for found in sorted(data.glob("**/*.urdf"))}
        if name in robots:
            return robots[name]
        if robots:
            raise InputError(f"no file and no robot of example-robot-data '{name}'", found=name,
                             choices=tuple(sorted(robots)))  # fmt: skip
    if name.startswith("pybullet_data/") and spec is None:
        raise InputError(
            f"no such file: {name}; pybullet_data is not installed",
            remedy="It comes with pybullet, which has wheels for Python 3.11; name another URDF",
        )
    raise InputError(
        f"no such file: {name}",
        remedy="Name a URDF or an MJCF, or install example-robot-data and name one of its robots",
    )


def read_description(file: Path) -> Description:
    """Read a URDF.

    Raises:
        InputError: It is no URDF, names a link that it does not have, has a loop or several roots;
            a joint without its link, of an unknown type.
    """
    tree = read_xml(file)
    if tree.tag != "robot":
        raise InputError(f"not a URDF: its root is <{tree.tag[:40]}>, not <robot>", file=file)
    if any("xacro" in str(element.tag) for element in tree.iter()):
        raise InputError(
            "it has macros of xacro", file=file,
            remedy="Expand it first: xacro robot.xacro > robot.urdf",
        )  # fmt: skip
    links = {link.get("name", ""): link for link in tree.findall("link")}
    if not links:
        raise InputError("the URDF has no links", file=file)

    joints: dict[str, Joint] = {}
    efforts: dict[str, float] = {}
    mimics: dict[str, tuple[str, float, float]] = {}
    for element in tree.findall("joint"):
        joint = _joint(file, element, links)
        if joint.name in joints:
            raise InputError(f"two joints are called '{joint.name}'", file=file)
        joints[joint.name] = joint
        limit, mimic = element.find("limit"), element.find("mimic")
        efforts[joint.name] = _number(file, limit, "effort", joint.name) or 0.0
        if mimic is not None:
            factor = _number(file, mimic, "multiplier", joint.name)
            offset = _number(file, mimic, "offset", joint.name)
            mimics[joint.name] = (
                mimic.get("joint", ""), 1.0 if factor is None else factor, offset or 0.0,
            )  # fmt: skip

    return Description(
        file=file,
        links={name: elements(file, link, "collision") for name, link in links.items()},
        masses={name: _mass(file, link) for name, link in links.items()},
        joints=joints,
        efforts=efforts,
        mimics=mimics,
        root=_root(file, links, joints),
        name=tree.get("name", ""),
    )


def _joint(file: Path, element: ElementTree.Element, links: Mapping[str, object]) -> Joint:
    name, kind = element.get("name", ""), element.get("type", "")
    if kind not in KINDS:
        raise InputError(f"joint '{name}': unknown type '{kind}'", file=file, found=kind,
                         choices=KINDS)  # fmt: skip
    ends: list[str] = []
    for role in ("parent", "child"):
        end = element.find(role)
        link = "" if end is None else end.get("link", "")
        if link not in links:
            raise InputError(
                f"joint '{name}': its {role} '{link}' is no link", file=file, found=link,
                choices=tuple(links),
            )  # fmt: skip
        ends.append(link)

    axis = element.find("axis")
    words = "1 0 0" if axis is None or kind == "fixed" else axis.get("xyz", "1 0 0")
    try:
        x, y, z = (float(word) for word in words.split())
        length = math.hypot(x, y, z)
        if not 1e-9 < length < math.inf:
            raise ValueError
    except ValueError:
        raise InputError(
            f"joint '{name}': its axis '{words[:60]}' is no direction", file=file
        ) from None

    limit = element.find("limit")
    low, high = (_number(file, limit, key, name) for key in ("lower", "upper"))
    missing = kind in ("revolute", "prismatic") and (low is None and high is None)
    return Joint(
        name, kind, ends[0], ends[1], _snapped(origin_pose(file, element)),
        (x / length, y / length, z / length),
        math.nan if missing else low or 0.0, math.nan if missing else high or 0.0,
        _number(file, limit, "velocity", name) or 0.0,
    )  # fmt: skip


def _number(
    file: Path, element: ElementTree.Element | None, attribute: str, joint: str
) -> float | None:
    text = None if element is None else element.get(attribute)
    if text is None:
        return None
    try:
        value = float(text)
    except ValueError:
        raise InputError(
            f"joint '{joint}': {attribute} '{text[:60]}' is no number", file=file
        ) from None
    return value if math.isfinite(value) else None


def _mass(file: Path, link: ElementTree.Element) -> float:
    return _number(file, link.find("inertial/mass"), "value", link.get("name", "")) or 0.0


def _root(file: Path, links: Mapping[str, object], joints: Mapping[str, Joint]) -> str:
    parents: dict[str, str] = {}
    for joint in joints.values():
        if joint.child in parents:
            raise InputError(f"the link '{joint.child}' hangs on two joints", file=file)
        parents[joint.child] = joint.parent
    roots = [name for name in links if name not in parents]
    if len(roots) != 1:
        what = (
            f"several roots: {', '.join(roots[:5])}" if roots else "a loop: every link is a child"
        )
        raise InputError(f"the URDF has {what}", file=file)
    for name in links:
        seen = {name}
        while (parent := parents.get(name)) is not None:
            if parent in seen:
                raise InputError(f"the link '{parent}' hangs on itself", file=file)
            seen.add(parent)
            name = parent
    return roots[0]


def _snapped(pose: Pose) -> Pose:
    """Make right what is nearly so: files round a right angle to 1.5708, which closed forms and
    spherical wrists feel.
    """
    angles = np.array(roll_pitch_yaw(pose.rotation))
    grid = np.round(angles / GRID) * GRID
    near = np.abs(angles - grid) <= NEARLY
    if not near.any():
        return pose
    roll, pitch, yaw = (float(angle) for angle in np.where(near, grid, angles))
    matrix = Pose.from_xyz_rpy(pose.position, (roll, pitch, yaw)).matrix.copy()
    matrix[np.abs(matrix) < 1e-12] = 0.0
    return Pose.from_matrix(matrix)
