"""The one link of a URDF file that describes an object."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from tamp.errors import InputError
from tamp.world.pose import Pose
from tamp.world.scene import Box, Cylinder, Sphere

Scale = tuple[float, float, float]


@dataclass(frozen=True)
class Element:
    """A collision or visual element: a primitive, or a mesh file.

    Attributes:
        pose: Of the geometry in the link's frame.
        shape: The primitive, or None for a mesh.
        mesh: The mesh file, or None for a primitive.
        scale: Factors that make the mesh metres.
    """

    pose: Pose
    shape: Box | Cylinder | Sphere | None = None
    mesh: Path | None = None
    scale: Scale = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class UrdfLink:
    """What a link is made of; `collisions` are its visual elements when the file gives no others."""

    collisions: tuple[Element, ...]
    visuals: tuple[Element, ...]
    colour: tuple[float, float, float, float] | None


def read_link(path: Path) -> UrdfLink:
    """Read a URDF file of one link.

    Raises:
        InputError: Not XML, not one link, no geometry, or one that is unknown, not finite or not positive.
    """
    try:
        root = ElementTree.fromstring(path.read_bytes())
    except (OSError, ElementTree.ParseError) as error:
        raise InputError(f"cannot read '{path.name}': {error}") from None
    links = root.findall("link")
    if len(links) != 1:
        names = ", ".join(link.get("name", "?") for link in links[:8])
        found = f"{len(links)} links ({names})" if links else "no link"
        raise InputError(f"'{path.name}' has {found}: an object has one link")
    visuals = _elements(path, links[0], "visual")
    collisions = _elements(path, links[0], "collision") or visuals
    if not collisions:
        raise InputError(f"'{path.name}' has neither collision nor visual geometry")
    return UrdfLink(collisions, visuals, _colour(root, links[0]))


def read_visuals(path: Path) -> dict[str, tuple[Element, ...]]:
    """The visual elements of all links of a URDF file, by the links' names.

    Raises:
        InputError: Not XML, or a geometry that is unknown, not finite or not positive.
    """
    try:
        root = ElementTree.fromstring(path.read_bytes())
    except (OSError, ElementTree.ParseError) as error:
        raise InputError(f"cannot read '{path.name}': {error}") from None
    return {link.get("name", ""): _elements(path, link, "visual") for link in root.findall("link")}


def _elements(path: Path, link: ElementTree.Element, kind: str) -> tuple[Element, ...]:
    found = [(element, element.find("geometry")) for element in link.findall(kind)]
    return tuple(_element(path, element, geometry) for element, geometry in found if geometry is not None)


def _element(path: Path, element: ElementTree.Element, geometry: ElementTree.Element) -> Element:
    origin = element.find("origin")
    zero = (0.0, 0.0, 0.0)
    pose = Pose.from_xyz_rpy(_vector(path, origin, "xyz", zero), _vector(path, origin, "rpy", zero))
    for shape in geometry:
        if shape.tag == "box":
            return Element(pose, Box(_vector(path, shape, "size", None, positive=True)))
        if shape.tag == "cylinder":
            return Element(pose, Cylinder(_length(path, shape, "radius"), _length(path, shape, "length")))
        if shape.tag == "sphere":
            return Element(pose, Sphere(_length(path, shape, "radius")))
        if shape.tag == "mesh":
            scale = _vector(path, shape, "scale", (1.0, 1.0, 1.0), positive=True)
            return Element(pose, mesh=_mesh_file(path, shape.get("filename", "")), scale=scale)
    known = "box, cylinder, sphere, mesh"
    raise InputError(f"'{path.name}' has a geometry that is none of {known}")


def _mesh_file(path: Path, name: str) -> Path:
    """A mesh beside the URDF, or `package://` somewhere above it."""
    if not name:
        raise InputError(f"'{path.name}' has a mesh without a file name")
    below = name.removeprefix("package://").removeprefix("file://")
    folders = [path.parent] if below == name else [path.parent, *path.parents]
    tails = [Path(below)] if below == name else [Path(below), Path(*Path(below).parts[1:])]
    for folder in folders:
        for tail in tails:
            if (folder / tail).is_file():
                return folder / tail
    raise InputError(f"'{path.name}' names the mesh '{name}', which does not exist")


def _colour(root: ElementTree.Element, link: ElementTree.Element) -> tuple[float, float, float, float] | None:
    material = link.find("visual/material")
    if material is None:
        return None
    named = [other for other in root.findall("material") if other.get("name") == material.get("name")]
    for candidate in (material, *named):
        colour = candidate.find("color")
        words = colour.get("rgba", "").split() if colour is not None else []
        if len(words) == 4:
            try:
                r, g, b, a = (min(1.0, max(0.0, float(word))) for word in words)
            except ValueError:
                return None
            return (r, g, b, a)
    return None


def _length(path: Path, element: ElementTree.Element, attribute: str) -> float:
    return _numbers(path, element, attribute, 1, positive=True)[0]


def _vector(
    path: Path,
    element: ElementTree.Element | None,
    attribute: str,
    default: tuple[float, float, float] | None,
    positive: bool = False,
) -> tuple[float, float, float]:
    if default is not None and (element is None or attribute not in element.attrib):
        return default
    if element is None:
        raise InputError(f"'{path.name}': '{attribute}' is missing")
    x, y, z = _numbers(path, element, attribute, 3, positive)
    return (x, y, z)


def _numbers(path: Path, element: ElementTree.Element, attribute: str, count: int, positive: bool) -> tuple[float, ...]:
    text = element.get(attribute, "")
    where = f"'{path.name}': {attribute} of <{element.tag}>"
    try:
        values = tuple(float(word) for word in text.split())
    except ValueError:
        raise InputError(f"{where}: '{text}' is not made of numbers") from None
    if len(values) != count:
        raise InputError(f"{where}: expected {count} numbers, found '{text}'")
    if not all(math.isfinite(value) for value in values) or (positive and min(values) <= 0):
        raise InputError(f"{where}: '{text}' is not positive and finite" if positive else f"{where}: not finite")
    return values
