"""Random antipodal grasps: the closing line meets two faces squarely, the tips lie in the body."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Part, Shape, Sphere
from tamp.geometric.stability.ray_crossings import ConvexUnion
from tamp.geometric.streams.antipodal import (
    FINGERTIP_M,
    GRASP_DEPTHS_M,
    antipodal_grasps,
    at_depth,
    tool_pose,
)
from tamp.geometric.streams.grasp_directions import MAX_UPWARD_PART
from tamp.geometric.streams.hand_fit import FRICTION_CONE_RAD

X, Y, Z = np.eye(3)


def solid(shape: Shape) -> ConvexUnion:
    return ConvexUnion(Body("thing", (Part(shape),), Pose((0.0, 0.0, 0.0)), True))


def drawn(shape: Shape, widest: float, count: int, seed: int = 0) -> list[Array | None]:
    tries = antipodal_grasps(solid(shape), Z, widest, np.random.default_rng(seed))
    return list(itertools.islice(tries, count))


def test_grasps_of_a_box_close_on_two_opposite_faces_no_further_apart_than_the_hand_opens() -> None:
    size = np.array([0.04, 0.3, 0.06])
    body, found = (
        solid(Box(tuple(size))),
        [one for one in drawn(Box(tuple(size)), 0.08, 4000) if one is not None],
    )
    assert len(found) > 40
    axes = set[int]()
    for T in found:
        assert np.allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-9)
        assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)
        closing, axis = T[:3, 1], int(np.abs(T[:3, 1]).argmax())
        assert abs(closing[axis]) >= math.cos(FRICTION_CONE_RAD) - 1e-9
        axes.add(axis)
        assert axis != 1, "the hand does not open 30 cm"
        contact = body.solid_at(T[:3, 3], closing)
        assert contact is not None and contact.end - contact.start <= 0.08
    assert axes == {0, 2}


def test_a_body_wider_than_the_hand_has_none() -> None:
    assert not any(one is not None for one in drawn(Box((0.3, 0.3, 0.3)), 0.08, 1500))
    assert all(one is None for one in drawn(Sphere(0.05), 0.08, 1500))


def test_most_grasps_approach_from_above_and_close_level() -> None:
    found = [one for one in drawn(Sphere(0.03), 0.08, 4000) if one is not None]
    upward = np.array([T[2, 2] for T in found])
    assert len(found) > 60
    assert (upward > MAX_UPWARD_PART).mean() < 0.25
    assert (np.abs([T[2, 1] for T in found]) < 0.7).mean() > 0.8


def test_a_seed_gives_the_same_grasps() -> None:
    first, again, other = (drawn(Sphere(0.03), 0.08, 300, seed) for seed in (1, 1, 2))
    same = [
        (a is None and b is None) or (a is not None and b is not None and np.array_equal(a, b))
        for a, b in zip(first, again, strict=True)
    ]
    assert all(same)
    assert any((a is None) is not (b is None) for a, b in zip(first, other, strict=True))


@pytest.mark.parametrize("depth", GRASP_DEPTHS_M)
def test_the_tools_origin_lies_so_deep_along_the_approach(depth: float) -> None:
    body = solid(Box((0.04, 0.04, 0.2)))
    at = at_depth(body, np.array([0.0, 0.0, 0.05]), -Z, depth)
    assert at == pytest.approx([0.0, 0.0, 0.1 - depth])


def test_tips_stay_in_a_thin_body() -> None:
    body = solid(Box((0.04, 0.04, 0.02)))
    at = at_depth(body, np.zeros(3), -Z, 0.03)
    assert at == pytest.approx([0.0, 0.0, 0.01 - (0.02 - FINGERTIP_M - 0.003)])


def test_a_point_beside_the_body_is_moved_by_the_bodys_extent() -> None:
    body = solid(Box((0.04, 0.04, 0.2)))
    at = at_depth(body, np.array([0.5, 0.0, 0.0]), -Z, 0.01)
    assert at == pytest.approx([0.5, 0.0, 0.09])


def test_a_tool_pose_has_y_along_the_closing_axis_and_z_along_the_approach() -> None:
    T = tool_pose(X, -Z, np.array([0.1, 0.2, 0.3]))
    assert np.array_equal(T[:3, 1], X) and np.array_equal(T[:3, 2], -Z)
    assert np.array_equal(T[:3, 0], np.cross(X, -Z)) and T[:3, 3] == pytest.approx([0.1, 0.2, 0.3])
    assert np.array_equal(T[3], [0.0, 0.0, 0.0, 1.0])
