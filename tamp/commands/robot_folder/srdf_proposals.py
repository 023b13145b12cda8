"""Proposals of an SRDF: the home configuration, and pairs of links that are not checked."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import product

import numpy as np

from tamp.commands.robot_folder import self_collision
from tamp.commands.robot_folder.arm import Arm, outwards
from tamp.commands.robot_folder.description import Description
from tamp.commands.robot_folder.home import lowest
from tamp.commands.robot_folder.self_collision import Pair, home_collision
from tamp.commands.robot_folder.srdf import Disabled, Srdf
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD, Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose

HOMES = ("home", "ready", "half_sitting")
"""Names of states that may be the home configuration, those asked first before."""

STRETCHED = 0.75
"""The share of the arm's length that the tool may be away from the shoulder, seen from above."""

SAID = 12
"""Pairs that are said, the most frequent first."""


def home_of(srdf: Srdf, robot: Robot, length: float) -> tuple[tuple[float, ...] | None, list[str]]:
    """Return the first of HOMES in which the arm may drive and carry, and a sentence about it and
    about each that it may not.

    Args:
        srdf: The SRDF.
        robot: With its allowed pairs; its own home is not looked at.
        length: Of the arm, metres.
    """
    said: list[str] = []
    names = [joint.name for joint in robot.joints]
    for wanted in HOMES:
        states = [state for state in srdf.states if state.name.lower() == wanted]
        values = {name: value for state in states for name, value in state.values.items()}
        given = [name for name in names if name in values]
        if not given:
            continue
        state = f"{srdf.place(states[0].line)}'s state '{states[0].name}'"
        if len(given) < len(names):
            lacking = ", ".join(name for name in names if name not in values)
            said.append(f"{state} is not taken for home: it leaves out {lacking}")
            continue
        q = _within(robot, [values[name] for name in names])
        why = _unfit(robot, q, length)
        if why is None:
            return q, [*said, f"home is {state}"]
        said.append(f"{state} is not taken for home: {why}")
    return None, said


def _within(robot: Robot, values: list[float]) -> tuple[float, ...]:
    """Put values at the maker's limits on those of plans, which are a margin less."""
    found: list[float] = []
    for q, low, high in zip(values, robot.lower, robot.upper, strict=True):
        near = min(max(q, low), high)
        found.append(near if abs(near - q) <= 1.01 * LIMIT_MARGIN_RAD else q)
    return tuple(found)


def _unfit(robot: Robot, q: tuple[float, ...], length: float) -> str | None:
    """Say why an arm cannot drive in a configuration, if so."""
    for joint, value, low, high in zip(robot.joints, q, robot.lower, robot.upper, strict=True):
        if not low <= value <= high:
            return f"{joint.name} = {value:.4g} is not within [{low:.4g}, {high:.4g}]"
    hit = home_collision(robot, q)
    if hit is not None:
        return f"{hit[0]} and {hit[1]} meet there"

    kinematics, conf = Kinematics(robot), np.concatenate([np.zeros(3), q])
    poses = kinematics.link_poses(conf, robot.opening)
    for link in robot.links:
        if link.parts and bounds(link.parts, Pose.from_matrix(poses[link.name]))[0][2] < 0.0:
            return f"{link.name} is below the floor there"
    shoulder, tool = poses[robot.joints[1].child][:3, 3], kinematics.tool(conf)[:3, 3]
    if tool[2] < lowest(robot):
        return f"the hand is {tool[2]:.2f} m high there: nothing that it carries may hang from it"
    away = math.hypot(*(tool - shoulder)[:2])
    if away > STRETCHED * length:
        return f"the arm is stretched out by {away:.2f} m there (--home takes it all the same)"
    return None


def disabled_that_meet(
    srdf: Srdf, description: Description, arm: Arm, robot: Robot, met: Mapping[Pair, int]
) -> list[str]:
    """Return a sentence about each pair that the SRDF has not checked and that met nevertheless: it
    is checked.

    Args:
        srdf: The SRDF.
        description: The URDF.
        arm: Whose groups of links are the robot's links.
        robot: With its allowed pairs.
        met: In how many of STATES states each pair met.
    """
    links = _links(description, arm, robot)
    off = {(one.first, one.second): one for one in srdf.disabled}
    found: list[tuple[int, str]] = []
    for (first, second), count in met.items():
        if not count or (first, second) in robot.allowed:
            continue
        pairs = [
            _disabled(srdf, off, a, b)
            for a, b in product(links.get(first, ()), links.get(second, ()))
        ]
        entries = [one for one in pairs if one is not None]
        if entries and len(entries) == len(pairs):
            one = entries[0]
            reason = f" ({one.reason})" if one.reason else ""
            found.append((count, (
                f"{srdf.place(one.line)} disables {first} and {second}{reason}, which meet in "
                f"{100 * count / self_collision.STATES:.2g} % of states: they are checked"
            )))  # fmt: skip
    found.sort(key=lambda pair: -pair[0])
    more = len(found) - SAID
    rest = [f"and {more} pairs more that it disables meet: they are checked"] if more > 0 else []
    return [text for _, text in found[:SAID]] + rest


def _disabled(srdf: Srdf, off: Mapping[Pair, Disabled], first: str, second: str) -> Disabled | None:
    """Return the entry by which a pair of links is not checked, if there is one."""
    pair = (min(first, second), max(first, second))
    if pair in off:
        return off[pair]
    lines = [srdf.unchecked[name] for name in pair if name in srdf.unchecked]
    return Disabled(*pair, "default", lines[0]) if lines and pair not in srdf.enabled else None


def _links(description: Description, arm: Arm, robot: Robot) -> dict[str, list[str]]:
    """Collect the URDF's links that have shapes by the robot's link that they are a part of."""
    found = {group.name: [*group.links] for group in arm.groups}
    taken = {link for links in found.values() for link in links}
    moved = dict(_grippers(description, robot))
    for name, links in moved.items():
        found[name] = [link for link in links if link not in taken]
    return {
        name: [link for link in links if description.links[link]] for name, links in found.items()
    }


def _grippers(description: Description, robot: Robot) -> Iterator[tuple[str, list[str]]]:
    """List the URDF's links of hand and fingers, if it is the URDF's own."""
    fingers = [one.child for one in robot.fingers if one.child in description.links]
    if not fingers:
        return
    below: dict[str, list[str]] = {
        finger: [finger, *(joint.child for joint in outwards(description, finger))]
        for finger in fingers
    }
    yield from below.items()
    tip = robot.hand.removesuffix("_hand")
    if tip in description.links:
        inside = {link for links in below.values() for link in links}
        hand = [tip, *(joint.child for joint in outwards(description, tip))]
        yield robot.hand, [link for link in hand if link not in inside]
