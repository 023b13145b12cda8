"""A pair is decided by its spheres where they suffice, and no part moves farther in an interval than the bound."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import njit

from tamp.geometric.collision import gjk, kernels
from tamp.geometric.collision.collisions import Collisions
from tamp.geometric.collision.edge_check import geometry_of
from tamp.geometric.collision.edge_decision import scratch
from tamp.geometric.collision.gjk import APART, BETWEEN, CLOSE
from tamp.geometric.collision.kernels import FLOOR, SELF, required_clearance
from tamp.geometric.collision.placing import place_frames, place_part
from tamp.geometric.collision.tables import CENTRE, FRAME, RADIUS, TableRows, pose_rows
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part, Shape, Sphere
from tests.geometric.making import cuboid, hull
from tests.geometric.plain_kernels import plain

SCENE = """
name: bounds
robot: {{model: {robot}, base: [0.0, 0.0, 0.0]}}
room: {{x: [-3.0, 3.0], y: [-3.0, 3.0]}}
bodies: {{can: {{cylinder: {{radius: 0.03, height: 0.1}}, at: [-1.5, -1.5, 0.052]}}}}
goal: (and)
"""


@njit
def _looked_at(conf, change, half, packed):
    """Where all parts are, (n, 12), and what each needs within the interval without a padding."""
    geometry = geometry_of(packed)
    joints, parts, part_poses = geometry[0], geometry[3], geometry[4]
    work = scratch(parts, joints, geometry[5], geometry[6], len(conf), True)
    frames, placed, reach = np.empty((len(joints) + 1, 12)), np.empty((len(parts), 12)), work[2]
    place_frames(conf, joints, frames)
    needed = np.empty(len(parts))
    for i in range(len(parts)):
        place_part(i, frames, change, joints, parts, part_poses, placed, reach)
        needed[i] = required_clearance(i, 0, half, 0.0, parts, reach)
    return placed, needed


def _changes(start: Array, end: Array) -> Array:
    step = end - start
    magnitudes = np.abs(step)
    magnitudes[0] = np.hypot(step[0], step[1])
    return np.concatenate([magnitudes, step])


@pytest.mark.parametrize("slides", [False, True])
@pytest.mark.parametrize("model", ["panda_mobile", "ur5"])
def test_no_point_of_a_part_moves_farther_than_is_reckoned_with(
    model: str, slides: bool, tmp_path: Path, rng: np.random.Generator
) -> None:
    file = tmp_path / "bounds.yaml"
    file.write_text(SCENE.format(robot=model), encoding="utf-8")
    robot = ROBOTS[model]()
    if slides:
        joints = list(robot.joints)
        joints[2] = replace(joints[2], kind="prismatic")
        robot = replace(robot, joints=tuple(joints))
    arrangement = Collisions(load_scene(file).scene, robot, Kinematics(robot)).arrangement({})
    parts, size = arrangement.tables.parts, 3 + len(robot.joints)

    tightest = np.inf
    for _ in range(150):
        start = rng.uniform(-1.5, 1.5, size)
        end = start + rng.normal(0.0, 1.0, size) * rng.choice([0.0, 0.3, 1.0], size)
        middle, half = float(rng.uniform(0.2, 0.8)), float(rng.choice([0.2, 0.05, 0.01]))
        change = _changes(start, end)

        def at(share: float, start=start, end=end, change=change, half=half) -> tuple[Array, Array]:
            return _looked_at(start + share * (end - start), change, half, arrangement.packed)

        placed, needed = at(middle)
        for share in middle + half * np.array([-1.0, -0.6, 0.6, 1.0]):
            moved, _ = at(float(share))
            for i in range(len(parts)):
                # Points all over the part's sphere.
                points = rng.normal(size=(20, 3))
                points /= np.linalg.norm(points, axis=1, keepdims=True)
                points = parts[i, CENTRE : CENTRE + 3] + points * parts[i, RADIUS]
                way = [
                    points @ rows[i, :9].reshape(3, 3).T + rows[i, 9:] for rows in (placed, moved)
                ]
                farthest = float(np.linalg.norm(way[1] - way[0], axis=1).max())
                assert farthest <= needed[i] + 1e-9
                if farthest > 1e-6:
                    tightest = min(tightest, needed[i] / farthest)
    assert tightest < 1.1  # it is a bound that means something


CUBE = Box((0.2, 0.2, 0.2))
LEAF_RADIUS_M = 0.1 * math.sqrt(3.0)
COVER = np.array([[0.0, 0.0, 0.0, LEAF_RADIUS_M]]), LEAF_RADIUS_M - 0.1
"""One sphere around the cube; in the middles of the sides it stands out."""


def asked(
    other: int, near: float, far: float, at: tuple[Pose, Pose], obstacle: Shape = CUBE,
    covered: bool = True,
) -> tuple[int, bool]:  # fmt: skip
    """What `check` says of a covered cube at the first place and what is at the second, and whether GJK was needed.

    `other` 0: an obstacle; SELF - 1: another part of the robot.
    """
    needed: list[bool] = []

    def separation(*arguments: Any) -> int:
        needed.append(True)
        return exact(*arguments)

    exact = plain(gjk).separation
    K = plain(gjk, kernels, separation=separation)
    rows = TableRows()
    cover = COVER if covered else None
    parts = np.array([rows.row(Part(CUBE), cover), rows.row(Part(obstacle))])
    poses = pose_rows(np.stack([one.matrix for one in at]))
    reach = np.array([[*pose.position, 0.0] for pose in at])
    answer = K.check(
        0, other, near, far, parts, poses, reach, parts[1:], poses[1:], rows.vertices(),
        rows.leaves(), np.zeros(3), np.empty((4, 3)), np.empty(4),
    )  # fmt: skip
    return answer, bool(needed)


@pytest.mark.parametrize("other", [0, SELF - 1])
@pytest.mark.parametrize(
    ("near", "far", "expected", "exact"),
    [
        # The leaf is 0.9 - 0.173 = 0.727 m from the other cube; it stands out by 0.073, so 0.8 is the most.
        (0.01, 0.72, APART, False),
        (0.81, 0.9, CLOSE, False),
        (0.7, 0.81, BETWEEN, False),
        (0.75, 0.78, APART, True),
        (0.79, 0.795, APART, True),
        (0.75, 0.85, BETWEEN, True),
    ],
)
def test_leaves_decide_where_they_suffice_and_separation_the_rest(
    other: int, near: float, far: float, expected: int, exact: bool
) -> None:
    """Two cubes of 0.2 m whose sides are 0.8 m apart, one of them covered by a sphere."""
    if other != 0 and (near, far) == (0.7, 0.81):
        exact = True  # without leaves the other part's slack is its whole radius
    at = Pose(), Pose((1.0, 0.0, 0.0))
    assert asked(other, near, far, at) == (expected, exact)


def test_a_hulls_box_is_no_upper_bound() -> None:
    at = Pose(), Pose((1.0, 0.0, 0.0))
    solid = hull(cuboid((0.2, 0.2, 0.2)))
    assert asked(0, 0.81, 0.9, at, solid) == (CLOSE, True)
    assert asked(0, 0.01, 0.72, at, solid) == (APART, False)


def test_a_part_without_leaves_has_its_bounding_sphere_only() -> None:
    at = Pose(), Pose((1.0, 0.0, 0.0))
    assert asked(0, 0.01, 0.72, at, covered=False) == (APART, False)
    assert asked(0, 0.81, 0.9, at, covered=False) == (CLOSE, True)


@pytest.mark.parametrize(
    ("near", "far", "expected"), [(0.1, 0.149, APART), (0.151, 0.2, CLOSE), (0.1, 0.2, BETWEEN)]
)
@pytest.mark.parametrize("shape", [CUBE, Sphere(0.1), hull(cuboid((0.2, 0.2, 0.2)))])
def test_the_floor_is_measured_to_the_lowest_point(
    shape: Shape, near: float, far: float, expected: int
) -> None:
    """Each reaches 0.1 m down from its middle at 0.25 m."""
    rows = TableRows()
    parts, poses = rows.row(Part(shape))[None], pose_rows(Pose((3.0, 4.0, 0.25)).matrix[None])
    nothing = np.empty((0, 0))
    answer = plain(gjk, kernels).check(
        0, FLOOR, near, far, parts, poses, nothing,
        nothing, nothing, rows.vertices(), nothing, nothing, nothing, nothing,
    )  # fmt: skip
    assert answer == expected


def test_clearance_is_the_lesser_of_both_bounds_and_never_below_the_padding() -> None:
    """A part moves at most by 1 m a unit of edge, at its middle by 0.2, bent by 0.4; it turns by 1 rad."""
    need = plain(kernels).required_clearance
    parts = TableRows().row(Part(Sphere(0.1)))[None]
    reach = np.array([[0, 0, 0, 0, 0, 0, 0.2, 0.4, 1.0, 1.0]], dtype=float)
    # 0.2 + 1/2 0.5 (0.4 + 0.5 x 1 x 1^2) = 0.425 a unit, for half a unit, and half the padding.
    assert need(0, 0, 0.5, 0.002, parts, reach) == pytest.approx(0.5 * 0.425 + 0.001)
    reach[0, -3] = 100.0  # bent so much that the plain bound is the lesser
    assert need(0, 0, 0.5, 0.002, parts, reach) == pytest.approx(0.5 * 1.0 + 0.001)
    assert need(0, 0, 0.0, 0.002, parts, reach) == 0.002
    assert need(0, 0, 1e-4, 0.002, parts, reach) == 0.002


def test_between_two_parts_only_the_joints_between_them_count() -> None:
    """The part on joint 1 moves by 0.3 by its joints, the one on joint 2 by 0.3 + 0.4."""
    need = plain(kernels).required_clearance
    parts = np.array([TableRows().row(Part(Sphere(0.1))) for _ in range(2)])
    parts[:, FRAME] = 1, 2
    reach = np.array([[0, 0, 0, 0.0, 0.3, 9, 9, 9, 9, 9], [0, 0, 0, 0.0, 0.3, 0.7, 9, 9, 9, 9.0]])
    for i, other in ((0, SELF - 1), (1, SELF - 0)):
        assert need(i, other, 0.5, 0.002, parts, reach) == pytest.approx(0.5 * 0.4 + 0.001)


def test_spheres_are_apart_from_the_sum_of_their_radii_and_what_is_asked_for() -> None:
    apart = plain(kernels).spheres_apart
    parts = np.array([TableRows().row(Part(Sphere(radius))) for radius in (0.1, 0.2)])
    reach = np.array([[0.0, 0.0, 0.0], [0.3, 0.4, 0.0]])  # 0.5 m
    assert apart(0, 1, 0.19, parts, reach) and not apart(0, 1, 0.21, parts, reach)
