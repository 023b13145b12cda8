"""Quaternions and matrices, there and back, against scipy; clouds and kernels of the features."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from grounding.paper.clouds import POINTS, cloud
from grounding.paper.kernels import describe_boxes, move, normalize
from grounding.paper.rotations import QUADRATIC, quaternions, rotations
from tests.grounding.forms import box, can


@given(st.integers(0, 10_000))
@settings(max_examples=30)
def test_matrices_are_those_of_scipy_and_lead_back(seed: int) -> None:
    given_ = Rotation.random(20, rng=np.random.default_rng(seed))
    matrices = rotations(given_.as_quat())
    assert matrices == pytest.approx(given_.as_matrix(), abs=1e-12)
    back = quaternions(matrices)
    assert (back[:, 3] >= 0.0).all()
    assert np.abs(np.einsum("ij,ij->i", back, given_.as_quat())) == pytest.approx(np.ones(20))


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("angle", [0.0, math.pi / 2, math.pi - 1e-9, math.pi])
def test_half_turns_are_no_exception(axis: int, angle: float) -> None:
    turn = np.zeros((1, 4))
    turn[0, axis], turn[0, 3] = math.sin(angle / 2), math.cos(angle / 2)
    found = quaternions(rotations(turn))
    assert np.linalg.norm(found) == pytest.approx(1.0)
    assert abs(float(found[0] @ turn[0])) == pytest.approx(1.0)


def test_the_quadratic_form_is_the_rotation() -> None:
    for turn in Rotation.random(10, rng=np.random.default_rng(0)).as_quat():
        matrix = np.eye(3).ravel() + np.outer(turn, turn).ravel() @ QUADRATIC
        assert matrix.reshape(3, 3) == pytest.approx(
            Rotation.from_quat(turn).as_matrix(), abs=1e-12
        )


def test_points_are_moved_one_each_or_one_for_all(rng: np.random.Generator) -> None:
    matrices = np.tile(np.eye(4), (3, 1, 1))
    matrices[:, :3, :3] = Rotation.random(3, rng=rng).as_matrix()
    matrices[:, :3, 3] = rng.normal(size=(3, 3))
    for points in (rng.normal(size=(3, 3)), rng.normal(size=(1, 3))):
        moved = np.empty((3, 3))
        move(matrices, points, moved)
        expected = (
            np.einsum("nij,nj->ni", matrices[:, :3, :3], np.broadcast_to(points, (3, 3)))
            + matrices[:, :3, 3]
        )
        assert moved == pytest.approx(expected)


def test_zero_is_no_rotation() -> None:
    units = np.empty((2, 4))
    normalize(np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 3.0, 0.0, 4.0]]), units)
    assert units == pytest.approx(np.array([[0.0, 0.0, 0.0, 1.0], [0.0, 0.6, 0.0, 0.8]]))


def test_a_turned_boxs_bounds_are_those_of_its_corners(rng: np.random.Generator) -> None:
    turns = Rotation.random(1, rng=rng).as_quat()
    corners = np.array([[[-0.1, -0.2, -0.3], [0.1, 0.2, 0.3]]])
    features = np.zeros((1, 19))
    describe_boxes(np.array([[1.0, 2.0, 3.0]]), turns, rotations(turns), corners, features)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * corners[0, 1]
    points = signs @ rotations(turns)[0].T + [1.0, 2.0, 3.0]
    assert features[0, :3].tolist() == [1.0, 2.0, 3.0]
    assert features[0, 3:9] == pytest.approx(
        np.concatenate([points.min(axis=0), points.max(axis=0)])
    )
    assert features[0, 9:13] == pytest.approx(turns[0]) and features[0, 13:] == pytest.approx(
        corners.ravel()
    )


def test_a_cloud_lies_on_the_surface_evenly_by_area() -> None:
    points = cloud(box(0.1, 0.2, 0.4))
    assert points.shape == (POINTS, 3)
    share = np.abs(points) / [0.05, 0.1, 0.2]
    assert share.max(axis=1) == pytest.approx(np.ones(POINTS))  # each on a side
    counts = np.bincount(share.argmax(axis=1), minlength=3) / POINTS
    assert counts == pytest.approx(np.array([0.08, 0.04, 0.02]) / 0.14, abs=0.03)
    top = points[points[:, 2] > 0.2 - 1e-9]
    assert top[:, :2].mean(axis=0) == pytest.approx([0.0, 0.0], abs=0.02)


def test_a_form_has_one_cloud_and_a_scaled_one_has_it_scaled() -> None:
    form = can(0.05, 0.1)
    assert (cloud(form) == cloud(form)).all()
    assert cloud(form.scaled(2.0)) == pytest.approx(2.0 * cloud(form))
