"""Compiled measures of a pose against what they mean, worked out one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relational.kernels import constraint_violations, describe_poses
from tamp.geometric.scene.pose import Array, Pose

SIZE = np.array([0.8, 0.6, 0.3])
LOW, HIGH = np.array([[-0.22, 0.05, 0.002]]), np.array([[0.2, 0.15, 0.122]])
CENTRE = np.array([[0.06, 0.09, 0.05]])
NEAREST, STEADY = np.array([0.07]), np.array([0.4])


def described(
    pose: Array, *, down: Array | None = None, size: Array = SIZE, hollow: bool = False
) -> Array:
    """The features of one body whose box, centre and distance are those above."""
    features = np.zeros((1, 31), np.float32)
    downs = np.eye(3)[None] if down is None else down[None]
    describe_poses(
        pose[None].copy(), LOW, HIGH, CENTRE, NEAREST,
        downs.copy(), STEADY, size, hollow, features,
    )  # fmt: skip
    return features[0]


def test_lengths_are_told_coarsely_and_finely() -> None:
    """From the plane, below the ceiling, on top, at the sides, of the centre, to what is next."""
    lengths = np.array([0.002, 0.178, 0.122, 0.15, 0.18, 0.21, 0.34, 0.07])
    found = described(np.eye(4))
    assert found[:8] == pytest.approx(np.tanh(8 * lengths), abs=1e-6)
    assert found[8:16] == pytest.approx(np.tanh(100 * lengths), abs=1e-6)


def test_an_open_region_has_a_metre_of_room_and_at_most_two_of_size() -> None:
    found = described(np.eye(4), size=np.array([0.8, 3.0, np.inf]))
    assert found[1] == pytest.approx(math.tanh(8))
    assert found[25:28] == pytest.approx([0.8, 2.0, 2.0])


@pytest.mark.parametrize("axis", [0, 1])
def test_tilt_is_a_sine_against_what_the_face_withstands(axis: int) -> None:
    angles = [0.0, 0.0, 0.7]
    angles[axis] = 0.3
    pose = Pose.from_xyz_rpy((0.0, 0.0, 0.0), tuple(angles)).matrix
    sine = math.sin(0.3)
    found = described(pose)
    assert found[16:20] == pytest.approx(
        [math.tanh(4 * sine), math.tanh(40 * sine), 0.4, math.tanh(4 * (0.4 - sine))], abs=1e-6
    )


def test_a_body_on_another_face_is_not_tilted() -> None:
    """A quarter about x puts its y up; the face's own rotation does the same."""
    on_its_side = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.pi / 2, 0.0, 0.3)).matrix
    down = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.pi / 2, 0.0, 0.0)).matrix[:3, :3]
    assert described(on_its_side, down=down)[16] == pytest.approx(0.0, abs=1e-6)
    assert described(on_its_side)[16] == pytest.approx(math.tanh(4), abs=1e-6)


def test_sizes_and_which_way_is_up() -> None:
    pose = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.2, 0.0, 0.0)).matrix
    found = described(pose, hollow=True)
    assert found[20:23] == pytest.approx([8 * 0.1, 8 * 0.42, 8 * 0.12], abs=1e-6)
    assert found[24] == 1.0 and described(pose)[24] == 0.0
    assert found[28] == pytest.approx(math.cos(0.2), abs=1e-6)
    assert found[29:31] == pytest.approx([math.log(0.12), math.log(0.1)], abs=1e-6)


def test_only_what_is_below_the_plane_counts_as_sunken() -> None:
    assert described(np.eye(4))[23] == 0.0
    sunken = np.zeros((1, 31), np.float32)
    low = LOW - [0.0, 0.0, 0.022]
    describe_poses(
        np.eye(4)[None], low, HIGH, CENTRE, NEAREST, np.eye(3)[None], STEADY, SIZE, False, sunken
    )
    assert sunken[0, 23] == pytest.approx(math.tanh(20 * -0.02), abs=1e-6)


def missing(
    bounds: tuple[float, float, float, float], slack: float = 0.0, size: Array = SIZE
) -> float:
    found = np.zeros(1)
    constraint_violations(LOW, HIGH, CENTRE, NEAREST, size, bounds, slack, found)
    return float(found[0])


KEPT = (0.15, 0.21, 0.178, 0.07)
"""Room at the sides, of the centre of mass, below the ceiling, and to what is next."""


def test_what_all_demonstrations_keep_is_kept() -> None:
    assert missing(KEPT) == pytest.approx(0.0, abs=1e-12)
    assert missing(tuple(one - 0.01 for one in KEPT)) == 0.0


@pytest.mark.parametrize("which", range(4))
def test_what_is_missing_of_each_bound_adds_up(which: int) -> None:
    bounds = [one - 0.05 for one in KEPT]
    bounds[which] += 0.05 + 0.03
    assert missing(tuple(bounds)) == pytest.approx(0.03)
    assert missing(tuple(bounds), slack=0.01) == pytest.approx(0.02)
    assert missing(tuple(bounds), slack=0.04) == 0.0
    assert missing(tuple(one + 0.01 for one in KEPT)) == pytest.approx(0.04)


def test_above_an_open_region_there_is_a_metre() -> None:
    size = np.array([0.8, 0.6, np.inf])
    assert missing((-1.0, -1.0, 1.0, -1.0), size=size) == 0.0
    assert missing((-1.0, -1.0, 1.5, -1.0), size=size) == pytest.approx(0.5)
