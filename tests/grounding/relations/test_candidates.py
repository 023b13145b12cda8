"""Candidates: scenes in which a relation is proposed, whatever becomes of the body that is let go."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.relations.candidates import _at_rest, _on_floor
from grounding.relations.demonstration_text import BodyEntry
from grounding.relations.scenes import loaded
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.simulation.engines import open_drops

TABLE = BodyEntry({"furniture": "table", "size": [1.0, 0.7, 0.6]}, Pose.from_xyz_yaw(1.0, 0, 0, 0))


@pytest.mark.parametrize("beyond", [0.0, 0.8])
def test_a_body_that_fell_to_the_floor_makes_a_scene(beyond: float) -> None:
    """An engine may let it sink by some millimetres, which the reader of a scene refuses."""
    thing = BodyEntry({"box": [0.06, 0.08, 0.2]}, Pose.from_xyz_yaw(1.0, 0.0, 0.702, 0.3))
    bodies = {"table": TABLE, "thing": thing}
    scene = loaded(bodies, ("thing", "table"))
    above = Pose.from_xyz_yaw(1.0 + beyond, 0.0, 0.705, 0.3)
    with open_drops() as drops:
        pose = _at_rest(drops, scene, "thing", above)

    fell = bool(bounds(scene.bodies["thing"].parts, pose)[0][2] < 0.3)
    assert fell is (beyond > 0.0)
    there = loaded({"table": TABLE, "thing": BodyEntry(thing.shape, pose)}, ("thing", "table"))
    assert np.allclose(there.bodies["thing"].pose.position, pose.position, atol=0.003)


def test_what_sank_into_the_floor_is_lifted_by_so_much_and_nothing_else() -> None:
    thing = BodyEntry({"box": [0.06, 0.08, 0.2]}, Pose.from_xyz_yaw(1.0, 0.0, 0.702, 0.3))
    body = loaded({"table": TABLE, "thing": thing}, ("thing", "table")).bodies["thing"]
    sunk = Pose.from_xyz_yaw(2.0, 0.1, 0.1 - 0.004, 0.3)
    assert _on_floor(body, sunk).position == pytest.approx((2.0, 0.1, 0.1))
    lying = Pose.from_xyz_yaw(2.0, 0.1, 0.1, 0.3)
    assert _on_floor(body, lying) == lying
