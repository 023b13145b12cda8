"""The joints and collision meshes in a robot's URDF file, read with the standard library."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array, Pose

if TYPE_CHECKING:
    from jaxtyping import Float


@dataclass(frozen=True)
class Joint:
    """A joint of a robot.

    Attributes:
        origin: T_parent_joint: the child's frame in the parent link's frame when the joint stands
            at 0.
        axis: Unit vector in the joint's frame: rotation about it (radians), or translation along it
            (metres).
        lower, upper: Limits in radians, or metres for a prismatic joint; 0 for a fixed one.
        velocity: Largest speed, radians (metres) per second.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    axis: tuple[float, float, float]
    lower: float
    upper: float
    velocity: float


def read_joints(urdf: Path) -> dict[str, Joint]:
    """Read all joints of a URDF file by name, in the file's order.

    Raises:
        FileNotFoundError, xml.etree.ElementTree.ParseError: The file is missing or not XML.
    """
    joints = {}
    for element in ElementTree.parse(urdf).getroot().iter("joint"):
        parent, child, limit = element.find("parent"), element.find("child"), element.find("limit")
        if parent is None or child is None:
            continue  # a mention of a joint in a transmission, not a joint
        limits = {} if limit is None else limit.attrib
        joints[element.attrib["name"]] = Joint(
            name=element.attrib["name"],
            kind=element.attrib["type"],
            parent=parent.attrib["link"],
            child=child.attrib["link"],
            origin=_read_origin(element),
            axis=_vector(element.find("axis"), "xyz", (1.0, 0.0, 0.0)),
            lower=float(limits.get("lower", 0.0)),
            upper=float(limits.get("upper", 0.0)),
            velocity=float(limits.get("velocity", 0.0)),
        )
    return joints


def read_collision_vertices(urdf: Path) -> dict[str, Float[Array, "_ 3"]]:
    """Read all vertices (n, 3) of each link's collision mesh (OBJ) in the link's frame, metres.

    Raises:
        FileNotFoundError, xml.etree.ElementTree.ParseError: A file is missing, or the URDF is not
            XML.
    """
    vertices = {}
    for link in ElementTree.parse(urdf).getroot().iter("link"):
        collision, mesh = link.find("collision"), link.find("collision/geometry/mesh")
        if collision is None or mesh is None:
            continue
        file = urdf.parent / mesh.attrib["filename"].removeprefix("package://")
        lines = (line.split() for line in file.read_text().splitlines() if line.startswith("v "))
        points = np.array([[float(word) for word in line[1:4]] for line in lines])
        vertices[link.attrib["name"]] = _read_origin(collision).apply(points)
    return vertices


def _read_origin(element: ElementTree.Element) -> Pose:
    """Read the pose in an element's <origin xyz rpy>, the identity where there is none."""
    origin = element.find("origin")
    zero = (0.0, 0.0, 0.0)
    return Pose.from_xyz_rpy(_vector(origin, "xyz", zero), _vector(origin, "rpy", zero))


def _vector(
    element: ElementTree.Element | None, attribute: str, default: tuple[float, float, float]
) -> tuple[float, float, float]:
    if element is None or attribute not in element.attrib:
        return default
    x, y, z = (float(word) for word in element.attrib[attribute].split())
    return (x, y, z)
