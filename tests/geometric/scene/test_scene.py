"""A scene knows its bodies in the problem's order, and where their places are in the world."""

from __future__ import annotations

import dataclasses
import math

import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cavity, Surface
from tests.geometric.making import body, crate, scene, table

CUP = body("cup", Box((0.1, 0.1, 0.1)), (0.0, 0.0, 0.55))
BOOK = body("book", Box((0.2, 0.1, 0.05)), (0.3, 0.0, 0.525))


def test_bodies_keep_the_problems_order() -> None:
    made = scene(CUP, table(), BOOK, crate())
    assert made.movable == ("cup", "book")
    assert made.fixed == ("table", "crate")


def test_places_are_found_by_name_whatever_their_kind() -> None:
    made = scene(table(), crate())
    assert isinstance(made.region("table"), Surface)
    assert isinstance(made.region("crate_inside"), Cavity)
    assert list(made.surfaces) == ["table"] and list(made.cavities) == ["crate_inside"]
    with pytest.raises(KeyError):
        made.region("crate")


def test_a_place_stands_where_its_body_does() -> None:
    turned = dataclasses.replace(table(), pose=Pose.from_xyz_yaw(1.0, 2.0, 0.25, math.pi / 2))
    top = dataclasses.replace(turned.surfaces[0], pose=Pose((0.3, 0.0, 0.25)))
    made = scene(dataclasses.replace(turned, surfaces=(top,)))
    # The body's x points along the world's y.
    assert made.world_pose(made.region("table")).position == pytest.approx((1.0, 2.3, 0.5))


def test_a_scene_is_frozen() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        scene(table()).name = "other"  # type: ignore[misc]
