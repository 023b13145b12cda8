"""Stability test: do bodies stay where they are put, when gravity is on?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.simulation.engines import open_world


@dataclass(frozen=True)
class Settled:
    """The displacement of a body while it settled: metres of its frame's origin, radians of its
    orientation.
    """

    moved: float
    turned: float


def settle(scene: Scene, poses: Mapping[str, Pose], seconds: float = 2.0) -> dict[str, Settled]:
    """Let the movable bodies go at given poses and say how far each went after some time under
    gravity.

    Args:
        scene: Movable bodies that `poses` leaves out stand at their starts.
        poses: T_world_body by body.
        seconds: Of simulated time.
    """
    settled = {}
    with open_world(scene, dynamic=True) as world:
        for name, pose in poses.items():
            world.place(name, pose.matrix)
        before = {name: world.pose(name) for name in scene.movable}
        world.step(seconds)
        for name, T_before in before.items():
            T_after = world.pose(name)
            cosine = (np.trace(T_before[:3, :3].T @ T_after[:3, :3]) - 1) / 2
            moved = float(np.linalg.norm(T_after[:3, 3] - T_before[:3, 3]))
            settled[name] = Settled(moved, math.acos(float(np.clip(cosine, -1.0, 1.0))))
    return settled
