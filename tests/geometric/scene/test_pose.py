"""Poses form a group, and every way to write a rotation means the same one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.geometric.scene.pose import Pose, quaternion_from_matrix

_LENGTH = st.floats(-10, 10)
_ANGLE = st.floats(-math.pi, math.pi)
_POSES = st.builds(
    lambda xyz, rpy: Pose.from_xyz_rpy(xyz, rpy),
    st.tuples(_LENGTH, _LENGTH, _LENGTH),
    st.tuples(_ANGLE, _ANGLE, _ANGLE),
)


def _close(a: Pose, b: Pose) -> bool:
    return np.allclose(a.matrix, b.matrix, atol=1e-9)


@given(_POSES, _POSES, _POSES)
@settings(max_examples=60, deadline=None)
def test_group_laws(a: Pose, b: Pose, c: Pose) -> None:
    assert _close((a @ b) @ c, a @ (b @ c))
    assert _close(a @ a.inverse(), Pose()) and _close(a.inverse() @ a, Pose())
    assert _close(a @ Pose(), a) and _close(Pose() @ a, a)
    assert _close((a @ b).inverse(), b.inverse() @ a.inverse())


@given(_POSES)
@settings(max_examples=60, deadline=None)
def test_matrix_is_rigid_and_quaternion_comes_back(pose: Pose) -> None:
    rotation = pose.rotation
    assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    again = np.array(quaternion_from_matrix(rotation))
    assert np.linalg.norm(again) == pytest.approx(1.0)
    assert abs(again @ np.array(pose.quaternion)) == pytest.approx(1.0)
    assert _close(Pose.from_matrix(pose.matrix), pose)


@given(_POSES, _POSES)
@settings(max_examples=30, deadline=None)
def test_apply_composes(a: Pose, b: Pose) -> None:
    points = np.arange(12.0).reshape(4, 3)
    assert np.allclose((a @ b).apply(points), a.apply(b.apply(points)), atol=1e-8)


@pytest.mark.parametrize("half_turn", [(math.pi, 0, 0), (0, math.pi, 0), (0, 0, math.pi)])
def test_half_turns_keep_a_unit_quaternion(half_turn: tuple[float, float, float]) -> None:
    pose = Pose.from_matrix(Pose.from_xyz_rpy((1, 2, 3), half_turn).matrix)
    assert np.linalg.norm(pose.quaternion) == pytest.approx(1.0)
    assert _close(pose, Pose.from_xyz_rpy((1, 2, 3), half_turn))


def test_rpy_is_urdfs() -> None:
    """Fixed axes: roll about x first, then pitch about y, then yaw about z."""
    roll, pitch, yaw = 0.3, -0.7, 2.0
    x = Pose.from_xyz_rpy((0, 0, 0), (roll, 0, 0))
    y = Pose.from_xyz_rpy((0, 0, 0), (0, pitch, 0))
    z = Pose.from_xyz_yaw(0, 0, 0, yaw)
    assert _close(z @ y @ x, Pose.from_xyz_rpy((0, 0, 0), (roll, pitch, yaw)))
    assert z.yaw == pytest.approx(yaw)


def test_matrix_cannot_be_written() -> None:
    with pytest.raises(ValueError, match="read-only"):
        Pose().matrix[0, 0] = 2.0
