"""The axis-aligned box of a posed body against points of its surface."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere
from tests.geometric.making import cuboid, hull

_ANGLE = st.floats(-math.pi, math.pi)
_TURNS = st.tuples(_ANGLE, _ANGLE, _ANGLE)


def rim(radius: float, height: float, count: int = 720) -> np.ndarray:
    """Points of both rims of a cylinder, which hold every extreme of it."""
    angle = np.linspace(0.0, 2 * math.pi, count, endpoint=False)
    circle = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.concatenate(
        [np.column_stack([circle, np.full(count, z)]) for z in (-height / 2, height / 2)]
    )


def test_of_an_upright_box_they_are_its_corners() -> None:
    low, high = bounds([Part(Box((0.2, 0.4, 0.6)))], Pose((1.0, 2.0, 3.0)))
    assert low == pytest.approx([0.9, 1.8, 2.7])
    assert high == pytest.approx([1.1, 2.2, 3.3])


def test_a_cube_on_its_edge_is_wider_by_the_root_of_two() -> None:
    low, high = bounds([Part(Box((1.0, 1.0, 1.0)))], Pose.from_xyz_yaw(0.0, 0.0, 0.0, math.pi / 4))
    assert high - low == pytest.approx([math.sqrt(2), math.sqrt(2), 1.0])


@given(_TURNS)
@settings(max_examples=40)
def test_of_a_turned_box_and_hull_they_touch_the_extreme_corners(
    turn: tuple[float, float, float],
) -> None:
    pose = Pose.from_xyz_rpy((0.1, -0.2, 0.3), turn)
    corners = pose.apply(cuboid((0.3, 0.5, 0.7)))
    for shape in (Box((0.3, 0.5, 0.7)), hull(cuboid((0.3, 0.5, 0.7)))):
        low, high = bounds([Part(shape)], pose)
        assert low == pytest.approx(corners.min(axis=0))
        assert high == pytest.approx(corners.max(axis=0))


@given(_TURNS)
@settings(max_examples=40)
def test_of_a_turned_cylinder_they_touch_its_rims(turn: tuple[float, float, float]) -> None:
    pose = Pose.from_xyz_rpy((0.0, 0.0, 0.5), turn)
    points = pose.apply(rim(0.3, 0.8))
    low, high = bounds([Part(Cylinder(0.3, 0.8))], pose)
    # 720 points miss the extreme of a rim by at most r (1 - cos(quarter of a degree)).
    assert (low <= points.min(axis=0) + 1e-9).all() and low == pytest.approx(
        points.min(axis=0), abs=5e-6
    )
    assert (high >= points.max(axis=0) - 1e-9).all() and high == pytest.approx(
        points.max(axis=0), abs=5e-6
    )


@given(_TURNS)
def test_a_sphere_does_not_mind_how_it_is_turned(turn: tuple[float, float, float]) -> None:
    low, high = bounds([Part(Sphere(0.25))], Pose.from_xyz_rpy((1.0, 1.0, 1.0), turn))
    assert low == pytest.approx([0.75] * 3)
    assert high == pytest.approx([1.25] * 3)


def test_of_several_parts_they_hold_all_at_their_own_poses() -> None:
    parts = [
        Part(Box((0.2, 0.2, 0.2)), Pose((0.5, 0.0, 0.0))),
        Part(Sphere(0.1), Pose((-0.5, 0.0, 0.4))),
    ]
    low, high = bounds(parts, Pose.from_xyz_yaw(0.0, 0.0, 1.0, math.pi / 2))
    # A quarter turn brings the body's x to the world's y.
    assert low == pytest.approx([-0.1, -0.6, 0.9])
    assert high == pytest.approx([0.1, 0.6, 1.5])
