"""Bricks on a table and above it, made by hand and measured."""

from __future__ import annotations

import numpy as np

from grounding.relational.measures import Measures, RegionFrame
from tamp.geometric.scene.pose import Pose
from tests.grounding.forms import TOP, at, box, on_table


def bricks(count: int, seed: int = 0) -> tuple[list[Measures], np.ndarray]:
    """Scenes of one pose each: every second brick stands on the table, the others hang 0.1 to 0.3 m above it.

    Up to two cubes are beside it.
    """
    rng = np.random.default_rng(seed)
    found: list[Measures] = []
    holds = np.arange(count) % 2 == 0
    for number, stands in enumerate(holds):
        cubes = [
            at(box(0.05, 0.05, 0.05), *rng.uniform(-0.2, 0.2, 2), TOP + 0.025)
            for _ in range(number % 3)
        ]
        form = box(*rng.uniform([0.05, 0.05, 0.05], [0.1, 0.08, 0.2]))
        view = RegionFrame(on_table(at(form, 0.0, 0.0, 1.0), *cubes))
        z = form.corners[1, 2] + (0.0 if stands else rng.uniform(0.1, 0.3))
        pose = Pose.from_xyz_yaw(*rng.uniform(-0.2, 0.2, 2), float(z), rng.uniform(-3, 3)).matrix
        found.append(view.measure(pose[None].copy()))
    return found, holds
