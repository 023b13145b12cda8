"""The geometry of one link in a URDF file: its collision or visual elements, its colour."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Sphere

Scale = tuple[float, float, float]
Colour = tuple[float, float, float, float]
SHAPE_TAGS = ("box", "cylinder", "sphere", "capsule", "mesh")


MOST_ELEMENTS = 2000
"""Collision, or visual, elements of one body."""

LARGEST_NUMBER = 1e6
"""Metres, or radians: larger numbers are mistakes, and lose the millimetres."""


class UnknownGeometry(InputError):
    """A geometry that URDF does not have, such as those of one simulator."""


@dataclass(frozen=True)
class Capsule:
    """A cylinder with a ball at each end, as pybullet reads `<capsule>`; `length` is that of the
    cylinder alone.
    """

    radius: float
    length: float


@dataclass(frozen=True)
class Element:
    """A collision or visual element: a primitive, or a mesh file.

    Attributes:
        pose: Of the geometry in the link's frame.
        shape: The primitive, or None for a mesh.
        mesh: The mesh file, or None for a primitive.
        scale: Factors that make the mesh metres; a negative one mirrors it.
        colour: A visual element's own, when it has one.
    """

    pose: Pose
    shape: Box | Cylinder | Sphere | Capsule | None = None
    mesh: Path | None = None
    scale: Scale = (1.0, 1.0, 1.0)
    colour: Colour | None = None


def read_visuals(path: Path) -> dict[str, tuple[Element, ...]]:
    """Read the visual elements of all links of a URDF file, by the links' names.

    Raises:
        InputError: Not XML, or a geometry that is unknown, not finite or not positive.
    """
    root = read_xml(path)
    colours = named_colours(root)
    return {
        link.get("name", ""): elements(path, link, "visual", colours)
        for link in root.findall("link")
    }


def elements(
    path: Path, link: ElementTree.Element, kind: str, colours: Mapping[str, Colour] | None = None
) -> tuple[Element, ...]:
    """Read the `collision` or `visual` elements of a link that have a geometry; `colours`: of the
    materials by name.

    Raises:
        InputError: One that is unknown, not finite, not positive, or whose mesh does not exist; too
            many.
    """
    found: list[Element] = []
    for element in link.findall(kind)[: MOST_ELEMENTS + 1]:
        geometry, material = element.find("geometry"), element.find("material")
        if geometry is not None:
            colour = (
                None
                if material is None
                else _rgba(material) or (colours or {}).get(material.get("name", ""))
            )
            found.append(_element(path, element, geometry, colour))
    if len(found) > MOST_ELEMENTS:
        raise InputError(f"'{path.name}' has more than {MOST_ELEMENTS} {kind} elements")
    return tuple(found)


def origin_pose(path: Path, element: ElementTree.Element | None) -> Pose:
    """Read the pose in an element's <origin xyz rpy>, the identity where there is none.

    Raises:
        InputError: Not three finite numbers.
    """
    origin = None if element is None else element.find("origin")
    zero = (0.0, 0.0, 0.0)
    return Pose.from_xyz_rpy(_vector(path, origin, "xyz", zero), _vector(path, origin, "rpy", zero))


def named_colours(root: ElementTree.Element) -> dict[str, Colour]:
    """Return the colours of a file's materials by name: the file's own first, then those of its
    links' visual elements.
    """
    found: dict[str, Colour] = {}
    for material in (*root.findall("material"), *root.findall("link/visual/material")):
        colour = _rgba(material)
        if colour is not None:
            found.setdefault(material.get("name", ""), colour)
    return found


def _rgba(material: ElementTree.Element) -> Colour | None:
    colour = material.find("color")
    words = colour.get("rgba", "").split() if colour is not None else []
    if len(words) != 4:
        return None
    try:
        r, g, b, a = (min(1.0, max(0.0, float(word))) for word in words)
    except ValueError:
        return None
    return (r, g, b, a)


def _element(
    path: Path, element: ElementTree.Element, geometry: ElementTree.Element, colour: Colour | None
) -> Element:
    pose = origin_pose(path, element)
    if not len(geometry):
        raise InputError(f"'{path.name}' has an empty <geometry>")

    shape = geometry[0]
    if shape.tag == "box":
        return Element(pose, Box(_vector(path, shape, "size", None, positive=True)), colour=colour)
    if shape.tag == "cylinder":
        cylinder = Cylinder(_length(path, shape, "radius"), _length(path, shape, "length"))
        return Element(pose, cylinder, colour=colour)
    if shape.tag == "sphere":
        return Element(pose, Sphere(_length(path, shape, "radius")), colour=colour)
    if shape.tag == "capsule":
        capsule = Capsule(_length(path, shape, "radius"), _length(path, shape, "length"))
        return Element(pose, capsule, colour=colour)
    if shape.tag == "mesh":
        file = _mesh_file(path, shape.get("filename", ""))
        return Element(pose, mesh=file, scale=_scale(path, shape), colour=colour)

    if shape.tag == "plane":
        raise InputError(
            f"'{path.name}' has a <plane>, which has no end: the room has its floor at z = 0"
        )

    raise UnknownGeometry(
        f"'{path.name}' has the geometry <{shape.tag[:40]}>, "
        f"which is none of {', '.join(SHAPE_TAGS)}"
    )


def _scale(path: Path, mesh: ElementTree.Element) -> Scale:
    """Read three factors, or one for all directions, which files have though URDF does not."""
    words = _numbers(path, mesh, "scale", None) if "scale" in mesh.attrib else (1.0,)
    if len(words) not in (1, 3) or 0.0 in words:
        text = mesh.get("scale", "")
        raise InputError(
            f"'{path.name}': scale of <mesh>: expected 3 numbers that are not 0, "
            f"found '{text[:60]}'"
        )
    x, y, z = words if len(words) == 3 else words * 3
    return (x, y, z)


def _mesh_file(path: Path, name: str) -> Path:
    """Find a mesh beside the URDF, or `package://` somewhere above it."""
    if not name.strip():
        raise InputError(f"'{path.name}' has a mesh without a file name")
    name = name.strip().replace("\\", "/")  # as written on Windows

    below = name
    for start in ("package://", "model://", "file://"):
        below = below.removeprefix(start)

    tails, folders = [Path(below)], [path.parent]
    if not name.startswith("file://") and below != name:
        tails, folders = (
            [Path(below), Path(*Path(below).parts[1:])],
            [path.parent, *path.absolute().parents],
        )

    for folder in folders:
        for tail in tails:
            try:
                if (folder / tail).is_file():
                    return folder / tail
            except OSError:  # a name too long to be one
                continue

    short = name if len(name) <= 80 else f"{name[:77]}..."
    raise InputError(f"'{path.name}' names the mesh '{short}', which does not exist")


def _length(path: Path, element: ElementTree.Element, attribute: str) -> float:
    return _numbers(path, element, attribute, 1, positive=True)[0]


def _vector(
    path: Path,
    element: ElementTree.Element | None,
    attribute: str,
    default: tuple[float, float, float] | None,
    positive: bool = False,
) -> tuple[float, float, float]:
    if default is not None and (element is None or not element.get(attribute, "").strip()):
        return default
    if element is None:
        raise InputError(f"'{path.name}': '{attribute}' is missing")
    x, y, z = _numbers(path, element, attribute, 3, positive)
    return (x, y, z)


def _numbers(
    path: Path,
    element: ElementTree.Element,
    attribute: str,
    count: int | None,
    positive: bool = False,
) -> tuple[float, ...]:
    text = element.get(attribute, "")
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    where = f"'{path.name}': {attribute} of <{element.tag}>"
    try:
        values = tuple(float(word) for word in text.replace(",", " ").split())
    except ValueError:
        remedy = "Expand it with xacro first" if "${" in text or "$(" in text else ""
        raise InputError(f"{where}: '{shown}' is not made of numbers", remedy=remedy) from None
    if count is not None and len(values) != count:
        raise InputError(f"{where}: expected {count} numbers, found '{shown}'")
    if not all(math.isfinite(value) for value in values) or (positive and min(values) <= 0):
        raise InputError(
            f"{where}: '{shown}' is not positive and finite" if positive else f"{where}: not finite"
        )
    if max(map(abs, values), default=0.0) > LARGEST_NUMBER:
        raise InputError(f"{where}: '{shown}' is beyond {LARGEST_NUMBER:g}")
    return values
