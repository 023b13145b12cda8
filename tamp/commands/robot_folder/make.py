"""Make a robot's folder from a URDF."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from tamp.commands.robot_folder.arm import Arm, find_arm
from tamp.commands.robot_folder.base import choose_base, on_our_box
from tamp.commands.robot_folder.check import against_urdf, check_reach
from tamp.commands.robot_folder.choose_gripper import choose_gripper, named_fingers
from tamp.commands.robot_folder.column import on_column
from tamp.commands.robot_folder.convex import CollisionElement, joined, pieces, solids
from tamp.commands.robot_folder.gripper import Gripper
from tamp.commands.robot_folder.hand import tip_is_hand, tip_is_replaced
from tamp.commands.robot_folder.home import home
from tamp.commands.robot_folder.kept_steps import kept, kept_hulls
from tamp.commands.robot_folder.left_out import description_for
from tamp.commands.robot_folder.reach_table import table
from tamp.commands.robot_folder.self_collision import (
    allowed_pairs,
    home_collision,
    meetings,
    misjudged,
)
from tamp.commands.robot_folder.spheres import cover
from tamp.commands.robot_folder.srdf_proposals import disabled_that_meet, home_of
from tamp.commands.robot_folder.wanted import Wanted
from tamp.commands.robot_folder.weight import carrying
from tamp.errors import InputError
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD, Link, Robot
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull, Part

PER_SECOND = 2.0
"""A joint's acceleration as a multiple of its velocity, 1/s, where nobody says more."""

REACHING = "from where the arm reaches what"
"""The name of the step that takes longest."""

Told = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Made:
    """A robot before it is written: with its sphere covers, table and masses, how far its frames
    are off those of the URDF, and sentences about what was decided.
    """

    robot: Robot
    covers: Mapping[tuple[str, int], tuple[Array, float]]
    table: Mapping[str, Array]
    masses: Mapping[str, float]
    off: float
    warnings: tuple[str, ...]


def make(wanted: Wanted, told: Told) -> Made:
    """Make a robot; `told` hears of each step and the share of it that is done.

    Raises:
        InputError: What is wrong with the URDF or the choices, and what to do.
    """
    told("reading the URDF", 0.0)
    file = wanted.urdf
    description = description_for(wanted)
    base = wanted.base or description.root
    fingers = named_fingers(description, wanted)
    bare = (
        tip_is_replaced(description, wanted.tip)
        if fingers is None
        else tip_is_hand(description, wanted.tip, fingers)
    )
    arm = find_arm(description, base, wanted.tip, wanted.fixed, fingers is None, bare)

    told("hulls", 0.0)
    meshes = {group.name: solids(group.elements, group.name) for group in arm.groups}
    if not any(meshes.values()):
        raise InputError(
            "the arm has no collision shapes", file=file,
            remedy="Give its links <collision> elements; their <visual> meshes often do",
        )  # fmt: skip
    gripper = choose_gripper(description, wanted, arm, fingers, bare)
    robot = _robot(wanted, arm, gripper, meshes, file)
    off = against_urdf(robot, description, arm, wanted.tip)
    robot = _refined(robot, meshes, told)
    robot, remarks = _placed(robot, wanted, arm)
    reach = kept("reach", _unnamed(robot), partial(table, robot, partial(told, REACHING)))
    check_reach(reach["counts"], reach["heights"], robot)

    met = _met(robot, told)
    allowed, warnings = allowed_pairs(robot, met)
    robot = replace(robot, allowed=allowed)
    if wanted.srdf is not None:
        warnings += tuple(disabled_that_meet(wanted.srdf, description, arm, robot, met))
    told("a home configuration", 0.0)
    q, said = _home(robot, wanted)
    robot = replace(robot, home=q)
    covers = _covers(robot, told)

    groups = {group.name: group.mass for group in arm.groups}
    shared = {robot.hand: gripper.mass * 0.7}
    shared |= {finger.child: gripper.mass * 0.15 for finger in robot.fingers}
    masses = groups | shared
    effort, weak = carrying(robot, masses)
    robot = replace(robot, effort=effort)
    remarks = (*wanted.remarks, *remarks, *warnings, *said, *weak)
    return Made(robot, covers, reach, masses, off, remarks)


def _placed(robot: Robot, wanted: Wanted, arm: Arm) -> tuple[Robot, list[str]]:
    """Put a short arm on a column; return what there is to say of that, and of a gripper that was
    replaced.
    """
    remarks = [f"the gripper takes the place of {', '.join(arm.dropped)}"] if arm.dropped else []
    if wanted.mount is None and on_our_box(robot):
        before = robot.T_base_arm.position[2]
        robot = on_column(robot)
        high = robot.T_base_arm.position[2]
        if high > before:
            remarks.append(
                f"a short arm: it stands {high:.2f} m high on a column; --mount puts it elsewhere"
            )
    return robot, remarks


def _robot(
    wanted: Wanted,
    arm: Arm,
    gripper: Gripper,
    meshes: Mapping[str, Sequence[CollisionElement]],
    file: Path,
) -> Robot:
    """Put base, arm and gripper together, without knowing yet which links can meet."""
    names = {group.name for group in arm.groups}
    renamed = _unused(gripper, names)
    foot = arm.groups[0]
    links = [
        Link(group.name, _parts(joined([h for one in meshes[group.name] for h in one.hulls],
                                       group.name)))
        for group in arm.groups
    ]  # fmt: skip
    box, T_base_arm, velocity, acceleration = choose_base(
        wanted.drive, wanted.height, wanted.mount, arm, links[0]
    )

    hand, *fingers = renamed
    links += [
        Link(hand, _parts(gripper.hand)),
        *(
            Link(finger.child, _parts(hulls))
            for finger, hulls in zip(fingers, gripper.finger_hulls, strict=True)
        ),
    ]

    base = "base" if "base" not in {link.name for link in links} else "tamp_base"
    lower = tuple(_bound(joint, joint.lower, 1.0) for joint in arm.joints)
    upper = tuple(_bound(joint, joint.upper, -1.0) for joint in arm.joints)
    return Robot(
        name=wanted.out.name,
        links=(Link(base, (box,)), *links),
        base=base,
        foot=foot.name,
        hand=hand,
        T_base_arm=T_base_arm,
        joints=arm.joints,
        T_flange_hand=arm.T_last_tip @ gripper.T_tip_hand,
        T_hand_tool=gripper.T_hand_tool,
        fingers=tuple(fingers),
        lower=lower,
        upper=upper,
        velocity=(*velocity, *arm.velocity),
        acceleration=(*acceleration, *(PER_SECOND * speed for speed in arm.velocity)),
        home=tuple((low + high) / 2 for low, high in zip(lower, upper, strict=True)),
        opening=gripper.opening,
        allowed=frozenset(),
        urdf=file,
        folder=wanted.out,
        drive=wanted.drive,
        turning_radius=wanted.turning_radius,
        effort=arm.effort,
        force=gripper.force,
        suction=gripper.suction,
        payload=wanted.payload,
    )


def _bound(joint: Joint, limit: float, inwards: float) -> float:
    if joint.kind == "continuous":
        return -inwards * 2 * math.pi
    return limit + inwards * (
        LIMIT_MARGIN_RAD / 10 if joint.kind == "prismatic" else LIMIT_MARGIN_RAD
    )


def _unused(gripper: Gripper, names: set[str]) -> tuple[str, *tuple[Joint, ...]]:
    """Give the gripper's links and joints names that the arm has not."""
    hand = gripper.name
    mark = "gripper_" if names & {hand, *(one.child for one in gripper.fingers)} else ""
    fingers = (
        replace(one, name=mark + one.name, parent=mark + hand, child=mark + one.child)
        for one in gripper.fingers
    )
    return mark + hand, *fingers


def _parts(hulls: Sequence[Hull]) -> tuple[Part, ...]:
    return tuple(map(Part, hulls))


def _unnamed(robot: Robot) -> Robot:
    """Take a robot's name away, on which no step depends."""
    return replace(robot, name="")


def _met(robot: Robot, told: Told) -> dict[tuple[str, str], int]:
    """Count in how many states each pair of links meets."""

    def compute() -> dict[str, np.ndarray]:
        met = meetings(robot, partial(told, "pairs of links that can meet"))
        names = np.array([*met], dtype=np.str_).reshape(-1, 2)
        return {"pairs": names, "counts": np.array([*met.values()], dtype=np.int64)}

    found = kept("pairs", _unnamed(robot), compute)
    pairs = ((str(first), str(second)) for first, second in found["pairs"])
    return dict(zip(pairs, found["counts"].tolist(), strict=True))


def _refined(robot: Robot, meshes: Mapping[str, Sequence[CollisionElement]], told: Told) -> Robot:
    """Decompose the links whose hulls meet much more often than they do."""
    solids = {name: some for name, some in meshes.items() if some}

    def compute() -> dict[str, np.ndarray]:
        names = misjudged(robot, solids, partial(told, "hulls against meshes"))
        return {"links": np.array(sorted(names), dtype=np.str_)}

    wrong = kept("misjudged", (_unnamed(robot), solids), compute)["links"].tolist()
    links: list[Link] = []
    for link in robot.links:
        if link.name in wrong:
            told(f"convex pieces of {link.name}", 0.0)
            hulls = [
                hull
                for one in solids[link.name]
                for hull in kept_hulls("pieces", one, partial(pieces, one, link.name))
            ]
            link = Link(link.name, _parts(joined(hulls, link.name)))
        links.append(link)
    return replace(robot, links=tuple(links))


def _home(robot: Robot, wanted: Wanted) -> tuple[tuple[float, ...], list[str]]:
    """Take the home that is wanted, or the SRDF's, or look for one; with sentences about it."""
    if wanted.home is None:
        length = sum(math.hypot(*joint.origin.position) for joint in robot.joints[1:])
        length += math.hypot(*robot.T_flange_hand.position)
        q, said = (None, []) if wanted.srdf is None else home_of(wanted.srdf, robot, length)
        if q is None:
            found = kept("home", _unnamed(robot), lambda: {"q": np.array(home(robot, length))})
            q = tuple(found["q"].tolist())
        return q, said
    if len(wanted.home) != len(robot.joints):
        raise InputError(f"--home: {len(robot.joints)} numbers are expected, one a joint, not "
                         f"{len(wanted.home)}")  # fmt: skip
    for joint, q, low, high in zip(
        robot.joints, wanted.home, robot.lower, robot.upper, strict=True
    ):
        if not low <= q <= high:
            raise InputError(f"--home: {joint.name} = {q:g} is not within [{low:.4g}, {high:.4g}]")
    hit = home_collision(robot, wanted.home)
    if hit is not None:
        raise InputError(f"--home: {hit[0]} and {hit[1]} meet there")
    return wanted.home, []


def _covers(robot: Robot, told: Told) -> dict[tuple[str, int], tuple[Array, float]]:
    found: dict[tuple[str, int], tuple[Array, float]] = {}
    parts = [
        (link.name, number, part.shape)
        for link in robot.links
        for number, part in enumerate(link.parts)
        if isinstance(part.shape, Hull)
    ]
    for done, (name, number, hull) in enumerate(parts):
        told("spheres around the links", done / len(parts))
        spheres = kept("cover", hull, partial(_cover, hull))
        if spheres:
            found[name, number] = spheres["spheres"], float(spheres["slack"])
    return found


def _cover(hull: Hull) -> dict[str, np.ndarray]:
    found = cover(hull)
    return {} if found is None else {"spheres": found[0], "slack": np.array(found[1])}
