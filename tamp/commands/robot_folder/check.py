"""A robot's folder against second opinions: the URDF it was made from, and a physics engine."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

# Its wheel lives behind a .pth that pyright does not run.
import pinocchio  # pyright: ignore[reportMissingImports]

from tamp.commands.robot_folder.arm import Arm
from tamp.commands.robot_folder.description import Description
from tamp.commands.robot_folder.self_collision import home_collision
from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import ArmsKinematics, Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import RobotStart, Room, Scene
from tamp.simulation.engines import default_engine, open_world
from tamp.simulation.silence import silence

STATES = 100
"""Configurations in which frames are compared."""

OFF = 5e-4
"""Metres, and entries of a rotation, by which frames may differ from the URDF's: its right angles
are made exact,"""

SAME = 2e-4
"""and from a physics engine's."""

POSES = 500
"""Reachable poses for which inverse kinematics is asked."""

FLOOR, TABLE = 0.02, 0.75
"""Metres: heights of what an arm should reach at least one of, with the hand down or forward."""


def against_urdf(robot: Robot, description: Description, arm: Arm, tip: str) -> float:
    """Compare the tip by pinocchio's reading of the URDF with ours; return the largest difference.

    Raises:
        InputError: They differ: this is a fault of ours, and such a robot is not written.
    """
    try:
        with silence():  # it remarks on links without inertia
            model = pinocchio.buildModelFromXML(_bare(description.file))
    except ValueError as error:
        what = " ".join(str(error).split())
        raise InputError(f"pinocchio refuses the URDF: {what}", file=description.file) from None
    data = model.createData()
    frames = {name: model.getFrameId(name) for name in (arm.groups[0].name, tip)}
    chain, rng, worst = Chain.of(robot), np.random.default_rng(0), 0.0

    for _ in range(STATES):
        q = rng.uniform(chain.lower, chain.upper)
        full = pinocchio.neutral(model)
        for joint, value in zip(robot.joints, q, strict=True):
            index = model.joints[model.getJointId(joint.name)]
            if index.nq == 2:  # a continuous joint is its cosine and sine there
                full[index.idx_q : index.idx_q + 2] = math.cos(value), math.sin(value)
            else:
                full[index.idx_q] = value
        pinocchio.framesForwardKinematics(model, data, full)
        foot, end = (data.oMf[number].homogeneous for number in frames.values())
        T = np.linalg.inv(foot) @ end
        worst = max(worst, float(np.abs(T - _tip(robot, arm, q)).max()))
    if worst > OFF:
        raise InputError(
            f"our kinematics of the arm differ by {worst:.2g} from pinocchio's",
            file=description.file,
        )
    return worst


def _bare(file: Path) -> str:
    """Return the URDF's joints alone, with the attributes that pinocchio wants of limits."""
    tree = read_xml(file)
    bare = ElementTree.Element("robot", name="bare")
    for link in tree.findall("link"):
        ElementTree.SubElement(bare, "link", name=link.get("name", ""))
    for joint in tree.findall("joint"):
        kept = ElementTree.SubElement(bare, "joint", joint.attrib)
        kept.extend(one for one in joint if one.tag in ("parent", "child", "origin", "axis"))
        limit = joint.find("limit")
        words = {"effort": "1", "velocity": "1"} | ({} if limit is None else limit.attrib)
        ElementTree.SubElement(kept, "limit", words)
    return ElementTree.tostring(bare, encoding="unicode")


def _tip(robot: Robot, arm: Arm, q: Array) -> Array:
    """Compute T_foot_tip by the joints as the robot's folder has them."""
    T = np.eye(4)
    for joint, value in zip(robot.joints, q, strict=True):
        motion = np.eye(4)
        if joint.kind == "prismatic":
            motion[2, 3] = value
        else:
            cos, sin = math.cos(value), math.sin(value)
            motion[:2, :2] = [[cos, -sin], [sin, cos]]
        T = T @ joint.origin.matrix @ motion
    return T @ arm.T_last_tip.matrix


def against_physics(robot: Robot) -> float:
    """Compare all links' frames with the default engine's reading of the folder's URDF; return the
    largest difference.

    Raises:
        InputError: They differ.
    """
    scene = Scene(
        "check", {}, RobotStart(robot.name, (0.0, 0.0, 0.0), None), Room((-1, 1), (-1, 1))
    )
    kinematics, rng, worst = ArmsKinematics(robot), np.random.default_rng(0), 0.0
    low, high = [-1.0] * 3, [1.0] * 3
    for arm in robot.arms:
        low, high = [*low, *arm.lower, 0.0], [*high, *arm.upper, arm.opening]
    with open_world(scene, robot) as world:
        for _ in range(STATES):
            row = rng.uniform(np.array(low), np.array(high))
            world.set_state(row)
            ours = kinematics.link_poses(row)
            for name, T in world.link_poses().items():
                worst = max(worst, float(np.abs(T - ours[name]).max()))
    if worst > SAME:
        engine = default_engine()
        raise InputError(f"our kinematics differ by {worst:.2g} from {engine}'s", file=robot.folder)
    return worst


def solved(robot: Robot) -> float:
    """Return the share of reachable poses that inverse kinematics finds."""
    ik, kinematics, rng = ArmIK(robot), Kinematics(robot), np.random.default_rng(1)
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    found = 0
    for _ in range(POSES):
        found += len(ik.solve(kinematics.arm_tool(rng.uniform(lower, upper)), enough=1)) > 0
    return found / POSES


def check_home(robot: Robot) -> None:
    """Refuse a robot that meets itself at home.

    Raises:
        InputError: Which links meet.
    """
    hit = home_collision(robot, robot.home)
    if hit is not None:
        raise InputError(f"at home {hit[0]} and {hit[1]} meet", file=robot.folder)


def check_reach(counts: Array, heights: Array, robot: Robot) -> None:
    """Refuse an arm whose table has no place at a height where things stand.

    Raises:
        InputError: It reaches neither the floor nor any table.
    """
    reached = heights[counts.reshape(len(heights), -1).any(axis=1)]
    if not len(reached) or reached.min() > TABLE + 0.5:
        least = f"nothing under {reached.min():.2f} m" if len(reached) else "nothing"
        raise InputError(
            f"the arm of {robot.name} reaches {least}: neither the floor nor any table",
            remedy="Mount it lower with --mount, or --height",
        )
