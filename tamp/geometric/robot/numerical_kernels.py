"""Compiled numerical inverse kinematics: damped least squares from many starts.

The arm is given as in `arm_kernels`. Compiled when it is imported, by those arms alone that have no
closed form.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from tamp.geometric.robot.arm_kernels import (
    ANGLES,
    POSES,
    ROWS,
    TWO_PI,
    frames,
    jacobian,
    solve,
)
from tamp.system.compilation import INNER_KERNEL, njit

MAX_STEPS = 40
"""Steps from one start, at most."""

MAX_SLOW_STEPS = 6
"""Steps in a row that do not halve the error after which a start is given up."""

ROTATION_WEIGHT_M2 = 0.1
"""Square metres that a squared radian weighs."""

CONVERGED_ERROR = 1e-14
"""Squared error, of the position in metres and of the rotation in radians, that counts as met."""

LEAST_DIFFERENCE = 0.05
"""Radians or metres in some joint by which two solutions differ that count as two."""


@njit(**INNER_KERNEL)
def _rotation_vector(tool, target, error):
    """Write the rotation vector from tool to target into error[3:6], in the base's axes."""
    sx = sy = sz = 0.0
    trace = 0.0
    for c in range(3):
        ax, ay, az = tool[0, c], tool[1, c], tool[2, c]
        bx, by, bz = target[0, c], target[1, c], target[2, c]
        sx += ay * bz - az * by
        sy += az * bx - ax * bz
        sz += ax * by - ay * bx
        trace += ax * bx + ay * by + az * bz
    sine, cosine = 0.5 * math.sqrt(sx * sx + sy * sy + sz * sz), 0.5 * (trace - 1.0)
    if sine < 1e-9 and cosine < 0.0:  # a half turn: any axis will do, the next step knows better
        error[3], error[4], error[5] = math.pi, 0.0, 0.0
        return
    factor = 0.5 if sine < 1e-9 else 0.5 * math.atan2(sine, cosine) / sine
    error[3], error[4], error[5] = factor * sx, factor * sy, factor * sz


@njit(**INNER_KERNEL)
def _descend(
    origins, slides, T_flange_tool, lower, upper, target, free, q, joints, tool, J, error, A, g
):
    """Move q (n,) towards the target until it is met (True) or given up; within the limits unless
    `free`.
    """
    n, best, slow = len(origins), 1e30, 0
    for _ in range(MAX_STEPS):
        frames(origins, slides, T_flange_tool, q, joints, tool)
        away = turned = 0.0
        _rotation_vector(tool, target, error)
        for r in range(3):
            error[r] = target[r, 3] - tool[r, 3]
            away += error[r] * error[r]
            turned += error[3 + r] * error[3 + r]
        if away < CONVERGED_ERROR and turned < CONVERGED_ERROR:
            return True

        total = away + ROTATION_WEIGHT_M2 * turned
        if total > 0.5 * best:
            slow += 1
            if slow > MAX_SLOW_STEPS:
                return False
        best = min(best, total)

        jacobian(slides, joints, tool, J)
        for i in range(n):
            g[i] = 0.0
            for r in range(6):
                g[i] += (1.0 if r < 3 else ROTATION_WEIGHT_M2) * J[r, i] * error[r]
            for j in range(i + 1):
                A[i, j] = 1e-11 + 0.05 * total if i == j else 0.0
                for r in range(6):
                    A[i, j] += (1.0 if r < 3 else ROTATION_WEIGHT_M2) * J[r, i] * J[r, j]

        for i in range(n):  # a joint at a limit that would be pushed out of it is frozen
            if not free and (
                (q[i] <= lower[i] and g[i] < 0.0) or (q[i] >= upper[i] and g[i] > 0.0)
            ):
                for j in range(n):
                    A[max(i, j), min(i, j)] = 0.0
                A[i, i], g[i] = 1.0, 0.0

        solve(A, g, 1e-300)
        largest = 1.0
        for i in range(n):
            largest = max(largest, abs(g[i]))
        for i in range(n):
            q[i] += g[i] / largest
            if not free or slides[i] > 0.0:
                q[i] = min(max(q[i], lower[i]), upper[i])
    return False


@njit(
    types.Tuple((ROWS, types.int64))(
        POSES, ANGLES, ROWS, ANGLES, ANGLES, ANGLES, ROWS, ROWS, types.int64, types.int64
    ),
    cache=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
)
def damped_least_squares(
    origins, slides, T_flange_tool, lower, upper, home, target, seeds, looked, most
):
    """Return solutions (most, n) of which the first `count` are filled in, and that count.

    Each third start goes without limits; what it finds is turned by whole turns towards home, as
    every solution is whose joint may turn more than once. Ends with `most` solutions, after
    `looked` starts with any, or when the seeds (k, n) are used up.
    """
    n, count = len(origins), 0
    found = np.empty((most, n))
    joints, tool = np.empty((n, 3, 4)), np.empty((3, 4))
    J, error, A, g, q = np.empty((6, n)), np.empty(6), np.empty((n, n)), np.empty(n), np.empty(n)

    for start in range(len(seeds)):
        if count == most or (count > 0 and start >= looked):
            break
        for i in range(n):
            q[i] = seeds[start, i]
        if not _descend(
            origins, slides, T_flange_tool, lower, upper, target, start % 3 == 2, q, joints, tool,
            J, error, A, g,
        ):  # fmt: skip
            continue

        inside = True
        for i in range(n):
            if slides[i] == 0.0:
                q[i] -= TWO_PI * math.floor((q[i] - home[i]) / TWO_PI + 0.5)
                if q[i] > upper[i]:
                    q[i] -= TWO_PI
                if q[i] < lower[i]:
                    q[i] += TWO_PI
            inside = inside and lower[i] <= q[i] <= upper[i]

        for k in range(count):
            largest = 0.0
            for i in range(n):
                largest = max(largest, abs(q[i] - found[k, i]))
            inside = inside and largest > LEAST_DIFFERENCE
        if inside:
            for i in range(n):
                found[count, i] = q[i]
            count += 1
    return found, count
