"""Polylines in configuration space: arrays of shape (n, d), one configuration a row.

Between two rows the motion is the straight line of the stored numbers. A periodic coordinate (the
base's yaw) is therefore stored unwrapped: 3.1 then 3.2, not 3.1 then -3.08.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room

if TYPE_CHECKING:
    from jaxtyping import Float

FULL_TURN_RAD = 2.0 * np.pi


def inside(room: Room, base: Float[Array, " 3"]) -> bool:
    """Check whether the base's centre is in the room."""
    return bool(room.x[0] <= base[0] <= room.x[1] and room.y[0] <= base[1] <= room.y[1])


def nearest(
    reference: Float[Array, " d"], conf: Float[Array, " d"], periodic: Sequence[int] = ()
) -> Float[Array, " d"]:
    """Return `conf`, shape (d,), with its periodic coordinates moved by whole turns to within half
    a turn of `reference`.
    """
    moved = np.array(conf, dtype=float)
    for i in periodic:
        turns = round((reference[i] - moved[i]) / FULL_TURN_RAD)
        if turns:  # zero turns leave the number exactly as it was given
            moved[i] += FULL_TURN_RAD * turns
    return moved


def unwrap(path: Float[Array, "n d"], periodic: Sequence[int] = ()) -> Float[Array, "n d"]:
    """Return the same path, shape (n, d), with no edge turning the longer way round. The first row
    stays as it is.
    """
    rows = [np.array(path[0], dtype=float)]
    for conf in path[1:]:
        rows.append(nearest(rows[-1], conf, periodic))
    return np.array(rows)


def edge_lengths(
    path: Float[Array, "n d"], weights: Float[Array, " d"] | None = None
) -> Float[Array, " n-1"]:
    """Compute the Euclidean length of each edge, shape (n - 1,), each coordinate scaled by its
    weight.
    """
    steps = np.diff(path, axis=0)
    return np.linalg.norm(steps if weights is None else steps * weights, axis=1)


def length(path: Float[Array, "n d"], weights: Float[Array, " d"] | None = None) -> float:
    """Compute the length of the whole path, in the weighted unit."""
    return float(edge_lengths(path, weights).sum())


def at(
    path: Float[Array, "n d"],
    distances: Float[Array, " m"],
    weights: Float[Array, " d"] | None = None,
) -> Float[Array, "m d"]:
    """Interpolate the configurations at `distances` (m,) along the path, in the weighted unit;
    shape (m, d).
    """
    stations = np.concatenate([[0.0], np.cumsum(edge_lengths(path, weights))])
    return np.stack([np.interp(distances, stations, column) for column in path.T], axis=-1)


def without_repeats(path: Float[Array, "n d"]) -> Float[Array, "k d"]:
    """Return the path without rows that equal their predecessor; at least one row stays."""
    keep = np.concatenate([[True], np.any(np.diff(path, axis=0) != 0.0, axis=1)])
    return path[keep]
