"""The pose and the orientation that a problem file gives a body."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.pose import Pose


def read_pose(node: YamlNode) -> Pose:
    """Read the pose `{position: [x, y, z]}` with `quaternion: [x, y, z, w]`, `rpy: [r, p, y]` or
    `yaw:`; none of them is upright.
    """
    entries = node.mapping(("position", "quaternion", "rpy", "yaw"), required=("position",))
    x, y, z = entries["position"].numbers(3)
    return Pose((x, y, z), read_orientation(entries))


def read_orientation(entries: Mapping[str, YamlNode]) -> tuple[float, float, float, float]:
    """Read the unit quaternion from `quaternion:`, `rpy:` or `yaw:`; upright when there is none.

    Raises:
        InputError: More than one of them, or a quaternion that is far from unit norm.
    """
    given = [key for key in ("quaternion", "rpy", "yaw") if key in entries]
    if len(given) > 1:
        raise entries[given[1]].error(
            f"'{given[0]}' and '{given[1]}' both say how it is turned: keep one"
        )

    if not given:
        return Pose().quaternion
    node = entries[given[0]]

    if given[0] == "yaw":
        return Pose.from_xyz_yaw(0, 0, 0, node.angle()).quaternion
    if given[0] == "rpy":
        roll, pitch, yaw = (item.angle() for item in node.items(3))
        return Pose.from_xyz_rpy((0, 0, 0), (roll, pitch, yaw)).quaternion

    values = np.array(node.numbers(4))
    norm = float(np.linalg.norm(values))
    if norm < 1e-9:
        raise node.error(
            "a quaternion of norm 0 is no rotation",
            remedy="No rotation is [0, 0, 0, 1] (x, y, z, w)",
        )
    if abs(norm - 1) > 0.01:
        raise node.error(
            f"the quaternion's norm is {norm:.3g}, not 1", remedy="Is its order x, y, z, w?"
        )

    x, y, z, w = (float(value) for value in values / norm)
    return (x, y, z, w)
