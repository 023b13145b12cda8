"""Compiled kinematics of an arm of any number of joints: FK, the Jacobian, path following.

The arm is given as `origins` (n, 4, 4), each joint's frame at 0 in the one before (the first in the
base), `slides` (n,), 1 for a joint that slides along its z and 0 for one that turns about it, and
`T_flange_tool` (4, 4). Metres and radians. Small on purpose: it is compiled once, when it is
imported first.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from tamp.system.compilation import INNER_KERNEL, njit

TWO_PI = 2.0 * np.pi

ANGLES, ROWS, POSES = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]


@njit(**INNER_KERNEL)
def _product(A, B, C):
    """Write A @ B into C, all rigid and of shape (3, 4) or (4, 4)."""
    for r in range(3):
        for c in range(4):
            C[r, c] = A[r, 0] * B[0, c] + A[r, 1] * B[1, c] + A[r, 2] * B[2, c]
        C[r, 3] += A[r, 3]


@njit(**INNER_KERNEL)
def frames(origins, slides, T_flange_tool, q, joints, tool):
    """Write the frames at q (n,): the joints' (n, 3, 4) and the tool's (3, 4), by FK."""
    n = len(origins)
    for row in range(3):
        for column in range(4):
            joints[0, row, column] = origins[0, row, column]
    for i in range(n):
        if i > 0:
            _product(joints[i - 1], origins[i], joints[i])
        if slides[i] > 0.0:
            for row in range(3):
                joints[i, row, 3] += joints[i, row, 2] * q[i]
            continue
        cos, sin = math.cos(q[i]), math.sin(q[i])
        for row in range(3):
            x, y = joints[i, row, 0], joints[i, row, 1]
            joints[i, row, 0] = x * cos + y * sin
            joints[i, row, 1] = y * cos - x * sin
    _product(joints[n - 1], T_flange_tool, tool)


@njit(**INNER_KERNEL)
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


@njit(**INNER_KERNEL)
def jacobian(slides, joints, tool, J):
    """Write the Jacobian (6, n) of the tool: its origin's velocity above the angular one."""
    for i in range(len(slides)):
        ax, ay, az = joints[i, 0, 2], joints[i, 1, 2], joints[i, 2, 2]
        if slides[i] > 0.0:
            J[0, i], J[1, i], J[2, i] = ax, ay, az
            J[3, i], J[4, i], J[5, i] = 0.0, 0.0, 0.0
            continue
        rx, ry, rz = (
            tool[0, 3] - joints[i, 0, 3],
            tool[1, 3] - joints[i, 1, 3],
            tool[2, 3] - joints[i, 2, 3],
        )
        J[0, i], J[1, i], J[2, i] = ay * rz - az * ry, az * rx - ax * rz, ax * ry - ay * rx
        J[3, i], J[4, i], J[5, i] = ax, ay, az


@njit(**INNER_KERNEL)
def solve(A, b, floor):
    """Overwrite b (n,) by the x of A x = b for a symmetric positive definite A (n, n), of which the
    lower half is read, and overwritten as well; no pivot is below `floor`.

    Written out because numba's linalg would import scipy.
    """
    n = len(b)
    for i in range(n):
        for j in range(i + 1):
            total = A[i, j]
            for k in range(j):
                total -= A[i, k] * A[j, k]
            A[i, j] = math.sqrt(max(total, floor)) if i == j else total / A[j, j]
    for i in range(n):
        for k in range(i):
            b[i] -= A[i, k] * b[k]
        b[i] /= A[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[i] -= A[k, i] * b[k]
        b[i] /= A[i, i]


@njit(**INNER_KERNEL)
def _step(J, error, q, lower, upper, drift, step):
    """Write into step (n,) a damped least-squares step; joints that it would push out of their
    limits are frozen.
    """
    n = len(q)
    active, wish = np.empty(n), np.empty(n)
    for i in range(n):
        active[i] = 1.0
    A, b = np.empty((6, 6)), np.empty(6)

    for _ in range(n):
        for i in range(n):
            middle, half = (upper[i] + lower[i]) / 2, (upper[i] - lower[i]) / 2
            wish[i] = drift * active[i] * (middle - q[i]) / half

        for r in range(6):
            b[r] = error[r]
            for i in range(n):
                b[r] -= J[r, i] * wish[i]
            for c in range(6):
                A[r, c] = 1e-8 if r == c else 0.0
                for i in range(n):
                    A[r, c] += active[i] * J[r, i] * J[c, i]

        solve(A, b, 1e-12)
        frozen = False
        for i in range(n):
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
    for i in range(n):
        largest = max(largest, abs(step[i]))
    for i in range(n):
        step[i] *= 0.5 / largest


@njit(
    types.Tuple((ROWS, types.int64))(
        POSES, ANGLES, ROWS, ANGLES, ANGLES, POSES, ANGLES, types.float64
    ),
    cache=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
)
def follow(origins, slides, T_flange_tool, lower, upper, targets, start, jump):
    """Follow the targets (k, 4, 4) by joint angles (k, n), each from the one before by damped
    Newton steps.

    Returns the path and the number of targets reached: k, or less where a target could not be met
    within the limits or without a joint moving more than `jump` from one to the next. The spare
    freedom drifts towards the middle of the joints' ranges (Liegeois 1977); a joint at its limit is
    frozen.
    """
    n = len(origins)
    path = np.empty((len(targets), n))
    joints, tool = np.empty((n, 3, 4)), np.empty((3, 4))
    J, error = np.empty((6, n)), np.empty(6)
    q, step = start.copy(), np.empty(n)

    for k in range(len(targets)):
        miss = np.inf
        for iteration in range(25):
            frames(origins, slides, T_flange_tool, q, joints, tool)
            miss = _error(tool, targets[k], error)
            if miss < 1e-9:
                break

            jacobian(slides, joints, tool, J)
            _step(J, error, q, lower, upper, 0.02 if iteration == 0 else 0.0, step)
            for i in range(n):
                q[i] = min(max(q[i] + step[i], lower[i]), upper[i])

        if miss > 1e-6:
            return path, k
        for i in range(n):
            previous = path[k - 1, i] if k > 0 else start[i]
            if abs(q[i] - previous) > jump:
                return path, k
            path[k, i] = q[i]

    return path, len(targets)
