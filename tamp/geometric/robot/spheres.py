"""Covers of the robot's links by spheres: every point of a link lies in one of its spheres."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


def link_covers(robot: Robot) -> dict[tuple[str, int], tuple[Float[Array, "_ 4"], float]]:
    """Load the shipped cover of each part by (link, number): centres and radii (k, 4) in the part's
    frame, and its slack.

    Made by benchmarks/build_robot_spheres.py. A robot without a shipped cover has none: the kernels
    then use the bounding spheres and the exact test alone.
    """
    path = Path(__file__).parent / "assets" / f"{robot.name}_spheres.npz"
    if not path.exists():
        return {}
    arrays = np.load(path)
    covers = {}
    for link in robot.links:
        for k in range(len(link.parts)):
            key = f"{link.name}/{k}"
            if key in arrays:
                covers[link.name, k] = (arrays[key], float(arrays[f"{key}/slack"]))
    return covers
