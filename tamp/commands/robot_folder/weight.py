"""The efforts with which an arm's joints carry the arm itself."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose

GRAVITY = 9.81
"""Metres a second squared."""

STATES = 500
"""Configurations at which the arm's weight is looked at."""

SPARE = 2.0
"""How much more than the weight a joint gets that could not carry it: it has to move it, too."""


def carrying(robot: Robot, masses: Mapping[str, float]) -> tuple[tuple[float, ...], list[str]]:
    """Return efforts with which each joint carries what hangs on it, and a sentence about each that
    by its description does not: springs, or a counterweight, must do it.

    Args:
        robot: What its joints exert.
        masses: Kilograms by link, taken as in the middle of its shape.
    """
    needed = _weights(robot, masses)
    efforts: list[float] = []
    remarks: list[str] = []
    for joint, effort, weight in zip(robot.joints, robot.effort, needed, strict=True):
        if effort >= weight:
            efforts.append(effort)
            continue
        given = float(np.ceil(SPARE * weight))
        unit = "N" if joint.kind == "prismatic" else "N m"
        efforts.append(given)
        remarks.append(
            f"{joint.name} exerts {effort:g} {unit} and has to carry {weight:.0f}: springs must "
            f"help it, {given:g} is written"
        )
    return tuple(efforts), remarks


def _weights(robot: Robot, masses: Mapping[str, float]) -> Array:
    """Compute the most that gravity exerts on each joint (n,) at random configurations."""
    kinematics, rng = Kinematics(robot), np.random.default_rng(0)
    order = [joint.child for joint in robot.joints]
    middles = {
        link.name: np.mean(bounds(link.parts, Pose()), axis=0) if link.parts else np.zeros(3)
        for link in robot.links
    }
    moved = [*order, *sorted(robot.grippers)]
    weights = GRAVITY * np.array([masses.get(name, 0.0) for name in moved])
    # what hangs on each joint: its own link and all after it
    hangs = np.array(
        [[index >= number for index in range(len(moved))] for number in range(len(order))]
    )
    worst = np.zeros(len(order))
    for _ in range(STATES):
        q = rng.uniform(np.array(robot.lower), np.array(robot.upper))
        poses = kinematics.link_poses(np.concatenate([np.zeros(3), q]), 0.0)
        centres = np.array(
            [poses[name][:3, :3] @ middles[name] + poses[name][:3, 3] for name in moved]
        )
        for number, joint in enumerate(robot.joints):
            axis, origin = poses[joint.child][:3, 2], poses[joint.child][:3, 3]
            load = weights * hangs[number]
            if joint.kind == "prismatic":
                exerted = abs(load.sum() * axis[2])
            else:
                arms = centres - origin  # torque of a force straight down about the axis
                exerted = abs(float(load @ (arms[:, 1] * axis[0] - arms[:, 0] * axis[1])))
            worst[number] = max(worst[number], exerted)
    return worst
