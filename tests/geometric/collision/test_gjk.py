"""Separation of convex parts against FCL's distances, and the steps of the algorithm by hand."""

from __future__ import annotations

import math
from typing import Any

import fcl
import numpy as np
import pytest

from tamp.geometric.collision import gjk
from tamp.geometric.collision.fcl_bodies import FclBody, gap
from tamp.geometric.collision.tables import TableRows, pose_rows
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Shape, Sphere
from tests.geometric.making import cuboid, hull
from tests.geometric.plain_kernels import plain

K = plain(gjk)
SHAPES: tuple[Shape, ...] = (
    Box((0.2, 0.1, 0.3)),
    Cylinder(0.08, 0.25),
    Sphere(0.1),
    hull(cuboid((0.15, 0.2, 0.1)) + 0.02),
)


class Pair:
    """Two parts at poses, as the kernel takes them."""

    def __init__(self, first: Shape, second: Shape, T_first: Pose, T_second: Pose) -> None:
        rows = TableRows()
        self.rows = np.array([rows.row(Part(first)), rows.row(Part(second))])
        self.poses = pose_rows(np.stack([T_first.matrix, T_second.matrix]))
        self.vertices = rows.vertices()
        self.guess = np.zeros(3)

    def decide(self, near: float, far: float) -> int:
        return K.separation(
            self.rows[:1], 0, self.poses[:1], self.rows[1:], 0, self.poses[1:], self.vertices,
            near, far, self.guess, np.empty((4, 3)), np.empty(4),
        )  # fmt: skip


def random_pose(rng: np.random.Generator, spread: float) -> Pose:
    return Pose.from_xyz_rpy(
        tuple(rng.uniform(-spread, spread, 3)), tuple(rng.uniform(-math.pi, math.pi, 3))
    )


def distance(first: Shape, second: Shape, T_first: Pose, T_second: Pose) -> float:
    one, other = (FclBody((Part(shape),)) for shape in (first, second))
    a, b = one.place(0, T_first.matrix), other.place(0, T_second.matrix)
    return 0.0 if fcl.collide(a, b) else gap(a, b)


@pytest.mark.parametrize("first", SHAPES, ids=lambda one: type(one).__name__)
@pytest.mark.parametrize("second", SHAPES, ids=lambda one: type(one).__name__)
def test_each_decision_is_what_fcl_measures(first: Shape, second: Shape) -> None:
    rng, seen = np.random.default_rng(0), set()
    for _ in range(25):
        poses = random_pose(rng, 0.2), random_pose(rng, 0.2)
        true = distance(first, second, *poses)
        pair = Pair(first, second, *poses)
        for near, far in ((0.01, 0.02), (0.02, 0.1)):
            answer = pair.decide(near, far)
            seen.add(answer)
            # FCL's distances of round shapes are good to a tenth of a millimetre.
            if answer == K.APART:
                assert true >= far - 1e-4
            elif answer == K.CLOSE:
                assert true < near + 1e-4
            elif answer == K.BETWEEN:
                assert near - 1e-4 <= true < far + 1e-4
            else:
                assert min(abs(true - near), abs(true - far)) < 1e-4
    assert {K.APART, K.CLOSE} <= seen


def test_between_is_said_where_it_is_certain() -> None:
    """Two unit boxes 5 cm apart."""
    box = Box((1.0, 1.0, 1.0))
    for near, far, expected in (
        (0.01, 0.04, K.APART),
        (0.06, 0.1, K.CLOSE),
        (0.04, 0.06, K.BETWEEN),
    ):
        assert Pair(box, box, Pose(), Pose((1.05, 0.2, 0.0))).decide(near, far) == expected


def test_a_guess_that_separates_is_kept_for_the_next_time() -> None:
    pair = Pair(Box((1.0, 1.0, 1.0)), Sphere(0.1), Pose((2.0, 0.3, 0.0)), Pose())
    assert pair.decide(0.01, 0.02) == K.APART
    assert pair.guess[0] > 0.0  # from the second to the first
    assert pair.decide(0.01, 1.39) == K.APART  # 2 - 0.5 - 0.1 less a hair
    assert pair.decide(0.01, 1.5) != K.APART


@pytest.mark.parametrize(
    ("shape", "direction", "farthest"),
    [
        (Box((0.2, 0.4, 0.6)), (1.0, -2.0, 0.5), (0.1, -0.2, 0.3)),
        (Cylinder(0.3, 0.8), (3.0, 4.0, -1.0), (0.18, 0.24, -0.4)),
        (Cylinder(0.3, 0.8), (0.0, 0.0, 1.0), (0.0, 0.0, 0.4)),
        (Sphere(0.3), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)),  # the core: its radius is a margin
        (hull(cuboid((2.0, 2.0, 2.0))), (1.0, 1.0, -3.0), (1.0, 1.0, -1.0)),
    ],
)
def test_the_support_point_is_the_farthest(
    shape: Shape, direction: tuple[float, float, float], farthest: tuple[float, float, float]
) -> None:
    pair = Pair(shape, Sphere(1.0), Pose(), Pose())
    found = K.support(pair.rows, 0, pair.poses, pair.vertices, *direction)
    assert found == pytest.approx(farthest)
    # With the part turned and moved, the direction turned along.
    pose = Pose.from_xyz_rpy((1.0, 2.0, 3.0), (0.3, -0.4, 0.5))
    moved = Pair(shape, Sphere(1.0), pose, Pose())
    turned = pose.rotation @ np.array(direction)
    found = K.support(moved.rows, 0, moved.poses, moved.vertices, *turned)
    assert found == pytest.approx(pose.apply(np.array([farthest]))[0])


def nearest_by_sampling(corners: Any) -> float:
    """How near a simplex comes to the origin, over a grid of its weights."""
    steps = np.linspace(0.0, 1.0, 41)
    grid = np.stack(np.meshgrid(*[steps] * (len(corners) - 1)), axis=-1).reshape(
        -1, len(corners) - 1
    )
    grid = grid[grid.sum(axis=1) <= 1.0 + 1e-9]
    weights = np.column_stack([grid, 1.0 - grid.sum(axis=1)])
    return float(np.linalg.norm(weights @ corners, axis=1).min())


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_nearest_point_of_a_simplex(count: int) -> None:
    rng, inside = np.random.default_rng(count), 0
    for _ in range(60):
        corners = rng.normal(size=(count, 3)) + rng.normal(size=3) * 0.5
        s, weights = np.zeros((4, 3)), np.empty(4)
        s[:count] = corners
        left = K._reduce(s, count, weights)
        if left == 5:
            inside += 1
            assert nearest_by_sampling(corners) < 0.2
            continue
        assert 1 <= left <= min(count, 3)
        assert (weights[:left] > 0.0).all() and weights[:left].sum() == pytest.approx(1.0)
        found = float(np.linalg.norm(weights[:left] @ s[:left]))
        sampled = nearest_by_sampling(corners)
        assert sampled - 0.2 < found <= sampled + 1e-9
    assert (inside > 3) is (count == 4)


def test_frames_there_and_back() -> None:
    pose = Pose.from_xyz_rpy((1.0, 2.0, 3.0), (0.3, -0.4, 0.5))
    rows = pose_rows(pose.matrix[None])
    point = np.array([0.1, -0.2, 0.3])
    assert K.placed_at(rows, 0, *point) == pytest.approx(pose.apply(point[None])[0])
    assert K.in_frame(rows, 0, *K.placed_at(rows, 0, *point)) == pytest.approx(point)
    assert K.turned_back(rows, 0, *K.turned(rows, 0, *point)) == pytest.approx(point)
