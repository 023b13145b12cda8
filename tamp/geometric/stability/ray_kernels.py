"""Ray casting in compiled code: lines against convex parts, each given by planes.

`normals` (n, 3) and `offsets` (n,) are the planes of all parts, `first` (p + 1,) where each part's
begin, and at last their number.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from tamp.system.compilation import INNER_KERNEL, njit

OUTER = {"cache": True, "error_model": "numpy", "no_cfunc_wrapper": True}

PARALLEL_SLOPE = 1e-12
"""A line whose slope to a plane is smaller runs along it."""

ROWS, VECTOR = types.Array(types.float64, 2, "C"), types.Array(types.float64, 1, "C")
PLACES, TABLE = types.Array(types.int64, 1, "C"), types.Array(types.int64, 2, "C")
LINES = types.Array(types.float64, 2, "A", readonly=True)
LINE = types.Array(types.float64, 1, "A", readonly=True)


@njit(**INNER_KERNEL)
def _cross(origin, direction, normals, offsets, begin, end):
    """Intersect a line with one part: where it enters and leaves, and the planes there."""
    enter, leave = -math.inf, math.inf
    start_plane = end_plane = begin
    ox, oy, oz = origin[0], origin[1], origin[2]
    dx, dy, dz = direction[0], direction[1], direction[2]
    for k in range(begin, end):
        slope = normals[k, 0] * dx + normals[k, 1] * dy + normals[k, 2] * dz
        room = offsets[k] - (normals[k, 0] * ox + normals[k, 1] * oy + normals[k, 2] * oz)
        if slope < -PARALLEL_SLOPE:
            if room / slope > enter:
                enter, start_plane = room / slope, k
        elif slope > PARALLEL_SLOPE:
            if room / slope < leave:
                leave, end_plane = room / slope, k
        elif room < 0.0 and enter < math.inf:
            enter, start_plane = math.inf, k
    return enter, leave, start_plane, end_plane


@njit(types.void(LINES, LINES, ROWS, VECTOR, PLACES, ROWS, ROWS, TABLE, TABLE), **OUTER)
def cross_all(
    origins, directions, normals, offsets, first, starts, ends, start_planes, end_planes
):  # fmt: skip
    """Write the crossings of all lines (k, 3) with all parts, each (k, p); one direction serves all
    lines where only one is given.
    """
    for i in range(len(origins)):
        direction = directions[i if len(directions) > 1 else 0]
        for p in range(len(first) - 1):
            starts[i, p], ends[i, p], start_planes[i, p], end_planes[i, p] = _cross(
                origins[i], direction, normals, offsets, first[p], first[p + 1]
            )


STRETCH = types.Tuple((types.boolean, types.float64, types.float64, types.int64, types.int64))


@njit(STRETCH(LINE, LINE, ROWS, VECTOR, PLACES, types.float64), **OUTER)
def stretch(origin, direction, normals, offsets, first, seam):
    """Find the stretch of solid at the origin of a line, parts nearer than `seam` taken as one.

    Returns:
        Whether there is one; where it starts and ends along the line, and the planes there.
    """
    parts = len(first) - 1
    spans, planes = np.empty((parts, 2)), np.empty((parts, 2), np.int64)
    low, high = math.inf, -math.inf
    start = end = -1
    for p in range(parts):
        spans[p, 0], spans[p, 1], planes[p, 0], planes[p, 1] = _cross(
            origin, direction, normals, offsets, first[p], first[p + 1]
        )
        if spans[p, 1] > spans[p, 0] and spans[p, 0] <= seam and spans[p, 1] >= -seam:
            if spans[p, 0] < low:
                low, start = spans[p, 0], planes[p, 0]
            if spans[p, 1] > high:
                high, end = spans[p, 1], planes[p, 1]
    if start < 0:
        return False, 0.0, 0.0, -1, -1

    longer = True
    while longer:  # parts that touch the stretch lengthen it, one after another
        longer = False
        for p in range(parts):
            if spans[p, 1] <= spans[p, 0]:
                continue
            if spans[p, 0] < low and spans[p, 1] >= low - seam:
                low, start, longer = spans[p, 0], planes[p, 0], True
            if spans[p, 1] > high and spans[p, 0] <= high + seam:
                high, end, longer = spans[p, 1], planes[p, 1], True
    return True, low, high, start, end
