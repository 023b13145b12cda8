"""On which side of the furniture one stands who says left, right, behind."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.scene import sample_stage
from grounding.demonstrate.viewer import front_edge, stand_of, viewer_yaw
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose


@pytest.mark.parametrize("quarter", range(4))
def test_the_front_is_the_side_from_which_one_looks(quarter: int) -> None:
    stage = sample_stage(parse_relation("left_of(a, b)"), np.random.default_rng(3))
    stand = stand_of(stage.scene, stage.arguments)
    assert stand is not None
    eye = (
        stand.pose.yaw - np.pi / 2 + quarter * np.pi / 2 + 0.6
    )  # nearer to this side than to the next
    turned = stage.fronted(eye)
    body = turned.scene.bodies[stand.name]
    assert body.front == pytest.approx(quarter * np.pi / 2)
    seen = viewer_yaw(turned.scene, turned.arguments)
    assert np.cos(seen - (eye + np.pi)) == pytest.approx(np.cos(0.6))
    first = stage.arguments[0]
    assert turned.scene.bodies[first].pose == stage.scene.bodies[first].pose

    edge, (low, high) = front_edge(body), bounds(body.parts, Pose())
    x, y, z = body.pose.inverse().apply(edge[None])[0]
    sides = [(0.0, low[1]), (high[0], 0.0), (0.0, high[1]), (low[0], 0.0)]
    assert (x, y, z) == pytest.approx((*sides[quarter], high[2]), abs=1e-6)
