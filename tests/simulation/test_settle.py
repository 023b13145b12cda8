"""Bodies stay where they are put, or fall, and how far is told."""

from __future__ import annotations

import math

import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import (
    Body,
    Box,
    Cylinder,
    Part,
)
from tamp.simulation.settle import settle
from tests.simulation.scenes import body, cube_hull, scene_of


def test_a_resting_body_stays_and_a_leaning_one_falls() -> None:
    table = Body("table", (Part(Box((1.0, 1.0, 0.1))),), Pose((0, 0, 0.5)), movable=False)
    block, bottle = (
        body("block", Part(Box((0.06, 0.06, 0.2)))),
        body("bottle", Part(cube_hull(0.06))),
    )
    ball = body("two", Part(cube_hull(0.04)), Part(Cylinder(0.02, 0.04), Pose((0, 0, 0.04))))
    poses = {
        "block": Pose((0, 0, 0.651)),
        "bottle": Pose((0.49, 0, 0.581)),
        "two": Pose.from_xyz_yaw(-0.3, 0.2, 0.571, 0.4),
    }
    settled = settle(scene_of(table, block, bottle, ball), poses, 1.0)
    assert all(one.moved < 0.003 and one.turned < 0.02 for one in settled.values()), settled
    poses["bottle"] = Pose((0.51, 0, 0.581))
    poses["block"] = Pose.from_xyz_rpy((0, 0, 0.66), (0.5, 0, 0))
    settled = settle(scene_of(table, block, bottle, ball), poses, 1.0)
    assert settled["block"].turned > 0.5 and settled["bottle"].moved > 0.1
    assert settled["two"].moved < 0.003


def test_how_far_a_body_went_is_told_in_metres_and_radians() -> None:
    """A cube on its edge above the floor tips onto a side; one that lies stays; a fixed one is no matter."""
    half = 0.05
    post = body("post", Part(cube_hull(0.1)), at=(1.0, 0.0, 3.0), movable=False)
    cube, lying = (body(name, Part(cube_hull(2 * half))) for name in ("cube", "lying"))
    tilted = Pose.from_xyz_rpy(
        (0.0, 0.0, half * math.sqrt(2) + 1e-3), (math.pi / 4 - 0.05, 0.0, 0.0)
    )
    poses = {"cube": tilted, "lying": Pose((1.0, 1.0, half))}
    settled = settle(scene_of(post, cube, lying), poses, 2.0)
    assert settled.keys() == {"cube", "lying"}
    assert settled["cube"].turned == pytest.approx(math.pi / 4 - 0.05, abs=0.03)
    assert settled["lying"].turned < 0.01 and settled["lying"].moved < 0.002
