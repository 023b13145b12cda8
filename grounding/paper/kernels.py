"""Compiled arithmetic of the paper's features: for one proposal numpy's calls would cost more than the numbers."""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True)
def centre_boxes(matrices, corners, centres):
    """The middles of boxes with low and high corners (n, 2, 3), posed by (n, 4, 4), into `centres` (n, 3)."""
    for n in range(len(matrices)):
        m, c = matrices[n], corners[n]
        for r in range(3):
            value = m[r, 3]
            for k in range(3):
                value += m[r, k] * (c[0, k] + c[1, k]) / 2
            centres[n, r] = value


@njit(cache=True)
def describe_boxes(centres, turns, corners, features):
    """BB of `features.box_features` into `features` (n, 19)."""
    for n in range(len(centres)):
        x, y, z, w = turns[n]
        rows = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
        for r in range(3):
            reach = 0.0
            for k in range(3):
                reach += abs(rows[r][k]) * (corners[n, 1, k] - corners[n, 0, k]) / 2
            features[n, r] = centres[n, r]
            features[n, 3 + r] = centres[n, r] - reach
            features[n, 6 + r] = centres[n, r] + reach
            features[n, 13 + r] = corners[n, 0, r]
            features[n, 16 + r] = corners[n, 1, r]
        for k in range(4):
            features[n, 9 + k] = turns[n, k]


@njit(cache=True)
def normalize(turns, units):
    """Quaternions of norm 1 into `units` (n, 4); no rotation for one that is zero."""
    for n in range(len(turns)):
        x, y, z, w = turns[n]
        norm = math.sqrt(x * x + y * y + z * z + w * w)
        for k in range(4):
            units[n, k] = turns[n, k] / norm if norm > 1e-8 else (1.0 if k == 3 else 0.0)
