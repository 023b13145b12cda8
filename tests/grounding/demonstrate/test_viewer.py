"""On which side of the furniture one stands who says left, right, behind."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.scene import sample_stage
from grounding.demonstrate.viewer import depth, front_edge, nearest_side, stand_of, viewer_yaw
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box
from tests.geometric.making import body, crate, scene, table


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


def test_furniture_is_as_deep_as_its_side_behind_the_front() -> None:
    """The table is 1 m wide and 0.6 m deep."""
    assert depth(table()) == pytest.approx(0.6)
    assert depth(replace(table(), front=math.pi / 2)) == pytest.approx(1.0)
    assert depth(replace(table(), front=math.pi)) == pytest.approx(0.6)
    assert depth(replace(table(), pose=Pose.from_xyz_yaw(1.0, 0.0, 0.25, 0.7))) == pytest.approx(
        0.6
    )


@pytest.mark.parametrize(
    ("eye", "front"), [(-90, 0), (0, 90), (90, 180), (180, 270), (-180, 270), (-50, 0), (-40, 90)]
)
@pytest.mark.parametrize("yaw", [0, 30])
def test_the_front_is_the_side_nearest_to_the_eye(eye: int, front: int, yaw: int) -> None:
    stand = replace(table(), pose=Pose.from_xyz_yaw(0.0, 0.0, 0.25, math.radians(yaw)))
    assert nearest_side(stand, math.radians(eye + yaw)) == front


def test_what_the_arguments_stand_on() -> None:
    cup = replace(body("cup", Box((0.1, 0.1, 0.1)), (0.0, 0.0, 0.55)), support="table")
    spoon = replace(body("spoon", Box((0.1, 0.02, 0.02)), (2.0, 0.0, 0.03)), support="crate_inside")
    ball = body("ball", Box((0.1, 0.1, 0.1)), (5.0, 0.0, 1.0))
    made = scene(table(), crate(), cup, spoon, ball)
    for arguments, stand in (
        (("cup",), "table"), (("ball", "cup"), "table"), (("table",), "table"),
        (("spoon",), "crate"), (("spoon", "cup"), "table"), (("ball",), None),
    ):  # fmt: skip
        found = stand_of(made, arguments)
        assert (found and found.name) == stand, arguments
    assert viewer_yaw(made, ("ball",)) == pytest.approx(math.pi / 2)
