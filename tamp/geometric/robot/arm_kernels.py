"""Compiled kinematics of an arm of seven revolute joints about z: FK, the check of IK solutions,
path following.

The arm is given as `origins` (7, 4, 4), each joint's frame at 0 in the one before (the first in the
base), and `T_flange_tool` (4, 4). Metres and radians. Small on purpose: it is compiled once, when
it is imported first.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from tamp.system.compilation import njit

TWO_PI = 2.0 * np.pi

INNER = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""For functions that only compiled code calls; they are kept with the ones that call them."""

_ANGLES, _ROWS, _POSES = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]


@njit(**INNER)
def _product(A, B, C):
    """Write A @ B into C, all rigid and of shape (3, 4) or (4, 4)."""
    for r in range(3):
        for c in range(4):
            C[r, c] = A[r, 0] * B[0, c] + A[r, 1] * B[1, c] + A[r, 2] * B[2, c]
        C[r, 3] += A[r, 3]


@njit(**INNER)
def frames(origins, T_flange_tool, q, joints, tool):
    """Write the frames at q (7,): the joints' (7, 3, 4) and the tool's (3, 4), by FK."""
    for row in range(3):
        for column in range(4):
            joints[0, row, column] = origins[0, row, column]
    for i in range(7):
        if i > 0:
            _product(joints[i - 1], origins[i], joints[i])
        cos, sin = math.cos(q[i]), math.sin(q[i])
        for row in range(3):
            x, y = joints[i, row, 0], joints[i, row, 1]
            joints[i, row, 0] = x * cos + y * sin
            joints[i, row, 1] = y * cos - x * sin
    _product(joints[6], T_flange_tool, tool)


@njit(**INNER)
def _error(tool, target, error):
    """Write the twist from tool to target into error (6,), position above rotation, and return its
    largest entry.

    The rotation's part is half the sum of the axes' cross products: right to first order, and for
    less than a half turn zero only at the target.
    """
    for r in range(3):
        error[r] = target[r, 3] - tool[r, 3]
    sx = sy = sz = 0.0
    for c in range(3):
        ax, ay, az = tool[0, c], tool[1, c], tool[2, c]
        bx, by, bz = target[0, c], target[1, c], target[2, c]
        sx += ay * bz - az * by
        sy += az * bx - ax * bz
        sz += ax * by - ay * bx
    error[3], error[4], error[5] = sx / 2, sy / 2, sz / 2
    largest = 0.0
    for r in range(6):
        largest = max(largest, abs(error[r]))
    return largest


@njit(**INNER)
def _solve(A, b):
    """Overwrite b (6,) by the x of A x = b for a symmetric positive definite A (6, 6), overwritten
    as well.

    Written out because numba's linalg would import scipy.
    """
    for i in range(6):
        for j in range(i + 1):
            total = A[i, j]
            for k in range(j):
                total -= A[i, k] * A[j, k]
            A[i, j] = math.sqrt(max(total, 1e-12)) if i == j else total / A[j, j]
    for i in range(6):
        for k in range(i):
            b[i] -= A[i, k] * b[k]
        b[i] /= A[i, i]
    for i in range(5, -1, -1):
        for k in range(i + 1, 6):
            b[i] -= A[k, i] * b[k]
        b[i] /= A[i, i]


@njit(**INNER)
def _step(J, error, q, lower, upper, drift, step):
    """Write into step (7,) a damped least-squares step; joints that it would push out of their
    limits are frozen.
    """
    active, wish = np.empty(7), np.empty(7)
    for i in range(7):
        active[i] = 1.0
    A, b = np.empty((6, 6)), np.empty(6)

    for _ in range(7):
        for i in range(7):
            middle, half = (upper[i] + lower[i]) / 2, (upper[i] - lower[i]) / 2
            wish[i] = drift * active[i] * (middle - q[i]) / half

        for r in range(6):
            b[r] = error[r]
            for i in range(7):
                b[r] -= J[r, i] * wish[i]
            for c in range(6):
                A[r, c] = 1e-8 if r == c else 0.0
                for i in range(7):
                    A[r, c] += active[i] * J[r, i] * J[c, i]

        _solve(A, b)
        frozen = False
        for i in range(7):
            step[i] = wish[i]
            for r in range(6):
                step[i] += active[i] * J[r, i] * b[r]
            outward = (q[i] <= lower[i] and step[i] < 0) or (q[i] >= upper[i] and step[i] > 0)
            if active[i] > 0 and outward:
                active[i] = 0.0
                frozen = True
        if not frozen:
            break

    largest = 0.5
    for i in range(7):
        largest = max(largest, abs(step[i]))
    for i in range(7):
        step[i] *= 0.5 / largest


@njit(
    _ROWS(_POSES, _ROWS, _ANGLES, _ANGLES, _ROWS, _ROWS, types.float64),
    cache=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
)
def keep_valid(origins, T_flange_tool, lower, upper, target, candidates, tolerance):
    """Return the candidates (n, 7), turned by full turns into the limits, whose FK meets the target
    (4, 4). Shape (m, 7).

    The tolerance holds for the position's distance in metres and for the largest difference of a
    rotation's entries.
    """
    kept = np.empty((len(candidates), 7))
    joints, tool = np.empty((7, 3, 4)), np.empty((3, 4))
    count = 0
    for n in range(len(candidates)):
        inside = True
        for i in range(7):
            angle = candidates[n, i]
            angle -= TWO_PI * np.ceil((angle - upper[i]) / TWO_PI)
            inside = inside and angle >= lower[i]
            kept[count, i] = angle
        if inside:
            frames(origins, T_flange_tool, kept[count], joints, tool)
            worst = 0.0
            for r in range(3):
                for c in range(4):
                    worst = max(worst, abs(tool[r, c] - target[r, c]))
            if worst < tolerance:
                count += 1
    return kept[:count]


@njit(
    types.Tuple((_ROWS, types.int64))(
        _POSES, _ROWS, _ANGLES, _ANGLES, _POSES, _ANGLES, types.float64
    ),
    cache=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
)
def follow(origins, T_flange_tool, lower, upper, targets, start, jump):
    """Follow the targets (k, 4, 4) by joint angles (k, 7), each from the one before by damped
    Newton steps.

    Returns the path and the number of targets reached: k, or less where a target could not be met
    within the limits or without a joint moving more than `jump` from one to the next. The spare
    freedom drifts towards the middle of the joints' ranges (Liegeois 1977); a joint at its limit is
    frozen.
    """
    path = np.empty((len(targets), 7))
    joints, tool = np.empty((7, 3, 4)), np.empty((3, 4))
    J, error = np.empty((6, 7)), np.empty(6)
    q, step = start.copy(), np.empty(7)

    for k in range(len(targets)):
        miss = np.inf
        for iteration in range(25):
            frames(origins, T_flange_tool, q, joints, tool)
            miss = _error(tool, targets[k], error)
            if miss < 1e-9:
                break

            for i in range(7):
                ax, ay, az = joints[i, 0, 2], joints[i, 1, 2], joints[i, 2, 2]
                rx, ry, rz = (
                    tool[0, 3] - joints[i, 0, 3],
                    tool[1, 3] - joints[i, 1, 3],
                    tool[2, 3] - joints[i, 2, 3],
                )
                J[0, i], J[1, i], J[2, i] = ay * rz - az * ry, az * rx - ax * rz, ax * ry - ay * rx
                J[3, i], J[4, i], J[5, i] = ax, ay, az

            _step(J, error, q, lower, upper, 0.02 if iteration == 0 else 0.0, step)
            for i in range(7):
                q[i] = min(max(q[i] + step[i], lower[i]), upper[i])

        if miss > 1e-6:
            return path, k
        for i in range(7):
            previous = path[k - 1, i] if k > 0 else start[i]
            if abs(q[i] - previous) > jump:
                return path, k
            path[k, i] = q[i]

    return path, len(targets)
