"""Numbers as URDF writes them: all digits, and the angles that make a rotation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.robot.urdf_words import roll_pitch_yaw, words


def rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """URDF's: about fixed x, then y, then z."""
    (a, b), (c, d), (e, f) = ((math.cos(v), math.sin(v)) for v in (roll, pitch, yaw))
    Rx = np.array([[1, 0, 0], [0, a, -b], [0, b, a]])
    Ry = np.array([[c, 0, d], [0, 1, 0], [-d, 0, c]])
    Rz = np.array([[e, -f, 0], [f, e, 0], [0, 0, 1]])
    return Rz @ Ry @ Rx


def test_no_digit_is_lost() -> None:
    values = [0.1, 1 / 3, -1e-17, 1e300, 2, np.float64(0.1) * 3]
    assert [float(word) for word in words(values).split()] == [float(value) for value in values]
    assert words((1, np.float32(0.5))) == "1.0 0.5"


def test_angles_of_random_rotations() -> None:
    for angles in np.random.default_rng(0).uniform(-1.5, 1.5, (200, 3)) * [2, 1, 2]:
        assert roll_pitch_yaw(rotation(*angles)) == pytest.approx(tuple(angles))


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2])
@pytest.mark.parametrize("roll", [0.0, 0.7, -2.0, math.pi])
@pytest.mark.parametrize("yaw", [0.0, 1.2, -3.0])
def test_upright_pitches_give_the_rotation_back(roll: float, pitch: float, yaw: float) -> None:
    """There roll and yaw are one angle: any that make the rotation will do."""
    R = rotation(roll, pitch, yaw)
    assert rotation(*roll_pitch_yaw(R)) == pytest.approx(R, abs=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_upright_pitch_with_zeros_as_a_file_has_them(side: float) -> None:
    a, b = math.cos(0.7), math.sin(0.7)
    R = np.array([[0.0, side * b, side * a], [0.0, a, -b], [-side, 0.0, 0.0]])
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert rotation(*roll_pitch_yaw(R)) == pytest.approx(R, abs=1e-9)
