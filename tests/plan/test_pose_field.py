"""A pose in a plan file: whatever is none is refused with its place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.plan.pose_field import read_pose
from tamp.system.json_fields import Field

HALF = math.sqrt(0.5)


def read(**entries: Any) -> np.ndarray:
    given = {"position": [1.0, -2.0, 3], "quaternion": [0.0, 0.0, HALF, HALF], **entries}
    return read_pose(Field(given, "values.p1", None))


def test_position_and_quaternion_make_the_matrix() -> None:
    """A quarter about z, its scalar last."""
    expected = [[0, -1, 0, 1], [1, 0, 0, -2], [0, 0, 1, 3], [0, 0, 0, 1]]
    assert np.allclose(read(), expected, atol=1e-12)
    assert np.allclose(read(quaternion=[1, 0, 0, 0])[:3, :3], np.diag([1, -1, -1]))


@pytest.mark.parametrize("scale", [0.9991, 1.0009, -1.0])
def test_a_quaternion_that_is_nearly_of_length_one_makes_an_exact_rotation(scale: float) -> None:
    turned = read(quaternion=[0.0, 0.0, scale * HALF, scale * HALF])[:3, :3]
    assert np.allclose(turned @ turned.T, np.eye(3), atol=1e-12)
    assert np.allclose(turned, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"quaternion": [0.0, 0.0, 0.0, 1.002]}, "values.p1.quaternion: its norm is 1.002, not 1"),
        ({"quaternion": [0.0, 0.0, 0.0, 0.998]}, "values.p1.quaternion: its norm is 0.998, not 1"),
        ({"quaternion": [0, 0, 0, 0]}, "values.p1.quaternion: its norm is 0, not 1"),
        ({"quaternion": [0, 0, 1]}, "values.p1.quaternion: 4 numbers are expected, not 3"),
        ({"position": [0, 0]}, "values.p1.position: 3 numbers are expected, not 2"),
        ({"position": None}, "values.p1: 'position' is null"),
    ],
)
def test_what_is_no_pose(entries: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        read(**entries)
    assert caught.value.message == message
