"""Covers of the robot's links by spheres: every point of a link lies in one of its spheres."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


def link_covers(robot: Robot) -> dict[tuple[str, int], tuple[Float[Array, "_ 4"], float]]:
    """Load the cover of each part by (link, number): centres and radii (k, 4) in the part's frame,
    and its slack.

    For a part without a cover the kernels use its bounding sphere and the exact test alone.
    """
    covers = {}
    with np.load(robot.folder / "geometry.npz", allow_pickle=False) as arrays:
        for link in robot.links:
            for k in range(len(link.parts)):
                key = f"{link.name}/{k}"
                if f"{key}/spheres" in arrays:
                    covers[link.name, k] = (arrays[f"{key}/spheres"], float(arrays[f"{key}/slack"]))
    return covers
