"""Compiled arithmetic of measures: for a few candidates numpy's calls would cost more than the
numbers.

The signatures are spelled out, so that numba compiles at import and not within anyone's planning
time.
"""

from __future__ import annotations

import math

from tamp.system.compilation import njit

_ROWS, _COLUMN = "float64[:,::1]", "float64[::1]"


@njit(
    f"void(float64[:,:,::1], {_ROWS}, {_ROWS}, {_ROWS}, {_COLUMN}, float64[:,:,::1], "
    f"{_COLUMN}, {_COLUMN}, boolean, float32[:,::1])",
    cache=True,
)
def describe_poses(poses, low, high, centre, nearest, downs, steady, size, hollow, features):
    """Compute the features of `ranker.features` that are a pose's alone, into `features` (n, POSE).

    Args: T_region_body (n, 4, 4), the body's least and largest coordinates and its centre of mass
    (n, 3), the least separation (n,), the matrix that turns the face down (n, 3, 3) and the tilt
    that it withstands (n,), the region's size (3,) and whether it is hollow.
    """
    for n in range(len(poses)):
        x, y, z = poses[n, 2, 0], poses[n, 2, 1], poses[n, 2, 2]
        across = downs[n, 0, 0] * x + downs[n, 0, 1] * y + downs[n, 0, 2] * z
        along = downs[n, 1, 0] * x + downs[n, 1, 1] * y + downs[n, 1, 2] * z
        tilt = math.sqrt(across * across + along * along)
        side_x = size[0] / 2 - max(abs(low[n, 0]), abs(high[n, 0]))
        side_y = size[1] / 2 - max(abs(low[n, 1]), abs(high[n, 1]))
        balance_x, balance_y = size[0] / 2 - abs(centre[n, 0]), size[1] / 2 - abs(centre[n, 1])
        wide, deep, tall = high[n, 0] - low[n, 0], high[n, 1] - low[n, 1], high[n, 2] - low[n, 2]
        ceiling = min(size[2] - high[n, 2], 1.0)
        lengths = (
            low[n, 2], ceiling, high[n, 2], min(side_x, side_y), max(side_x, side_y),
            min(balance_x, balance_y), max(balance_x, balance_y), nearest[n],
        )  # fmt: skip
        row = features[n]
        for k in range(8):
            row[k], row[8 + k] = math.tanh(8 * lengths[k]), math.tanh(100 * lengths[k])
        row[16], row[17], row[18] = math.tanh(4 * tilt), math.tanh(40 * tilt), steady[n]
        row[19] = math.tanh(4 * (steady[n] - tilt))
        row[20], row[21], row[22] = 8 * min(wide, deep), 8 * max(wide, deep), 8 * tall
        row[23] = math.tanh(20 * min(low[n, 2], 0.0))
        row[24] = hollow
        for k in range(3):
            row[25 + k] = min(size[k], 2.0)
        row[28] = z
        row[29], row[30] = math.log(max(tall, 1e-3)), math.log(max(min(wide, deep), 1e-3))


@njit(
    f"void({_ROWS}, {_ROWS}, {_ROWS}, {_COLUMN}, {_COLUMN}, "
    f"UniTuple(float64, 4), float64, {_COLUMN})",
    cache=True,
)
def constraint_violations(low, high, centre, nearest, size, bounds, slack, missing):
    """Compute `RelationalCoordinates.constraint_violation` into `missing` (n,); bounds are those
    of sides, balance, ceiling and distance.
    """
    for n in range(len(missing)):
        sides, balance = math.inf, math.inf
        for k in range(2):
            sides = min(sides, size[k] / 2 - max(abs(low[n, k]), abs(high[n, k])))
            balance = min(balance, size[k] / 2 - abs(centre[n, k]))
        ceiling = min(size[2] - high[n, 2], 1.0)
        total = 0.0
        for value, bound in (
            (sides, bounds[0]),
            (balance, bounds[1]),
            (ceiling, bounds[2]),
            (nearest[n], bounds[3]),
        ):
            total += max(bound - value - slack, 0.0)
        missing[n] = total
