"""Drop tests: distances of compounds, and what stands and what falls."""

from __future__ import annotations

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Part
from tamp.simulation.drops import Item
from tamp.simulation.engines import open_drops


def test_a_box_stands_flat_and_falls_from_its_edge() -> None:
    table = Item((Part(Box((1.0, 1.0, 0.1)), Pose((0.0, 0.0, 0.45))),))
    box = Item(
        (Part(Box((0.05, 0.05, 0.1))), Part(Box((0.1, 0.05, 0.02)), Pose((0.0, 0.0, -0.04))))
    )
    flat = Pose((0.0, 0.0, 0.551)).matrix
    with open_drops() as drops:
        drops.set_up(box, [(table, np.eye(4))])
        (contact,) = drops.contacts(flat)
        assert contact.obstacle == 0 and abs(contact.distance - 0.001) < 1e-4
        assert np.linalg.norm(drops.drop(flat, 1.0)[:3, 3] - flat[:3, 3]) < 0.003
        tilted = Pose.from_xyz_rpy((0.0, 0.0, 0.56), (0.9, 0.0, 0.0)).matrix
        assert np.linalg.norm(drops.drop(tilted, 1.0)[:3, :3] - tilted[:3, :3]) > 0.3
