"""A robot's folder: robot.yaml, geometry.npz, reachability.npz, robot.urdf and its meshes."""

from __future__ import annotations

import io
import json
import math
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from tamp.errors import InputError
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD, Robot
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.robot.urdf_words import roll_pitch_yaw, words
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Hull, Part

LEAST_MASS = 0.1
"""Kilograms of a link of which the URDF says nothing, or less: physics wants some."""

Covers = Mapping[tuple[str, int], tuple[Array, float]]


def write_folder(
    out: Path,
    robot: Robot,
    covers: Covers,
    table: Mapping[str, Array],
    masses: Mapping[str, float],
    made_from: str,
    srdf: str | None = None,
) -> None:
    """Write a robot's folder: whole, or not at all; one that was there is replaced.

    Raises:
        InputError: It cannot be written.
    """
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        fresh = Path(tempfile.mkdtemp(prefix=".tamp-robot-", dir=out.parent))
        try:
            fresh.chmod(0o755)
            _fill(fresh, robot, covers, table, masses, made_from, srdf)
            old = out.with_name(f"{fresh.name}-old")
            if out.exists():
                out.rename(old)
            fresh.rename(out)
            shutil.rmtree(old, ignore_errors=True)
        finally:
            shutil.rmtree(fresh, ignore_errors=True)
    except OSError as error:
        raise InputError(f"cannot write the robot: {error.strerror}", file=out) from None


def _fill(
    folder: Path, robot: Robot, covers: Covers, table: Mapping[str, Array],
    masses: Mapping[str, float], made_from: str, srdf: str | None,
) -> None:  # fmt: skip
    arrays: dict[str, np.ndarray] = {}
    (folder / "meshes").mkdir()
    for link in robot.links:
        for number, part in enumerate(link.parts):
            if not isinstance(part.shape, Hull):
                continue
            key = f"{link.name}/{number}"
            arrays[f"{key}/vertices"], arrays[f"{key}/faces"] = (
                part.shape.vertices,
                part.shape.faces,
            )
            if (link.name, number) in covers:
                spheres, slack = covers[link.name, number]
                arrays[f"{key}/spheres"], arrays[f"{key}/slack"] = spheres, np.array(slack)
            mesh = folder / "meshes" / mesh_name(link.name, number)
            mesh.write_text(_obj(part.shape), encoding="utf-8")

    (folder / "geometry.npz").write_bytes(_packed(arrays))
    (folder / "reachability.npz").write_bytes(_packed(table))
    (folder / "robot.urdf").write_text(urdf_text(robot, masses), encoding="utf-8")
    (folder / "robot.yaml").write_text(yaml_text(robot, made_from, srdf), encoding="utf-8")


def mesh_name(link: str, number: int) -> str:
    """Name the mesh file of a link's part; no two links have the same."""
    safe = "".join(one if one.isalnum() or one in "_-" else f".{ord(one):x}." for one in link)
    return f"{safe}_{number}.obj"


def _packed(arrays: Mapping[str, np.ndarray]) -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)  # pyright: ignore[reportArgumentType]
    return buffer.getvalue()


def _obj(hull: Hull) -> str:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(hull.vertices).tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in np.asarray(hull.faces).tolist()]
    return "\n".join(lines) + "\n"


def yaml_text(robot: Robot, made_from: str, srdf: str | None = None) -> str:
    """Write robot.yaml."""
    part = robot.link(robot.base).parts[0]
    size = part.shape.size if isinstance(part.shape, Box) else (0.1, 0.1, 0.1)

    lines = [
        "# Made by tamp-robot. docs/adding-a-robot.md says what the entries mean.",
        "format: tamp-robot",
        "version: 1",
        f"made_from: {_quoted(made_from)}",
        *([] if srdf is None else [f"srdf: {_quoted(srdf)}"]),
        "urdf: robot.urdf",
        "base:",
        f"  drive: {robot.drive}",
        *([] if robot.turning_radius is None else [f"  turning_radius: {robot.turning_radius!r}"]),
        f"  link: {_quoted(robot.base)}",
        f"  box: {{size: {_list(size)}, at: {_list(part.pose.position)}}}",
        f"  velocity: {_list(robot.velocity[:3])}",
        f"  acceleration: {_list(robot.acceleration[:3])}",
        "arm:",
        f"  foot: {_quoted(robot.foot)}",
        f"  mount: {_pose(robot.T_base_arm)}",
        f"  home: {_list(robot.home)}",
        *([] if math.isinf(robot.payload) else [f"  payload: {robot.payload!r}"]),
        "  joints:",
    ]
    lines += [line for index in range(len(robot.joints)) for line in _joint_lines(robot, index)]
    lines += _gripper_lines(robot)
    return "\n".join([*lines, *_allowed_lines(robot)]) + "\n"


def _joint_lines(robot: Robot, index: int) -> list[str]:
    joint = robot.joints[index]
    return [
        f"    {_quoted(joint.name)}:",
        f"      link: {_quoted(joint.child)}",
        f"      kind: {joint.kind}",
        f"      origin: {_pose(joint.origin)}",
        f"      range: {_list((joint.lower, joint.upper))}",
        f"      velocity: {robot.velocity[3 + index]!r}",
        f"      acceleration: {robot.acceleration[3 + index]!r}",
        f"      effort: {robot.effort[index]!r}",
    ]


def _gripper_lines(robot: Robot) -> list[str]:
    if robot.suction is not None:
        return [
            "gripper:",
            "  kind: suction",
            f"  hand: {_quoted(robot.hand)}",
            f"  mount: {_pose(robot.T_flange_hand)}",
            f"  tool: {_pose(robot.T_hand_tool)}",
            f"  radius: {robot.suction.radius!r}",
            f"  tilt: {robot.suction.tilt!r}",
            f"  force: {robot.force!r}",
        ]

    lines = [
        "gripper:",
        "  kind: parallel",
        f"  hand: {_quoted(robot.hand)}",
        f"  mount: {_pose(robot.T_flange_hand)}",
        f"  tool: {_pose(robot.T_hand_tool)}",
        f"  opening: {robot.opening!r}",
        f"  force: {robot.force!r}",
        f"  speed: {robot.finger_speed!r}",
        "  fingers:",
    ]
    for finger in robot.fingers:
        lines += [
            f"    {_quoted(finger.name)}:",
            f"      link: {_quoted(finger.child)}",
            f"      origin: {_pose(finger.origin)}",
            f"      axis: {_list(finger.axis)}",
        ]
    return lines


def _allowed_lines(robot: Robot) -> list[str]:
    lines = [
        "# Pairs of links that are never checked: the first of a line with each other of it. They",
        "# touch by construction, or met never, or always, in 20,000 states.",
        "allowed:" if robot.allowed else "allowed: []",
    ]
    names = [link.name for link in robot.links]
    for number, first in enumerate(names):
        others = [
            name for name in names[number + 1 :]
            if (min(first, name), max(first, name)) in robot.allowed
        ]  # fmt: skip
        if others:
            line, quoted = [first, *others], [_quoted(name) for name in (first, *others)]
            lines.append(
                f"  - {' '.join(line)}" if line == quoted else f"  - [{', '.join(quoted)}]"
            )
    return lines


def urdf_text(robot: Robot, masses: Mapping[str, float]) -> str:
    """Write robot.urdf: the arm from its foot on, and the hand, of the same convex hulls."""
    lines = ['<?xml version="1.0"?>', f"<robot name={quoteattr(robot.name)}>"]
    for link in robot.links:
        if link.name != robot.base:
            lines += _link(link.name, link.parts, masses.get(link.name, 0.0))
    parent = robot.foot
    for index, joint in enumerate(robot.joints):
        kind = "prismatic" if joint.kind == "prismatic" else "revolute"
        low, high = joint.lower, joint.upper
        if joint.kind == "continuous":
            low, high = -2 * math.pi - LIMIT_MARGIN_RAD, 2 * math.pi + LIMIT_MARGIN_RAD
        lines += _joint(joint, kind, parent, low, high, robot.effort[index])
        parent = joint.child
    lines += [
        f'  <joint name={quoteattr(f"{robot.hand}_mount")} type="fixed">'
        f"<parent link={quoteattr(parent)}/><child link={quoteattr(robot.hand)}/>"
        f"{_origin(robot.T_flange_hand)}</joint>"
    ]
    for finger in robot.fingers:
        lines += _joint(finger, "prismatic", robot.hand, 0.0, robot.opening / 2, robot.force)
    return "\n".join([*lines, "</robot>"]) + "\n"


def _link(name: str, parts: Sequence[Part], mass: float) -> list[str]:
    mass = max(mass, LEAST_MASS)
    low, high = bounds(parts, Pose()) if parts else (np.full(3, -0.02), np.full(3, 0.02))
    x, y, z = np.maximum(high - low, 0.02)
    a, b, c = (mass / 12 * value for value in (y * y + z * z, x * x + z * z, x * x + y * y))
    lines = [
        f"  <link name={quoteattr(name)}>",
        f'    <inertial><origin xyz="{words((low + high) / 2)}"/><mass value="{mass:.6g}"/>'
        f'<inertia ixx="{a:.6g}" ixy="0" ixz="0" iyy="{b:.6g}" iyz="0" izz="{c:.6g}"/></inertial>',
    ]
    for number in range(len(parts)):
        mesh = f"package://meshes/{mesh_name(name, number)}"
        lines.append(f'    <collision><geometry><mesh filename="{mesh}"/></geometry></collision>')
    return [*lines, "  </link>"]


def _joint(
    joint: Joint, kind: str, parent: str, low: float, high: float, effort: float
) -> list[str]:
    return [
        f'  <joint name={quoteattr(joint.name)} type="{kind}"><parent link={quoteattr(parent)}/>'
        f"<child link={quoteattr(joint.child)}/>{_origin(joint.origin)}"
        f'<axis xyz="{words(joint.axis)}"/>'
        f'<limit lower="{low!r}" upper="{high!r}" effort="{effort:g}" '
        f'velocity="{joint.velocity or 1.0:g}"/></joint>'
    ]


def _origin(pose: Pose) -> str:
    return f'<origin xyz="{words(pose.position)}" rpy="{words(roll_pitch_yaw(pose.rotation))}"/>'


def _list(values: Iterable[float]) -> str:
    return f"[{', '.join(repr(float(value)) for value in values)}]"


def _pose(pose: Pose) -> str:
    return f"{{xyz: {_list(pose.position)}, quaternion: {_list(pose.quaternion)}}}"


def _quoted(text: str) -> str:
    """Write a text such that YAML reads just that: names as they are."""
    plain = text.replace("_", "a").replace("-", "a").isalnum() and not text.startswith("-")
    if plain and text.lower() != "null":
        return text
    return repr(text) if "\\" not in repr(text) else json.dumps(text)
