"""A robot's folder: robot.yaml says what the robot is, geometry.npz has the links' hulls."""

from __future__ import annotations

import contextlib
import importlib.util
import math
import re
from collections.abc import Mapping
from pathlib import Path

import tamp.geometric.robot
from tamp.errors import InputError
from tamp.geometric.loading.robot_gripper import read_gripper, read_pose
from tamp.geometric.loading.yaml_file import read_yaml
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.robot.arms import Mobile, as_arm, joined
from tamp.geometric.robot.robot import (
    DRIVES,
    LIMIT_MARGIN_RAD,
    TURNING_RADII_M,
    Link,
    Robot,
)
from tamp.geometric.robot.robot_arrays import damaged, numbers, read_arrays
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Hull, Part

ROBOT_FILE, GEOMETRY_FILE = "robot.yaml", "geometry.npz"
VERSION = "1"
ASSETS = Path(tamp.geometric.robot.__file__).parent / "assets"
"""The folder of the shipped robots' folders."""
NAME = re.compile("[a-z][a-z0-9-]*")
"""Of an arm, as PDDL and the names of its links have it."""
KINDS = ("revolute", "continuous", "prismatic")
FULL_TURN = 2 * math.pi
"""A continuous joint's range in plans is one turn to either side, radians."""

_TOP = ("format", "version", "urdf", "made_from", "srdf", "base", "arm", "gripper", "allowed")
_BASE = ("drive", "link", "box", "velocity", "acceleration")
_ANY_BASE = (*_BASE, "turning_radius")
_ARM = ("foot", "mount", "home", "payload", "locked_joint", "joints")
_JOINT = ("link", "kind", "origin", "range", "velocity", "acceleration", "effort")


def read_robot(folder: Path) -> Robot:
    """Read a robot from its folder.

    Raises:
        InputError: A file is missing, damaged or of another version, or says what cannot be, with
            the line.
    """
    file = folder / ROBOT_FILE
    if not file.is_file():
        raise InputError(f"no robot: {ROBOT_FILE} is missing", file=folder)
    root = read_yaml(file)
    top = root.mapping()
    _check_format(root, top)
    return _several(root, folder) if "arms" in top else _one(root, folder)


def _one(root: YamlNode, folder: Path) -> Robot:
    """Read a robot of one arm."""
    top = root.mapping(_TOP, required=("format", "version", "urdf", "base", "arm", "gripper"))
    base = top["base"].mapping(_ANY_BASE, required=_BASE)
    arm = top["arm"].mapping(_ARM, required=("foot", "mount", "home", "joints"))
    gripper = read_gripper(top["gripper"])

    entries = {
        name: node.mapping(_JOINT, required=_JOINT)
        for name, node in arm["joints"].mapping().items()
    }
    if not entries:
        raise arm["joints"].error("an arm needs a joint")
    joints = tuple(_joint(name, entry) for name, entry in entries.items())
    names = tuple(joint.name for joint in joints)
    locked = arm["locked_joint"].text(names, "joint") if "locked_joint" in arm else None

    roles = {node.text(): node for node in (base["link"], arm["foot"], gripper.node)}
    chain = [base["link"].text(), arm["foot"].text(), *(joint.child for joint in joints)]
    chain += [gripper.hand, *(finger.child for finger in gripper.fingers)]
    if len(roles) != 3 or len(set(chain)) != len(chain):
        raise root.error("two parts of the robot have a link of one name")

    robot = Robot(
        name=folder.name,
        links=_links(folder, chain, _box(base["box"])),
        base=chain[0],
        foot=chain[1],
        hand=gripper.hand,
        T_base_arm=read_pose(arm["mount"]),
        joints=joints,
        T_flange_hand=gripper.T_flange_hand,
        T_hand_tool=gripper.T_hand_tool,
        fingers=gripper.fingers,
        lower=tuple(_lower(joint) for joint in joints),
        upper=tuple(_upper(joint) for joint in joints),
        velocity=base["velocity"].numbers(3, positive=True) + _each(entries, "velocity"),
        acceleration=base["acceleration"].numbers(3, positive=True)
        + _each(entries, "acceleration"),
        home=arm["home"].numbers(len(joints)),
        opening=gripper.opening,
        allowed=_allowed(top["allowed"], chain) if "allowed" in top else frozenset(),
        urdf=_urdf(top["urdf"], folder),
        folder=folder,
        drive=base["drive"].text(DRIVES, "drive"),
        turning_radius=_turning_radius(base),
        locked=None if locked is None else names.index(locked),
        effort=_each(entries, "effort"),
        force=gripper.force,
        suction=gripper.suction,
        payload=arm["payload"].number(positive=True) if "payload" in arm else math.inf,
    )
    _check_home(robot, arm["home"])
    return robot


def _turning_radius(base: Mapping[str, YamlNode]) -> float | None:
    """Read how tight a circle the base drives, metres: of a car, and of a car alone."""
    drive = base["drive"].text()
    if "turning_radius" in base:
        if drive != "car":
            raise base["turning_radius"].error(
                f"a turning_radius is a car's, not of a {drive} base"
            )
        return base["turning_radius"].number(low=TURNING_RADII_M[0], high=TURNING_RADII_M[1])
    if drive == "car":
        raise base["drive"].error(
            "a car needs a turning_radius", remedy="That of the tightest circle, metres, beside it"
        )
    return None


def _several(root: YamlNode, folder: Path) -> Robot:
    """Read a robot whose arms are those of other robots' folders."""
    keys = ("format", "version", "base", "arms", "allowed")
    top = root.mapping(keys, required=("base", "arms"))
    base = top["base"].mapping(_ANY_BASE, required=_BASE)
    body = Mobile(
        name=folder.name,
        base=Link(base["link"].text(), (_box(base["box"]),)),
        velocity=base["velocity"].numbers(3, positive=True),
        acceleration=base["acceleration"].numbers(3, positive=True),
        drive=base["drive"].text(DRIVES, "drive"),
        folder=folder,
        turning_radius=_turning_radius(base),
    )
    entries = top["arms"].mapping()
    if len(entries) < 2:
        raise top["arms"].error("several arms are at least two; one arm is an 'arm:'")

    arms: list[Robot] = []
    for name, node in entries.items():
        if not NAME.fullmatch(name):
            raise node.error(f"'{name}' is no name of an arm: a letter, then letters, digits and -")
        entry = node.mapping(("robot", "mount"), required=("robot", "mount"))
        own = read_robot(_beside(entry["robot"], folder))
        if own.beside:
            raise entry["robot"].error(f"the robot '{own.name}' has several arms itself")
        arms.append(as_arm(body, own, name, read_pose(entry["mount"])))
    names = [body.base.name, *(link.name for arm in arms for link in arm.links[1:])]
    return joined(arms, _allowed(top["allowed"], names) if "allowed" in top else frozenset())


def _beside(node: YamlNode, folder: Path) -> Path:
    """Find the folder of an arm's robot: from here, or a shipped one by its name."""
    places = (folder / node.text(), ASSETS / node.text())
    with contextlib.suppress(OSError):  # a name too long to be one
        for place in places:
            if (place / ROBOT_FILE).is_file() and place.resolve() != folder.resolve():
                return place.resolve()
    raise node.error(
        f"no robot's folder '{node.text()}'",
        remedy="Say where it is, from this folder, or a robot that comes with tamp",
    )


def _check_format(root: YamlNode, top: Mapping[str, YamlNode]) -> None:
    if "format" not in top or top["format"].text() != "tamp-robot":
        raise root.error("not a robot: it does not say 'format: tamp-robot'")
    version = top["version"].text() if "version" in top else "none"
    if version != VERSION:
        where = top.get("version", root)
        raise where.error(
            f"version {version} of a robot's folder is not known, only {VERSION}",
            remedy="Make it again with this tamp's tamp-robot",
        )


def _check_home(robot: Robot, node: YamlNode) -> None:
    for joint, q, low, high in zip(robot.joints, robot.home, robot.lower, robot.upper, strict=True):
        if not low <= q <= high:
            raise node.error(f"{joint.name} = {q:g} is not within [{low:.5g}, {high:.5g}]")


def _joint(name: str, entry: Mapping[str, YamlNode]) -> Joint:
    kind = entry["kind"].text(KINDS, "kind of joint")
    low, high = entry["range"].numbers(2)
    least = 2 * (LIMIT_MARGIN_RAD if kind != "prismatic" else LIMIT_MARGIN_RAD / 10)
    if kind != "continuous" and not high - low > least:
        raise entry["range"].error(f"the lower limit {low:g} is not below the upper {high:g}")
    return Joint(
        name, kind, "", entry["link"].text(), read_pose(entry["origin"]), (0.0, 0.0, 1.0), low,
        high, entry["velocity"].number(positive=True),
    )  # fmt: skip


def _lower(joint: Joint) -> float:
    if joint.kind == "continuous":
        return -FULL_TURN
    return joint.lower + (LIMIT_MARGIN_RAD / 10 if joint.kind == "prismatic" else LIMIT_MARGIN_RAD)


def _upper(joint: Joint) -> float:
    if joint.kind == "continuous":
        return FULL_TURN
    return joint.upper - (LIMIT_MARGIN_RAD / 10 if joint.kind == "prismatic" else LIMIT_MARGIN_RAD)


def _each(entries: Mapping[str, Mapping[str, YamlNode]], key: str) -> tuple[float, ...]:
    return tuple(entry[key].number(positive=True) for entry in entries.values())


def _box(node: YamlNode) -> Part:
    entries = node.mapping(("size", "at"), required=("size", "at"))
    length, width, height = entries["size"].numbers(3, positive=True)
    x, y, z = entries["at"].numbers(3)
    return Part(Box((length, width, height)), Pose((x, y, z)))


def _links(folder: Path, names: list[str], base: Part) -> tuple[Link, ...]:
    """Make the links of their hulls."""
    hulls = _hulls(folder / GEOMETRY_FILE)
    for name in hulls:
        if name not in names:
            raise InputError(
                f"it has hulls of '{name}', which is no link", file=folder / GEOMETRY_FILE
            )
    return (
        Link(names[0], (base,)),
        *(Link(name, tuple(map(Part, hulls.get(name, ())))) for name in names[1:]),
    )


def _hulls(file: Path) -> dict[str, list[Hull]]:
    """Read the hulls of each link, in order."""
    if not file.is_file():
        raise InputError(f"no robot: {GEOMETRY_FILE} is missing", file=file.parent)
    arrays, found = read_arrays(file), dict[str, list[Hull]]()
    for key in arrays:
        name, _, what = key.rpartition("/")
        if what == "vertices":
            vertices = numbers(arrays, key, file, (None, 3), "f")
            faces = numbers(arrays, f"{name}/faces", file, (None, 3), "iu")
            if faces.min() < 0 or faces.max() >= len(vertices):
                raise damaged(file, f"'{name}/faces' names vertices that are not there")
            vertices.flags.writeable = faces.flags.writeable = False
            found.setdefault(name.rpartition("/")[0], []).append(Hull(vertices, faces))
    return found


def _allowed(node: YamlNode, names: list[str]) -> frozenset[tuple[str, str]]:
    """Read lines of names, or lists of names with blanks: the first of each with all others."""
    pairs: set[tuple[str, str]] = set()
    for line in node.items():
        words = [one.text() for one in line.items()] if line.is_list() else line.text().split()
        for word in words:
            if word not in names:
                raise line.error(f"unknown link '{word}'", found=word, choices=names)
        pairs |= {(min(words[0], other), max(words[0], other)) for other in words[1:]}
    return frozenset(pairs)


def _urdf(node: YamlNode, folder: Path) -> Path:
    """Find the description: a file of the folder, or of an installed package, whose name comes
    first.
    """
    text = node.text()
    inside = folder / text
    with contextlib.suppress(OSError):  # a name too long to be one
        if inside.is_file():
            return inside
    package, _, path = text.partition("/")
    # Found without importing: pybullet prints at import.
    spec = importlib.util.find_spec(package) if package.isidentifier() else None
    if spec is not None and spec.origin is not None:
        file = Path(spec.origin).parent / path
        with contextlib.suppress(OSError):
            if file.is_file():
                return file
    wheel = {"pybullet_data": "pybullet"}.get(package)
    raise node.error(
        f"the robot '{folder.name}' needs {text}, which is not there",
        remedy=f"pip install {wheel}" if wheel else "Make it again with tamp-robot",
    )
