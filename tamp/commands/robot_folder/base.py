"""The base that carries the arm: one that drives, or a plate on something."""

from __future__ import annotations

import numpy as np

from tamp.commands.robot_folder.arm import Arm
from tamp.errors import InputError
from tamp.geometric.loading.robot_base import SUNK_M
from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Hull, Part

BOX = (0.8, 0.7, 0.33)
"""Edge lengths of the driving base that carries an arm without one, metres,"""

MOUNT = (0.3, 0.0, 0.35)
"""and where on it the arm is bolted."""

CLEAR = 0.02
"""Metres under a driving base."""

PLATE = (0.16, 0.16, 0.01)
"""Edge lengths of the plate under an arm that does not drive, metres,"""

AIR = 0.004
"""and how far that stays off what it is put on, so that standing is no collision."""

LOW = 0.4
"""Metres: what of a robot's own base is below this, its box contains."""

BASE_VELOCITY, BASE_ACCELERATION = (0.6, 0.6, 1.0), (0.8, 0.8, 1.5)


def choose_base(
    drive: str,
    height: float,
    mount_at: tuple[float, float, float, float] | None,
    arm: Arm,
    foot: Link,
) -> tuple[Part, Pose, tuple[float, float, float], tuple[float, float, float]]:
    """Choose the base's box and where the arm is on it: a plate under an arm that does not drive,
    our box under one that has no base, else the box around the robot's own.

    Raises:
        InputError: Mounted so, what the arm stands on reaches into the floor.
    """
    mount = None if mount_at is None else Pose.from_xyz_yaw(*mount_at)
    own = len(arm.groups[0].links) > 1 and _tall(arm, foot)
    low, _ = bounds(foot.parts, arm.T_root_foot) if foot.parts else (np.zeros(3), np.zeros(3))

    if mount_at is not None and mount_at[2] + low[2] < -SUNK_M:
        raise InputError(
            f"--mount: {foot.name} reaches {-mount_at[2] - low[2]:.3g} m into the floor",
            remedy=f"Mount it {-low[2]:.3g} m high or more",
        )
    if drive == "fixed":
        top = height + AIR + PLATE[2]
        T_base_root = mount or Pose((0.0, 0.0, top + max(0.0, -float(low[2])) + 1e-3))
        box = Part(Box(PLATE), Pose((0.0, 0.0, height + AIR + PLATE[2] / 2)))
        still = (0.01, 0.01, 0.01)
        return box, T_base_root @ arm.T_root_foot, still, still
    if own:
        T_base_root = mount or Pose((0.0, 0.0, CLEAR - float(low[2])))
        return (
            _around(foot, T_base_root @ arm.T_root_foot),
            T_base_root @ arm.T_root_foot, BASE_VELOCITY, BASE_ACCELERATION,
        )  # fmt: skip
    x, y, z = MOUNT
    T_base_root = mount or Pose((x, y, max(z, CLEAR - float(low[2]))))  # legs stand beside the box
    box = Part(Box(BOX), Pose((0.0, 0.0, CLEAR + BOX[2] / 2)))
    return box, T_base_root @ arm.T_root_foot, BASE_VELOCITY, BASE_ACCELERATION


def on_our_box(robot: Robot) -> bool:
    """Check whether an arm is driven by the box that arms without a base get."""
    shape = robot.link(robot.base).parts[0].shape
    return robot.drive != "fixed" and isinstance(shape, Box) and shape.size == BOX


def _tall(arm: Arm, foot: Link) -> bool:
    """Check whether what the arm stands on is a base of its own: wide, from the floor up."""
    if not foot.parts:
        return False
    low, high = bounds(foot.parts, arm.T_root_foot)
    return bool(((high - low)[:2] > 0.3).all())


def _around(foot: Link, T_base_foot: Pose) -> Part:
    """Return the box around what is low of the foot."""
    corners = np.concatenate(
        [T_base_foot.apply(part.shape.vertices) for part in foot.parts
         if isinstance(part.shape, Hull)]
    )  # fmt: skip
    some = corners[corners[:, 2] < LOW]
    low, high = some.min(axis=0), some.max(axis=0)
    half = np.abs(np.stack([low, high])).max(axis=0)[:2]  # about the base's origin
    x, y, z = 2 * half[0], 2 * half[1], high[2] - CLEAR
    return Part(Box((float(x), float(y), float(z))), Pose((0.0, 0.0, CLEAR + float(z) / 2)))
