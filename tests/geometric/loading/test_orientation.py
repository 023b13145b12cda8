"""Three ways to write how a body is turned mean rotations that are known, and two at once are refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.orientation import read_orientation, read_pose
from tamp.geometric.scene.pose import Pose
from tests.geometric.making import yaml

HALF = math.sqrt(0.5)


@pytest.mark.parametrize(
    ("text", "quaternion"),
    [
        ("size: 1", (0.0, 0.0, 0.0, 1.0)),
        ("yaw: 90 deg", (0.0, 0.0, HALF, HALF)),
        ("yaw: 3.141592653589793", (0.0, 0.0, 1.0, 0.0)),
        ("rpy: [90 deg, 0, 0]", (HALF, 0.0, 0.0, HALF)),
        ("rpy: [0, 90 deg, 0]", (0.0, HALF, 0.0, HALF)),
        ("quaternion: [0, 0, 0.7071, 0.7071]", (0.0, 0.0, HALF, HALF)),
        (
            "quaternion: [0, 0, 0, 1.009]",
            (0.0, 0.0, 0.0, 1.0),
        ),  # rounded by hand: made a unit again
    ],
)
def test_each_way_gives_the_rotation(
    tmp_path: Path, text: str, quaternion: tuple[float, ...]
) -> None:
    found = read_orientation(yaml(tmp_path, text).mapping())
    assert np.linalg.norm(found) == pytest.approx(1.0, abs=1e-12)
    assert abs(np.dot(found, quaternion)) == pytest.approx(1.0)  # q and -q are one rotation


def test_roll_is_applied_first_and_yaw_last(tmp_path: Path) -> None:
    pose = read_pose(yaml(tmp_path, "position: [0, 0, 0]\nrpy: [90 deg, 0, 90 deg]"))
    # Roll brings y to z and z to -y; yaw then brings -y to x.
    assert pose.apply(np.array([[0.0, 0.0, 1.0]]))[0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)
    assert pose.apply(np.array([[0.0, 1.0, 0.0]]))[0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("yaw: 1\nrpy: [0, 0, 1]", "yaw: 'rpy' and 'yaw' both say how it is turned: keep one"),
        ("quaternion: [0, 0, 0, 1]\nyaw: 0", "'quaternion' and 'yaw' both say"),
        ("quaternion: [0, 0, 0, 0]", "a quaternion of norm 0 is no rotation. No rotation is"),
        (
            "quaternion: [1, 0, 0, 1]",
            "the quaternion's norm is 1.41, not 1. Is its order x, y, z, w?",
        ),
        ("quaternion: [0, 0, 1]", "quaternion: expected 4 numbers, found 3"),
        ("rpy: [0, 1]", "rpy: expected 3 numbers, found 2"),
        ("rpy: [0, 0, 45]", r"rpy\[2\]: 45 radians are more than a full turn"),
    ],
)
def test_what_is_no_rotation_is_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_orientation(yaml(tmp_path, text).mapping())


def test_a_pose_is_upright_at_its_position_by_default(tmp_path: Path) -> None:
    assert read_pose(yaml(tmp_path, "position: [1, -2, 0.5]")) == Pose((1.0, -2.0, 0.5))
    with pytest.raises(InputError, match="'position' is missing"):
        read_pose(yaml(tmp_path, "yaw: 1"))
