"""Continuous collision checking of an edge in compiled code, as Python calls it; see kernels.py for
the proof.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numba import types

from tamp.geometric.collision.edge_decision import decide, moves_along, pair_of, scratch
from tamp.geometric.collision.gjk import INLINE, JIT
from tamp.geometric.collision.kernels import UNDECIDED
from tamp.geometric.scene.pose import Array
from tamp.system.compilation import njit

__all__ = ["check_edge", "geometry_of", "pair_of", "sources_digest", "unpack"]


@njit(**{**JIT, "_nrt": True})
def unpack(packed, index):
    """Return table `index` of `Tables.packed`, (rows, columns)."""
    start, rows, columns = (
        int(packed[3 * index]),
        int(packed[3 * index + 1]),
        int(packed[3 * index + 2]),
    )
    return packed[start : start + rows * columns].reshape((rows, columns))


@njit(**{**INLINE, "_nrt": True})
def geometry_of(packed):
    """Return all tables of `Tables.packed` after the room's, in their order."""
    return (
        unpack(packed, np.int64(1)), unpack(packed, np.int64(2)), unpack(packed, np.int64(3)),
        unpack(packed, np.int64(4)), unpack(packed, np.int64(5)), unpack(packed, np.int64(6)),
        unpack(packed, np.int64(7)), unpack(packed, np.int64(8)),
    )  # fmt: skip


@njit(**{**JIT, "_nrt": True, "inline": "always"})
def _decided(start, end, padding, packed):
    """Decide an edge; see `decide`."""
    geometry = geometry_of(packed)
    joints, parts, pairs, obstacles = geometry[0], geometry[3], geometry[5], geometry[6]
    work = scratch(parts, joints, pairs, obstacles, len(start), moves_along(start, end))
    room = unpack(packed, np.int64(0))[0]
    return decide(start, end, padding, False, room, geometry, work)


def _compiled(sources: int) -> Callable[[Array, Array, float, Array], int]:
    """Compile the kernel, or load it. `sources` makes the cached one stale when any of its files
    has changed.
    """
    vector, conf = (
        types.Array(types.float64, 1, "C"),
        types.Array(types.float64, 1, "C", readonly=True),
    )
    signature = types.int64(conf, conf, types.float64, vector)

    @njit(signature, cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True)
    def decided(start, end, padding, tables):
        if sources < 0:  # never: so that the number is a part of what is compiled
            return np.int64(UNDECIDED)
        return _decided(start, end, padding, tables)

    return decided  # pyright: ignore[reportReturnType]  # a numba dispatcher


_SOURCES = ("tables", "gjk", "placing", "kernels", "edge_decision", "edge_check")
"""What the kernel is compiled from."""


def sources_digest() -> int:
    """Return a number that changes with any file that the kernel is compiled from; numba itself
    looks at one file only.
    """
    files = (Path(__file__).parent / f"{name}.py" for name in _SOURCES)
    return zlib.crc32(b"".join(file.read_bytes() for file in files))


check_edge = _compiled(sources_digest())
"""check_edge(start, end, padding, tables) -> result: whether the straight line between two
configurations (3 + n,) is free.

Equal configurations make it a state check. `padding` in metres, > 0: both ends and every checked
middle are at least this far from everything, all states between at least half of it. `tables`:
`Tables.packed`, the robot and the bodies.

The verdict is FREE; or HIT, with the pair that is nearer than the padding at some state of the
edge; or UNDECIDED, with a pair for which rounding or room did not suffice. Arrays that are not of
float64 in C order raise TypeError.
"""
