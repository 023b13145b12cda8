"""Everything that a robot is made of, as the page shows it: ranges of joints, spheres, reach."""

from __future__ import annotations

from typing import Any

import numpy as np

from tamp.geometric.robot.reachability import reached_share
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.spheres import link_covers
from tamp.geometric.robot.states import columns

DIGITS = 5
"""Of the metres that are told: a hundredth of a millimetre."""


def inspection(robot: Robot) -> dict[str, Any]:
    """Describe the joints' ranges, the spheres around the links and where the tool gets.

    Raises:
        InputError: The reachability table of a robot of one arm is missing or damaged.
    """
    return {
        "joints": _joints(robot),
        "spheres": _spheres(robot),
        "reach": [] if robot.beside else _reach(robot),
        "foot": list(robot.T_base_arm.position[:2]),
    }


def _joints(robot: Robot) -> list[dict[str, Any]]:
    """Describe the joints in a row's order, from the base's coordinates on; of each arm the last is
    the opening.
    """
    found: list[dict[str, Any]] = []
    for arm, where in zip(robot.arms, columns(robot), strict=True):
        limits = zip(arm.joints, arm.lower, arm.upper, strict=True)
        found += [
            {
                "name": joint.name, "column": column, "low": low, "high": high,
                "unit": "m" if joint.kind == "prismatic" else "rad",
            }
            for column, (joint, low, high) in enumerate(limits, start=where.start)
        ]  # fmt: skip
        if arm.fingers:
            name, column = f"{arm.arm}'s fingers" if robot.beside else "fingers", where.stop - 1
            found.append(
                {"name": name, "column": column, "low": 0.0, "high": arm.opening, "unit": "m"}
            )
    return found


def _spheres(robot: Robot) -> dict[str, list[list[float]]]:
    """List centre and radius of each sphere in its link's frame, metres, by link."""
    found: dict[str, list[list[float]]] = {}
    for (name, number), (spheres, _) in link_covers(robot).items():
        pose = robot.link(name).parts[number].pose
        rows = np.column_stack([pose.apply(spheres[:, :3]), spheres[:, 3]])
        found.setdefault(name, []).extend(np.round(rows, DIGITS).tolist())
    return found


def _reach(robot: Robot) -> list[list[float]]:
    """List distance from the foot, height and share of directions of the places that the tool
    gets to.
    """
    heights, distances, share = reached_share(robot)
    level, row = np.nonzero(share)
    places = np.column_stack([distances[row], heights[level], share[level, row]])
    return np.round(places, DIGITS).tolist()
