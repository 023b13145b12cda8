"""A home configuration: compact, the hand in front and down, clear of the robot itself."""

from __future__ import annotations

import itertools
import math

import numpy as np

from tamp.commands.robot_folder.reach_table import directions, rotation_with_up, tools
from tamp.commands.robot_folder.self_collision import home_collision
from tamp.errors import InputError
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

ROOM = 0.3
"""Metres below the tool that what it carries may take."""

AHEAD = np.arange(0.25, 0.75, 0.05)
"""Shares of the arm's length that the tool is in front of the foot,"""

ABOVE = np.arange(-0.4, 0.61, 0.1)
"""and above the shoulder."""

YAWS = np.arange(8) * np.pi / 4

SAMPLES = 20_000
"""Configurations that are drawn where inverse kinematics finds no pose: few joints reach few."""

LOOKED_AT = 200
"""Configurations that are looked at for collision, the best first."""


def home(robot: Robot, length: float) -> tuple[float, ...]:
    """Find a configuration in which the tool points down in front of the foot, above the ground by
    ROOM, the links near the middle; where the arm cannot point down, forward.

    Args:
        robot: Its own home is not looked at.
        length: Of the arm, metres.

    Raises:
        InputError: There is none: the arm cannot reach any table.
    """
    ik, kinematics = ArmIK(robot), Kinematics(robot)
    for ways in (_down(), _forward(), _any()):
        best: list[tuple[float, Array]] = []
        for T in _poses(robot, length, ways):
            best += [(_sprawl(robot, kinematics, q), q) for q in ik.solve(T, enough=6)]
        free = _free(robot, best)
        if free is not None:
            return free
    free = _free(robot, _drawn(robot, kinematics, length))
    if free is not None:
        return free
    raise InputError(
        f"the arm of {robot.name} reaches no place in front of it with the hand down or forward",
        remedy="Give its carrying configuration with --home, or mount it elsewhere with --mount",
    )


def _free(robot: Robot, weighed: list[tuple[float, Array]]) -> tuple[float, ...] | None:
    """Return the lightest configuration that is free, of the best and some spread over the rest."""
    best = sorted(weighed, key=lambda pair: pair[0])
    spread = best[LOOKED_AT :: max(1, (len(best) - LOOKED_AT) // LOOKED_AT)]
    for _, q in (*best[:LOOKED_AT], *spread):
        if home_collision(robot, q) is None:
            return tuple(round(float(value), 6) for value in q)
    return None


def _drawn(robot: Robot, kinematics: Kinematics, length: float) -> list[tuple[float, Array]]:
    """Draw configurations with the tool in front, and weigh them: upwards hands are heavy."""
    chain, shoulder = Chain.of(robot), _shoulder(robot)
    q = np.random.default_rng(0).uniform(chain.lower, chain.upper, (SAMPLES, len(chain.lower)))
    R, p = tools(chain, q)
    ahead = (p[:, 0] - shoulder[0]) / length
    kept = (ahead > AHEAD[0]) & (np.abs(p[:, 1]) < 0.3 * length) & (p[:, 2] > lowest(robot))
    return [
        (_sprawl(robot, kinematics, q[index]) + 1.0 + float(R[index, 2, 2]), q[index])
        for index in np.flatnonzero(kept)[: 10 * LOOKED_AT]
    ]


def _shoulder(robot: Robot) -> Array:
    """Return where the second joint is in the base's frame, (3,)."""
    return np.array((robot.T_base_arm @ robot.joints[0].origin @ robot.joints[1].origin).position)


def lowest(robot: Robot) -> float:
    """Return how low the tool may be with something that hangs from it, metres."""
    return ROOM + max(0.0, _top(robot))


def _poses(robot: Robot, length: float, ways: list[Array]) -> list[Array]:
    """List tool poses in front of the foot, not lower than what is carried allows."""
    shoulder = _shoulder(robot)
    poses: list[Array] = []
    for ahead, above, R in itertools.product(AHEAD * length, ABOVE * length, ways):
        if shoulder[2] + above < lowest(robot):
            continue
        T = np.eye(4)
        T[:3, :3] = R
        T[:3, 3] = shoulder + np.array([ahead, 0.0, above])
        poses.append(T)
    return poses


def _top(robot: Robot) -> float:
    """Return how high the base is, metres; 0 of one that does not drive."""
    if robot.drive == "fixed":
        return 0.0
    part = robot.link(robot.base).parts[0]
    return float(part.pose.position[2])


def _sprawl(robot: Robot, kinematics: Kinematics, q: Array) -> float:
    """Weigh a configuration: how far arm and hand are from the middle, how far joints have turned
    and how near they are to limits, and how far below or above the shoulder the hand is.
    """
    conf = np.concatenate([np.zeros(3), q])
    poses, tool = kinematics.link_poses(conf, robot.opening), kinematics.tool(conf)
    frames = np.array([*(poses[joint.child][:3, 3] for joint in robot.joints), tool[:3, 3]])
    middle = np.array(robot.T_base_arm.position) if robot.drive == "fixed" else np.zeros(3)
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    near = float(np.abs(2 * (q - lower) / (upper - lower) - 1.0).max())
    wound = float(np.abs(q).max()) / np.pi
    elbow = max(0.0, float(tool[2, 3] - frames[1:-1, 2].min()))  # what is carried hangs below
    length = sum(math.hypot(*joint.origin.position) for joint in robot.joints[1:])
    wanted = float(frames[0, 2]) + 0.3 * length
    return (
        2.0 * float(np.linalg.norm((frames - middle)[:, :2], axis=1).max())
        + float(np.abs(frames[:, 1]).max())
        + 0.5 * elbow
        + 0.2 * wound
        + max(0.0, near - 0.8)
        + abs(float(tool[2, 3]) - wanted)
    )


def _down() -> list[Array]:
    """Return orientations whose z points down."""
    return [
        np.array([[np.cos(yaw), np.sin(yaw), 0], [np.sin(yaw), -np.cos(yaw), 0], [0, 0, -1.0]])
        for yaw in YAWS
    ]


def _forward() -> list[Array]:
    """Return orientations whose z points forward, the closing direction level or upright."""
    level = np.array([[0, 0, 1.0], [0, 1, 0], [-1, 0, 0]])
    upright = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])
    return [level, upright, *(R @ np.diag([-1.0, -1.0, 1.0]) for R in (level, upright))]


def _any() -> list[Array]:
    """Return orientations all around: for arms whose hand is not free to turn."""
    found: list[Array] = []
    for up in directions(3):
        R = rotation_with_up(up)
        found += [_about_z(yaw) @ R for yaw in YAWS]
    return [R for R in found if R[0, 2] > -0.3]


def _about_z(yaw: float) -> Array:
    return np.array(
        [[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]]
    )
