"""Unit quaternions xyzw and rotation matrices, many at a time and at once."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array
from tamp.system.compilation import njit

QUADRATIC: NDArray[np.float64] = np.zeros((16, 9))
"""R = 1 + (q q^T) QUADRATIC for a unit quaternion xyzw: entries of q q^T row by row to entries of R
row by row.
"""
for _row, _column, _first, _second, _factor in (
    (0, 0, 1, 1, -2), (0, 0, 2, 2, -2), (1, 1, 0, 0, -2), (1, 1, 2, 2, -2),
    (2, 2, 0, 0, -2), (2, 2, 1, 1, -2),
    (0, 1, 0, 1, 2), (0, 1, 2, 3, -2), (0, 2, 0, 2, 2), (0, 2, 1, 3, 2),
    (1, 0, 0, 1, 2), (1, 0, 2, 3, 2),
    (1, 2, 1, 2, 2), (1, 2, 0, 3, -2), (2, 0, 0, 2, 2), (2, 0, 1, 3, -2),
    (2, 1, 1, 2, 2), (2, 1, 0, 3, 2),
):  # fmt: skip
    QUADRATIC[4 * _first + _second, 3 * _row + _column] = _factor


def rotations(turns: Array) -> Array:
    """Convert unit quaternions xyzw, shape (n, 4), to rotation matrices, shape (n, 3, 3)."""
    matrices = np.empty((len(turns), 3, 3), turns.dtype)
    _rotate(turns, matrices)
    return matrices


def quaternions(matrices: Array) -> Array:
    """Convert rotation matrices, shape (n, 3, 3), to unit quaternions xyzw with w >= 0, shape (n,
    4) (Shepperd's method).
    """
    turns = np.empty((len(matrices), 4))
    _turn(np.asarray(matrices, dtype=float), turns)
    return turns


@njit(cache=True)
def _rotate(turns, matrices):
    for n in range(len(turns)):
        x, y, z, w = turns[n]
        matrices[n, 0, 0] = 1 - 2 * (y * y + z * z)
        matrices[n, 1, 1] = 1 - 2 * (x * x + z * z)
        matrices[n, 2, 2] = 1 - 2 * (x * x + y * y)
        matrices[n, 0, 1], matrices[n, 1, 0] = 2 * (x * y - z * w), 2 * (x * y + z * w)
        matrices[n, 0, 2], matrices[n, 2, 0] = 2 * (x * z + y * w), 2 * (x * z - y * w)
        matrices[n, 1, 2], matrices[n, 2, 1] = 2 * (y * z - x * w), 2 * (y * z + x * w)


@njit(cache=True)
def _turn(matrices, turns):
    for n in range(len(matrices)):
        r, q = matrices[n], turns[n]
        trace = r[0, 0] + r[1, 1] + r[2, 2]
        most, i = trace, 3
        for k in range(2, -1, -1):  # of equal ones the first
            if r[k, k] >= most:
                most, i = r[k, k], k

        if i == 3:
            q[0], q[1], q[2], q[3] = (
                r[2, 1] - r[1, 2],
                r[0, 2] - r[2, 0],
                r[1, 0] - r[0, 1],
                1 + trace,
            )
        else:
            j, k = (i + 1) % 3, (i + 2) % 3
            q[i], q[3] = 1 - trace + 2 * r[i, i], r[k, j] - r[j, k]
            q[j], q[k] = r[j, i] + r[i, j], r[k, i] + r[i, k]

        length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        if q[3] < 0:
            length = -length
        for k in range(4):
            q[k] /= length
