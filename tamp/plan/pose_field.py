"""A pose in a plan file: "position" and "quaternion"."""

from __future__ import annotations

import numpy as np

from tamp.geometric.scene.pose import Array, Pose
from tamp.system.json_fields import Field


def read_pose(field: Field) -> Array:
    """Read a "position" and a unit "quaternion" (x, y, z, w) as a homogeneous matrix, shape (4, 4).

    Raises:
        InputError: A number is missing, or the quaternion's norm is not 1.
    """
    position, quaternion = field["position"].numbers(3), field["quaternion"].numbers(4)
    norm = float(np.linalg.norm(quaternion))
    if abs(norm - 1.0) > 1e-3:
        raise field["quaternion"].wrong(f"its norm is {norm:.4g}, not 1")

    x, y, z, w = (quaternion / norm).tolist()
    return Pose((float(position[0]), float(position[1]), float(position[2])), (x, y, z, w)).matrix
