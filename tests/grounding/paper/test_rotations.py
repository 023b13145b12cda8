"""Quaternions and matrices, there and back, against scipy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from grounding.paper.rotations import QUADRATIC, quaternions, rotations


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
