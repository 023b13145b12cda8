"""Compiled features of a box, frames and quaternions against what they mean."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from grounding.paper.kernels import describe_boxes, move, normalize
from grounding.paper.rotations import rotations


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
