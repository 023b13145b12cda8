"""Motions of single joints as transforms."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from tamp.commands.robot_folder.description import MOVING, Description
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array


def stands(description: Description, joint: Joint, fixed: Mapping[str, float]) -> Array:
    """Compute the motion (4, 4) of a joint that stands still: where it is told, else as near to 0
    as it gets.
    """
    matrix = np.eye(4)
    if joint.kind not in MOVING:
        return matrix
    master, factor, offset = description.mimics.get(joint.name, (joint.name, 1.0, 0.0))
    driver = description.joints.get(master, joint)
    value = fixed.get(master, fixed.get(joint.name))
    if value is None:
        value = 0.0
        if driver.kind != "continuous" and not math.isnan(driver.lower):
            value = min(max(0.0, driver.lower), driver.upper)
    value = factor * value + offset
    axis = np.array(joint.axis)
    if joint.kind == "prismatic":
        matrix[:3, 3] = axis * value
        return matrix
    K = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    matrix[:3, :3] = np.eye(3) + math.sin(value) * K + (1.0 - math.cos(value)) * K @ K
    return matrix


def z_onto(axis: Sequence[float]) -> Array:
    """Return a rotation (4, 4) that turns z onto a unit vector, the identity where it is z."""
    z = np.array(axis)
    matrix = np.eye(4)
    if z[2] < -1.0 + 1e-12:
        matrix[:3, :3] = np.diag([1.0, -1.0, -1.0])
    elif z[2] < 1.0 - 1e-12:
        k = np.array([-z[1], z[0], 0.0])  # z cross axis
        K = np.array([[0.0, 0.0, k[1]], [0.0, 0.0, -k[0]], [-k[1], k[0], 0.0]])
        matrix[:3, :3] = np.eye(3) + K + K @ K / (1.0 + z[2])
    return matrix


def clean(matrix: NDArray[np.floating]) -> Array:
    """Round off what products of rotations leave of a zero or a one."""
    cleaned = np.array(matrix, dtype=np.float64)
    for exact in (-1.0, 0.0, 1.0):
        near = np.abs(cleaned[:3, :3] - exact) < 1e-12
        cleaned[:3, :3][near] = exact
    return cleaned
