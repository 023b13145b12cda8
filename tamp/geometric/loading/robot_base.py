"""The base in a robot's file, and whether the robot stands above the floor with it."""

from __future__ import annotations

from collections.abc import Mapping

from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.robot.robot import TURNING_RADII_M, Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose

SUNK_M = 1e-3
"""How far a robot's foot may reach below the floor, metres."""


def read_turning_radius(base: Mapping[str, YamlNode]) -> float | None:
    """Read how tight a circle the base drives, metres: of a car, and of a car alone.

    Raises:
        InputError: A car has none, another drive has one, or it is too large or too small.
    """
    drive = base["drive"].text()
    if "turning_radius" in base:
        if drive != "car":
            raise base["turning_radius"].error(
                f"a turning_radius is a car's, not of a {drive} base"
            )
        least, most = TURNING_RADII_M
        return base["turning_radius"].number(low=least, high=most)
    if drive == "car":
        raise base["drive"].error(
            "a car needs a turning_radius", remedy="That of the tightest circle, metres, beside it"
        )
    return None


def check_above_floor(robot: Robot, mount: YamlNode) -> None:
    """Refuse an arm whose foot reaches into the floor, where no plan would be one.

    Raises:
        InputError: It does; by how much.
    """
    foot = robot.link(robot.foot)
    if not foot.parts:
        return
    low = float(bounds(foot.parts, robot.T_base_arm if robot.foot != robot.base else Pose())[0][2])
    if low < -SUNK_M:
        raise mount.error(
            f"{robot.foot} reaches {-low:.3g} m into the floor", remedy="Mount it higher"
        )
