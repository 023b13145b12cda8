"""Compiled arithmetic of the paper's features: for one proposal numpy's calls would cost more than
the numbers.
"""

from __future__ import annotations

import math

from tamp.system.compilation import njit


@njit(cache=True)
def move(matrices, points, moved):
    """Transform points (n, 3) of frames posed by (n, 4, 4) to the outer frame, into `moved` (n, 3).
    One point serves all.
    """
    for n in range(len(matrices)):
        m, point = matrices[n], points[min(n, len(points) - 1)]
        for r in range(3):
            moved[n, r] = m[r, 0] * point[0] + m[r, 1] * point[1] + m[r, 2] * point[2] + m[r, 3]


@njit(cache=True)
def describe_boxes(centres, turns, rotations, corners, features):
    """Compute BB of `features.box_features` into `features` (n, 19); quaternions (n, 4) and the
    matrices (n, 3, 3) of them.
    """
    for n in range(len(centres)):
        for r in range(3):
            reach = 0.0
            for k in range(3):
                reach += abs(rotations[n, r, k]) * (corners[n, 1, k] - corners[n, 0, k]) / 2
            features[n, r] = centres[n, r]
            features[n, 3 + r] = centres[n, r] - reach
            features[n, 6 + r] = centres[n, r] + reach
            features[n, 13 + r] = corners[n, 0, r]
            features[n, 16 + r] = corners[n, 1, r]
        for k in range(4):
            features[n, 9 + k] = turns[n, k]


@njit(cache=True)
def normalize(turns, units):
    """Normalize quaternions into `units` (n, 4); no rotation for one that is zero."""
    for n in range(len(turns)):
        x, y, z, w = turns[n]
        norm = math.sqrt(x * x + y * y + z * z + w * w)
        for k in range(4):
            units[n, k] = turns[n, k] / norm if norm > 1e-8 else (1.0 if k == 3 else 0.0)
