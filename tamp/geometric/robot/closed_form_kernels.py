"""Compiled check of closed-form solutions; compiled for those arms alone that have them."""

from __future__ import annotations

import numpy as np
from numba import types

from tamp.geometric.robot.arm_kernels import ANGLES, POSES, ROWS, TWO_PI, frames
from tamp.system.compilation import njit


@njit(
    ROWS(POSES, ANGLES, ROWS, ANGLES, ANGLES, ROWS, ROWS, types.float64),
    cache=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
)
def keep_valid(origins, slides, T_flange_tool, lower, upper, target, candidates, tolerance):
    """Return the candidates (k, n), turned by full turns into the limits, whose FK meets the target
    (4, 4). Shape (m, n).

    The tolerance holds for each entry of the position, metres, and of the rotation.
    """
    n = len(origins)
    kept = np.empty((len(candidates), n))
    joints, tool = np.empty((n, 3, 4)), np.empty((3, 4))
    count = 0
    for k in range(len(candidates)):
        inside = True
        for i in range(n):
            angle = candidates[k, i]
            if slides[i] > 0.0:
                inside = inside and angle <= upper[i]
            else:
                angle -= TWO_PI * np.ceil((angle - upper[i]) / TWO_PI)
            inside = inside and angle >= lower[i]
            kept[count, i] = angle

        if inside:
            frames(origins, slides, T_flange_tool, kept[count], joints, tool)
            worst = 0.0
            for r in range(3):
                for c in range(4):
                    worst = max(worst, abs(tool[r, c] - target[r, c]))
            if worst < tolerance:
                count += 1
    return kept[:count]
