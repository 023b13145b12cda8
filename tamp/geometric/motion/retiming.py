"""Time-optimal path parametrization (TOPP) of a blended path in compiled code: a backward pass, a
forward pass.

The reachability analysis of Pham and Pham, "A new approach to time-optimal path parameterization
based on reachability analysis", T-RO 2018. Its linear programs have two variables, the squared rate
x of the station and its acceleration u; each is solved exactly, by Newton's method on a concave
function of x with straight pieces.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numba import types

from tamp.geometric.motion.corner_blending import BlendedPath
from tamp.geometric.scene.pose import Array
from tamp.system.compilation import INNER_KERNEL, njit

if TYPE_CHECKING:
    from jaxtyping import Float

ZERO_COEFFICIENT = 1e-12
"""A coefficient of u smaller than this bounds x alone."""


@njit(**INNER_KERNEL)
def _range_of(x, slopes, bends, limits, gap, most):
    """Compute the least and the largest u at x, and the slopes by x of the bounds that hold there.

    The bounds are |slope u + bend x| <= limit, row by row, and 0 <= x + 2 gap u <= most.
    """
    low, low_slope = -x / (2.0 * gap), -1.0 / (2.0 * gap)
    high, high_slope = (most - x) / (2.0 * gap), -1.0 / (2.0 * gap)
    for k in range(len(limits)):
        a, b = slopes[k], bends[k]
        if abs(a) < ZERO_COEFFICIENT:
            continue
        if a < 0.0:
            a, b = -a, -b
        up, down = (limits[k] - b * x) / a, (-limits[k] - b * x) / a
        if up < high:
            high, high_slope = up, -b / a
        if down > low:
            low, low_slope = down, -b / a
    return low, low_slope, high, high_slope


@njit(**INNER_KERNEL)
def _largest(slopes, bends, limits, gap, most, x):
    """Find the largest squared rate, at most x, from which one up to `most` is reached."""
    for k in range(len(limits)):
        if abs(slopes[k]) < ZERO_COEFFICIENT and abs(bends[k]) * x > limits[k]:
            x = limits[k] / abs(bends[k])
    for _ in range(100):
        low, low_slope, high, high_slope = _range_of(x, slopes, bends, limits, gap, most)
        slope = high_slope - low_slope
        if high >= low or slope >= 0.0:
            return x
        x = max(0.0, x - (high - low) / slope)
    return x


@njit(**INNER_KERNEL)
def _rows(i, tangents, before, after, gap, acceleration, slopes, bends, limits):
    """Write the constraints of interval i, at both of its ends; at its end x is x + 2 gap u."""
    d = len(acceleration)
    for k in range(d):
        slopes[k], bends[k] = tangents[i, k], after[i, k]
        slopes[d + k] = tangents[i + 1, k] + 2.0 * gap * before[i + 1, k]
        bends[d + k] = before[i + 1, k]
        limits[k] = limits[d + k] = acceleration[k]


def _compiled(sources: int) -> Callable[..., Array]:
    """Compile the passes, or load them. `sources` makes them stale when the file has changed."""
    vector, matrix = (types.Array(types.float64, n, "C") for n in (1, 2))

    @njit(
        vector(vector, matrix, matrix, matrix, matrix, vector, vector), cache=True,
        error_model="numpy", no_cfunc_wrapper=True,
    )  # fmt: skip
    def passes(stations, tangents, steepest, before, after, velocity, acceleration):
        n, d = tangents.shape
        slopes, bends, limits = np.empty(2 * d), np.empty(2 * d), np.empty(2 * d)
        reachable, rates = np.empty(n), np.empty(n)
        for i in range(n):
            reachable[i] = rates[i] = 0.0
        if sources < 0:  # never: so that the number is a part of what is compiled
            return rates
        for i in range(n - 2, 0, -1):
            fastest = math.inf
            for k in range(d):
                if steepest[i, k] > 0.0:
                    fastest = min(fastest, velocity[k] / steepest[i, k])
            gap = stations[i + 1] - stations[i]
            _rows(i, tangents, before, after, gap, acceleration, slopes, bends, limits)
            reachable[i] = _largest(
                slopes, bends, limits, gap, reachable[i + 1], fastest * fastest
            )  # fmt: skip

        x = 0.0
        for i in range(n - 1):
            gap = stations[i + 1] - stations[i]
            _rows(i, tangents, before, after, gap, acceleration, slopes, bends, limits)
            _, _, high, _ = _range_of(x, slopes, bends, limits, gap, reachable[i + 1])
            x = min(max(x + 2.0 * gap * high, 0.0), reachable[i + 1])
            rates[i + 1] = math.sqrt(x)
        return rates

    return passes  # pyright: ignore[reportReturnType]  # a numba dispatcher


_passes = _compiled(zlib.crc32(Path(__file__).read_bytes()))


def speeds(
    rail: BlendedPath, velocity: Float[Array, " d"], acceleration: Float[Array, " d"]
) -> Float[Array, " m"] | None:
    """Compute the fastest rate of the station at each node, from rest to rest.

    Args:
        rail: The geometry.
        velocity: Limits, shape (d,).
        acceleration: Limits, shape (d,), per second squared.

    Returns:
        Shape (m,), or None when rounding leaves a node at which the motion would stand.
    """
    arrays = (
        rail.stations, rail.tangents, rail.max_derivative, rail.curvature_before,
        rail.curvature_after, velocity, acceleration,
    )  # fmt: skip
    rates = _passes(*(np.ascontiguousarray(one, dtype=np.float64) for one in arrays))
    if not np.all(np.isfinite(rates)) or np.any(rates[1:-1] <= 0.0):
        return None
    return rates
