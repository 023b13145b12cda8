"""Shortening a path by straight cuts, in compiled code; as in shortcut.py, without coordinates that
wrap.
"""

from __future__ import annotations

import math

from tamp.geometric.collision.edge_decision import decide
from tamp.geometric.collision.gjk import INLINE, JIT
from tamp.geometric.collision.kernels import FREE
from tamp.geometric.motion.tree_loops import uniform, write
from tamp.system.compilation import njit

LEAST_GAIN_SHARE = 0.01
"""A cut that saves less than this share of the path is not worth an edge check."""


@njit(**INLINE)
def _distance(a, b):
    square = 0.0
    for k in range(len(a)):
        square += (b[k] - a[k]) * (b[k] - a[k])
    return math.sqrt(square)


@njit(**JIT)
def skip_vertices(path, count, padding, room, geometry, work):
    """Jump from each kept vertex as far ahead as halving steps find a free edge.

    Returns:
        The number of rows that are left, and of edges asked for.
    """
    kept, i, asked = 1, 0, 0
    while i < count - 1:
        jump = count - 1 - i
        while jump > 1:
            asked += 1
            if decide(path[kept - 1], path[i + jump], padding, True, room, geometry, work) == FREE:
                break
            jump //= 2
        i += jump
        write(path[i], path, kept)
        kept += 1
    return kept, asked


@njit(**INLINE)
def _point(path, stations, count, station, out, row):
    """Write the point of the path at a station into a row; return the edge that it lies on."""
    i = 0
    while i < count - 2 and stations[i + 1] <= station:
        i += 1
    share = (station - stations[i]) / (stations[i + 1] - stations[i])
    for k in range(path.shape[1]):
        out[row, k] = path[i, k] + share * (path[i + 1, k] - path[i, k])
    return i


@njit(**INLINE)
def _splice(path, count, i, j, cut):
    """Replace what is between points on the edges i < j by the cut; return the number of rows."""
    behind = j + 1
    if j == i + 1:  # one vertex becomes two
        for row in range(count - 1, behind - 1, -1):
            write(path[row], path, row + 1)
    elif j > i + 2:
        for row in range(behind, count):
            write(path[row], path, row - (j - i - 2))
    write(cut[0], path, i + 1)
    write(cut[1], path, i + 2)
    return count - (j - i - 2)


@njit(**JIT)
def cut_at_random(
    path, count, stations, cut, tries, patience, padding, state, room, geometry, work
):  # fmt: skip
    """Join random points of the path, on its edges as well as at vertices, where that is free.

    Args:
        path: (rows, conf), of which `count` are used; room for `tries` more.
        stations: (rows,) scratch.
        cut: (2, conf) scratch.
        tries: The most cuts to draw.
        patience: Stop after so many refused edges in a row.

    Returns:
        The number of rows then, and of edges asked for.
    """
    asked = refused = 0
    for _ in range(tries):
        if count < 3 or refused >= patience:
            break

        stations[0] = 0.0
        for row in range(1, count):
            stations[row] = stations[row - 1] + _distance(path[row - 1], path[row])
        total = stations[count - 1]

        first, second = uniform(state) * total, uniform(state) * total
        low, high = min(first, second), max(first, second)
        i = _point(path, stations, count, low, cut, 0)
        j = _point(path, stations, count, high, cut, 1)
        if i == j or high - low - _distance(cut[0], cut[1]) < LEAST_GAIN_SHARE * total:
            continue

        asked += 1
        if decide(cut[0], cut[1], padding, True, room, geometry, work) == FREE:
            refused = 0
            count = _splice(path, count, i, j, cut)
        else:
            refused += 1
    return count, asked
