"""Directions of grasps: unit vectors, square to each other, that come from above and the sides only."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Shape, Sphere
from tamp.geometric.stability.ray_crossings import ConvexUnion
from tamp.geometric.streams.grasp_directions import (
    LEVEL_CLOSING,
    MAX_UPWARD_PART,
    across,
    angles,
    closing_axes,
    cross,
    slanted,
    straight,
)
from tests.geometric.making import cuboid, hull

UP = np.array([0.0, 0.0, 1.0])
_NUMBER = st.floats(-10, 10)


def axes(
    shape: Shape, widest: float = 0.08, up: np.ndarray = UP, pose: Pose = Pose()
) -> np.ndarray:
    body = Body("thing", (Part(shape, pose),), Pose(), True)
    return np.array(
        closing_axes(body, ConvexUnion(body), up, widest, np.random.default_rng(0))
    ).reshape(-1, 3)


def has(found: np.ndarray, direction: list[float]) -> bool:
    return bool((found @ np.array(direction) > 1 - 1e-9).any())


def test_a_box_is_grasped_along_the_edges_that_fit_both_ways() -> None:
    found = axes(Box((0.05, 0.2, 0.08)))
    assert len(found) == 4
    for direction in ([1, 0, 0], [-1, 0, 0], [0, 0, 1], [0, 0, -1]):
        assert has(found, direction)
    assert len(axes(Box((0.1, 0.2, 0.3)))) == 0


def test_a_turned_boxs_edges_are_its_own() -> None:
    found = axes(Box((0.05, 0.2, 0.2)), pose=Pose.from_xyz_yaw(0, 0, 0, 0.5))
    assert len(found) == 2 and has(found, [math.cos(0.5), math.sin(0.5), 0.0])


@pytest.mark.parametrize(
    "shape", [Cylinder(0.03, 0.1), Sphere(0.03), hull(cuboid((0.05, 0.06, 0.1)))], ids=type
)
def test_round_and_other_bodies_are_grasped_all_around(shape: Shape) -> None:
    found = axes(shape)
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.ones(len(found)))
    for axis in found:  # each with both signs
        assert has(found, (-axis).tolist())
    level = found[np.abs(found @ UP) < 1e-9]
    turns = np.sort(np.arctan2(level[:, 1], level[:, 0]))
    assert np.diff(np.append(turns, turns[0] + 2 * math.pi)).max() <= math.pi / 4 + 1e-6


def test_the_narrowest_directions_of_a_hull_are_among_them() -> None:
    found = axes(
        hull(cuboid((0.04, 0.3, 0.1)) @ np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]]))
    )
    nearest = np.degrees(np.arccos((found @ [0.8, 0.6, 0.0]).max()))
    assert nearest <= 1.0  # of the 180 that are looked at


@given(_NUMBER, _NUMBER, _NUMBER)
def test_across_is_square_and_looks_down(x: float, y: float, z: float) -> None:
    length = math.sqrt(x * x + y * y + z * z)
    if length < 1e-3:
        return
    closing = np.array([x, y, z]) / length
    first, second = across(closing, UP)
    frame = np.stack([closing, first, second])
    assert np.allclose(frame @ frame.T, np.eye(3), atol=1e-9)
    if abs(closing[2]) < 0.99:
        assert first[2] == pytest.approx(-math.sqrt(1 - closing[2] ** 2))  # as much down as it can


@given(st.tuples(_NUMBER, _NUMBER, _NUMBER), st.tuples(_NUMBER, _NUMBER, _NUMBER))
def test_the_quick_cross_product_is_numpys(first: tuple, second: tuple) -> None:
    a, b = np.array(first), np.array(second)
    assert cross(a, b) == pytest.approx(np.cross(a, b), abs=1e-12)


def test_straight_approaches_come_from_above_and_the_sides() -> None:
    found = straight([np.array([1.0, 0.0, 0.0])], UP)
    assert all(closing @ approach == pytest.approx(0.0, abs=1e-12) for closing, approach in found)
    heights = sorted(round(float(approach @ UP), 9) for _, approach in found)
    assert heights == [-1.0, 0.0, 0.0]  # down and from both sides, never up
    assert all(approach @ UP < MAX_UPWARD_PART for _, approach in found)


def test_slanted_approaches_are_between_down_and_level() -> None:
    found = slanted([np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])], UP)
    assert all(abs(closing @ UP) < LEVEL_CLOSING for closing, _ in found)
    tilts = sorted({round(math.degrees(math.acos(-float(approach @ UP)))) for _, approach in found})
    assert tilts == [30, 45, 60]


@pytest.mark.parametrize(
    ("step", "count"), [(math.pi / 2, 4), (math.radians(15), 24), (2 * math.pi, 1)]
)
def test_angles_go_once_around(step: float, count: int) -> None:
    found = angles(step)
    assert (
        len(found) == count
        and found[0] == 0.0
        and (np.diff(found) == pytest.approx(step) or count == 1)
    )
