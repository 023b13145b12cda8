"""Write panda_mobile's reachability.npz, the table that base poses are drawn from; tamp-robot makes other robots'.

    python benchmarks/build_reachability.py

Four minutes. Each cell counts the comfortable solutions at its centre: away from joint limits and singularities, arm
clear of the base, and with joint 1 far enough from its limits that the base may turn under the arm. A cell counts no
more than its neighbours with nearby heights, distances and headings do: a draw anywhere in a cell is likely to succeed.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy.ndimage import minimum_filter

from benchmarks.common import without_options
from tamp.commands.robot_folder.reach_table import directions, rotation_with_up
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.reachability import asset
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box

HEIGHTS = np.arange(0.0, 1.7, 0.07)
DISTANCES = np.arange(0.075, 0.9, 0.05)
HEADINGS = 24
SEVENTHS = 12
LEAST_MANIPULABILITY = 0.02
TURN = 1.6
"""Radians of joint 1 that a comfortable solution may use at bearing 0; the rest is left for the base's yaw."""


def comfortable(robot: Robot, kinematics: Kinematics, solutions: Array) -> int:
    """How many solutions (n, 7) are away from limits, singularities and the base."""
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    margin = 0.03 * (upper - lower)
    kept = solutions[np.all((solutions > lower + margin) & (solutions < upper - margin), axis=1)]
    count = 0
    base = robot.link(robot.base).parts[0]
    assert isinstance(base.shape, Box)
    half = np.array(base.shape.size) / 2
    for q in kept[np.abs(kept[:, 0]) < TURN]:
        conf = np.concatenate([np.zeros(3), q])
        jacobian = kinematics.jacobian(conf)[:, 3:]
        if np.sqrt(max(0.0, np.linalg.det(jacobian @ jacobian.T))) < LEAST_MANIPULABILITY:
            continue
        poses = kinematics.link_poses(conf, robot.opening)
        points = np.array([poses[link.name][:3, 3] for link in robot.links[6:]] + [kinematics.tool(conf)[:3, 3]])
        outside = np.maximum(np.abs(points - base.pose.matrix[:3, 3]) - half, 0.0)
        count += bool(np.all(np.linalg.norm(outside, axis=1) > 0.08))
    return count


def build(robot: Robot) -> dict[str, Array]:
    """The table's arrays."""
    ik, kinematics = ArmIK(robot, coarse=SEVENTHS, fine=SEVENTHS), Kinematics(robot)
    ups = directions()
    rotations = np.array([rotation_with_up(up) for up in ups])
    counts = np.zeros((len(HEIGHTS), len(ups), len(DISTANCES), HEADINGS), dtype=np.uint8)
    foot = robot.T_base_arm.position
    for (h, height), (d, rotation) in itertools.product(enumerate(HEIGHTS), enumerate(rotations)):
        for (r, distance), c in itertools.product(enumerate(DISTANCES), range(HEADINGS)):
            yaw = c * 2 * np.pi / HEADINGS
            T = np.eye(4)
            T[:3, :3] = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]]) @ rotation
            T[:3, 3] = foot[0] + distance, foot[1], height
            solutions = ik.solve(T)
            if len(solutions):
                counts[h, d, r, c] = min(255, comfortable(robot, kinematics, solutions))
    eroded = minimum_filter(counts, size=(3, 1, 3, 1), mode="nearest")
    eroded = minimum_filter(eroded, size=(1, 1, 1, 3), mode="wrap")
    return {"heights": HEIGHTS, "directions": ups, "rotations": rotations, "distances": DISTANCES, "counts": eroded}


def main() -> None:
    """Build the table of the robot with seven joints whose closed form counts solutions by the last one."""
    robot = ROBOTS["panda_mobile"]()
    np.savez_compressed(asset(robot), **build(robot))  # pyright: ignore[reportArgumentType]


if __name__ == "__main__":
    without_options(__doc__)
    main()
