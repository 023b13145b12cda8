"""A URDF file that describes one rigid body: its links are held together, movable joints at 0."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

from tamp.errors import InputError
from tamp.geometric.loading.urdf_link import (
    MOST_ELEMENTS,
    Colour,
    Element,
    UnknownGeometry,
    elements,
    named_colours,
    origin_pose,
)
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.scene.pose import Pose

LARGEST_MASS = 1e6
"""Kilograms."""


@dataclass(frozen=True)
class UrdfObject:
    """A body as a URDF file tells it, in the frame of its root link, metres and kilograms.

    Attributes:
        collisions: Its visual elements when the file gives no others.
        visuals: Empty when one of them cannot be drawn.
        colour: The first that a visual element has.
        mass: Of all links; None when the file does not say.
        center_of_mass: Of all links; None when the file does not say.
        friction: Coulomb's coefficient; None when the file does not say.
        warnings: What was taken otherwise than it stands.
    """

    collisions: tuple[Element, ...]
    visuals: tuple[Element, ...]
    colour: Colour | None
    mass: float | None
    center_of_mass: tuple[float, float, float] | None
    friction: float | None
    warnings: tuple[str, ...]


def read_object(path: Path) -> UrdfObject:
    """Read a URDF file whose links form one tree.

    Raises:
        InputError: Not XML, no link, links in several trees or in a circle, no geometry, a
            collision geometry that is unknown, not finite, not positive or missing.
    """
    root = read_xml(path)

    links: dict[str, ElementTree.Element] = {}
    for link in root.findall("link"):
        name = link.get("name", "")
        if name in links:
            raise InputError(f"'{path.name}' has two links of the name '{name}'")
        links[name] = link

    if not links:
        what = "a soft body (<deformable>)" if root.find("deformable") is not None else "no link"
        raise InputError(
            f"'{path.name}' has {what}: an object has one link, or several that joints hold "
            "together"
        )

    poses, warnings = _link_poses(path, root, links)
    visuals, reason = _visuals(path, root, links, poses)
    try:
        collisions = _collisions(path, links, poses)
    except UnknownGeometry as error:
        if not visuals:
            raise
        collisions = []
        warnings.append(error.message)

    if not collisions:
        if not visuals:
            said = f": {reason}" if reason else ""
            raise InputError(f"'{path.name}' has neither collision nor visual geometry{said}")
        collisions = list(visuals)
        warnings.append(f"'{path.name}' has no collision geometry: what it shows is taken for it")
    elif reason:
        warnings.append(f"{reason}: the collision shape is drawn")

    mass, centre = _inertia(path, links, poses)
    return UrdfObject(
        tuple(collisions),
        visuals,
        next(
            (one.colour for one in visuals if one.colour is not None),
            next(iter(named_colours(root).values()), None),
        ),
        mass,
        centre,
        _friction(path, links, poses),
        tuple(warnings),
    )


def _link_poses(
    path: Path, root: ElementTree.Element, links: dict[str, ElementTree.Element]
) -> tuple[dict[str, Pose], list[str]]:
    """Compute T_root_link of every link, parents first, with all joints at 0 (forward kinematics),
    and what there is to say about the joints.
    """
    children: dict[str, list[tuple[str, Pose]]] = {name: [] for name in links}
    parents: dict[str, str] = {}
    held: list[str] = []

    for joint in root.findall("joint"):
        ends = [joint.find(end) for end in ("parent", "child")]
        parent, child = ("" if end is None else end.get("link", "") for end in ends)
        name = joint.get("name", "?")
        for link in (parent, child):
            if link not in links:
                raise InputError(
                    f"'{path.name}': joint '{name}' names the link '{link}', which the file does "
                    "not have"
                )

        if child in parents:
            raise InputError(f"'{path.name}': the link '{child}' hangs on two joints")
        parents[child] = parent
        children[parent].append((child, origin_pose(path, joint)))
        if joint.get("type", "fixed") != "fixed":
            held.append(name)

    roots = [name for name in links if name not in parents]
    if len(roots) != 1:
        shown = ", ".join(roots[:8])
        found = (
            f"{len(roots)} links ({shown}) that no joint holds together"
            if roots
            else "joints in a circle"
        )
        raise InputError(f"'{path.name}' has {found}: an object is one piece")

    poses = {roots[0]: Pose()}
    waiting = list(poses)
    while waiting:
        link = waiting.pop()
        for child, pose in children[link]:
            poses[child] = poses[link] @ pose
            waiting.append(child)

    if len(poses) < len(links):
        raise InputError(f"'{path.name}' has joints in a circle: an object is one piece")

    warnings: list[str] = []
    if held:
        shown = ", ".join(held[:4]) + (", ..." if len(held) > 4 else "")
        several = len(held) > 1
        joints = f"joints {shown} are" if several else f"joint {shown} is"
        warnings.append(f"'{path.name}': its {joints} held at 0, for an object is one rigid body")

    return {name: poses[name] for name in links}, warnings


def _collisions(
    path: Path, links: dict[str, ElementTree.Element], poses: dict[str, Pose]
) -> list[Element]:
    """List the collision elements of all links in the root's frame."""
    found: list[Element] = []
    for name, pose in poses.items():
        found += [_moved(pose, element) for element in elements(path, links[name], "collision")]
        if len(found) > MOST_ELEMENTS:
            raise InputError(f"'{path.name}' has more than {MOST_ELEMENTS} collision elements")
    return found


def _visuals(
    path: Path,
    root: ElementTree.Element,
    links: dict[str, ElementTree.Element],
    poses: dict[str, Pose],
) -> tuple[tuple[Element, ...], str]:
    """List the visual elements of all links, or none and the reason why they cannot be drawn."""
    colours = named_colours(root)
    try:
        found = [
            _moved(pose, element)
            for name, pose in poses.items()
            for element in elements(path, links[name], "visual", colours)
        ]
    except InputError as error:
        return (), error.message
    if len(found) > MOST_ELEMENTS:
        return (), f"'{path.name}' has more than {MOST_ELEMENTS} visual elements"
    for element in found:
        if element.mesh is not None and element.mesh.stat().st_size == 0:
            return (), f"'{path.name}' shows the mesh '{element.mesh.name}', which is empty"
    return tuple(found), ""


def _moved(pose: Pose, element: Element) -> Element:
    return replace(element, pose=pose @ element.pose)


def _inertia(
    path: Path, links: dict[str, ElementTree.Element], poses: dict[str, Pose]
) -> tuple[float | None, tuple[float, float, float] | None]:
    """Compute mass and centre of mass of all links together; links without a mass weigh nothing."""
    total, moment = 0.0, [0.0, 0.0, 0.0]
    for name, pose in poses.items():
        inertial = links[name].find("inertial")
        mass = None if inertial is None else _value(path, inertial.find("mass"))
        if inertial is None or mass is None or mass == 0.0:
            continue  # pybullet's mark of what cannot be moved
        if not 0.0 < mass <= LARGEST_MASS:
            raise InputError(
                f"'{path.name}': the mass {mass:g} kg of link '{name}' is not between 0 and 1000 t"
            )
        centre = (pose @ origin_pose(path, inertial)).position
        total += mass
        moment = [sum_ + mass * x for sum_, x in zip(moment, centre, strict=True)]
    if total == 0.0:
        return None, None
    x, y, z = (sum_ / total for sum_ in moment)
    return total, (x, y, z)


def _friction(
    path: Path, links: dict[str, ElementTree.Element], poses: dict[str, Pose]
) -> float | None:
    """Read the first link's friction: <lateral_friction> (or <friction>) in <contact>."""
    for name in poses:
        for tag in ("lateral_friction", "friction"):
            value = _value(path, links[name].find(f"contact/{tag}"))
            if value is not None:
                if value < 0.0:
                    raise InputError(
                        f"'{path.name}': the {tag} {value:g} of link '{name}' is negative"
                    )
                return value
    return None


def _value(path: Path, element: ElementTree.Element | None) -> float | None:
    """Read the finite number in an element's `value` or in its text; None without an element."""
    if element is None:
        return None
    text = (element.get("value") or element.text or "").strip()
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(
            f"'{path.name}': value of <{element.tag}>: '{text[:60]}' is not a finite number"
        )
    return value
