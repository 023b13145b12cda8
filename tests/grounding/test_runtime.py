"""A grounding as the planner calls it: poses and placements out, a probability within its bounds."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.runtime import laid
from tamp.geometric.scene.pose import Pose
from tamp.geometric.stability.placement import Placement
from tamp.geometric.stability.stable_poses import stable_faces_of
from tests.grounding.forms import with_brick


def test_a_pose_near_the_region_becomes_a_placement_on_its_face() -> None:
    made = with_brick()
    faces = stable_faces_of(made.bodies["brick"])
    rotation, pose = faces.ways[0].rotation, made.bodies["brick"].pose
    found = laid(made, ("brick", "table"), rotation, pose.matrix)
    assert isinstance(found, Placement) and (found.region, found.face) == ("table", 0)
    assert (found.x, found.y) == pytest.approx((0.2, 0.1))
    high = Pose((0.2, 0.1, 2.0))
    assert laid(made, ("brick", "table"), rotation, high.matrix) == high
    assert laid(
        made, ("brick", "table"), np.eye(3)[[1, 2, 0]] * 0.5, pose.matrix
    ) == Pose.from_matrix(pose.matrix)
