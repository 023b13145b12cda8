"""RRT-Connect and the shortening of its path, compiled whole, as Python calls them."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numba import types

from tamp.geometric.collision.edge_check import geometry_of, sources_digest, unpack
from tamp.geometric.collision.edge_decision import scratch
from tamp.geometric.motion.shortcut_loops import cut_at_random, skip_vertices
from tamp.geometric.motion.tree_loops import grow, trace, write
from tamp.geometric.scene.pose import Array
from tamp.system.compilation import njit


def _compiled(sources: int) -> Callable[..., tuple[Array, int]]:
    """Compile the kernel, or load it. `sources` makes the cached one stale when any of its files
    has changed.
    """
    vector, matrix = (types.Array(types.float64, n, "C", readonly=True) for n in (1, 2))
    packed, number, integer = types.Array(types.float64, 1, "C"), types.float64, types.int64
    found = types.Tuple((types.Array(types.float64, 2, "C"), integer))
    signature = found(
        vector, matrix, vector, vector, integer, vector, integer, number, number, number, integer,
        integer, integer, integer, integer, packed,
    )  # fmt: skip

    @njit(signature, cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True)
    def connected(
        start, goals, lower, upper, first, weights, periodic, reach, domain, padding, most, rows,
        tries, patience, seed, packed,
    ):  # fmt: skip
        size, roots = len(start), len(goals)
        if sources < 0:  # never: so that the number is a part of what is compiled
            return np.empty((0, size)), np.int64(0)

        geometry, room = geometry_of(packed), unpack(packed, np.int64(0))[0]
        work = scratch(geometry[3], geometry[0], geometry[5], geometry[6], size, True)
        trees, parents = np.empty((2, rows, size)), np.empty((2, rows), np.int64)
        domains, counts = np.full((2, rows), np.inf), np.array([1, roots])
        write(start, trees[0], 0)
        for k in range(roots):
            write(goals[k], trees[1], k)
        parents[0, 0] = -1
        parents[1, :roots] = -1
        state, lines = np.array([seed], dtype=np.uint64), np.empty((4, size))
        write(start, lines, 0)

        met_first, met_second, asked = grow(
            trees, parents, domains, counts, lower, upper, first, weights, periodic, reach,
            domain, padding, most, state, room, geometry, work, lines[:1], lines[1:2],
        )  # fmt: skip
        path = np.empty((counts[0] + counts[1] + tries, size))
        if met_first < 0:
            return path[:0], np.int64(asked)

        count = trace(trees, parents, met_first, met_second, path)
        if tries > 0:
            count, more = skip_vertices(path, count, padding, room, geometry, work)
            asked += more
            count, more = cut_at_random(
                path, count, np.empty(len(path)), lines[2:], tries, patience, padding, state, room,
                geometry, work,
            )  # fmt: skip
            asked += more
        return path[:count], np.int64(asked)

    return connected  # pyright: ignore[reportReturnType]  # a numba dispatcher


def _digest() -> int:
    files = (
        Path(__file__).parent / f"{name}.py"
        for name in ("tree_loops", "shortcut_loops", "tree_kernel")
    )
    return zlib.crc32(b"".join(file.read_bytes() for file in files), sources_digest())


connected = _compiled(_digest())
"""connected(start, goals, lower, upper, first, weights, periodic, reach, domain, padding, most,
rows, tries, patience, seed, packed) -> path (m, conf), none or from start to a goal, and edges
asked for.

`packed` are `Tables.packed`, `first`, `weights` and `periodic` say which coordinates move (see
tree_loops.py), between `lower` and `upper`; trees have at most `rows` rows and ask for at most
`most` edges. With `tries` the path is shortened (which coordinates that wrap do not allow).
"""
