"""Shorten a path by straight cuts between random points of it.

Geraerts and Overmars, "Creating high-quality paths for motion planning", IJRR 2007, section 4:
random shortcuts.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.motion.path import edge_lengths, nearest, without_repeats
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

LEAST_GAIN_SHARE = 0.01
"""A cut that saves less than this share of the path is not worth an edge check."""


def shortcut(
    path: Float[Array, "n d"],
    edge_free: Callable[[Array, Array], bool],
    rng: np.random.Generator,
    *,
    tries: int,
    patience: int,
    weights: Float[Array, " d"] | None = None,
    periodic: Sequence[int] = (),
) -> tuple[Float[Array, "m d"], int]:
    """Shorten a path between the same ends by edges that are free or parts of the given path's
    edges.

    Vertices that can be skipped are skipped first; then cuts join random points, on the edges as
    well as at vertices.

    Args:
        path: Shape (n, d).
        edge_free: Whether the straight edge between two configurations is free.
        rng: The only source of chance.
        tries: The most random cuts to draw.
        patience: Stop after so many refused edges in a row.
        weights: Scale of each coordinate in the length, shape (d,).
        periodic: Coordinates that wrap (the base's yaw); a cut never turns the longer way round.

    Returns:
        The path (m, d), and the number of edges asked for.
    """
    path, checks = _skip_vertices(without_repeats(path), edge_free, periodic)
    scale = np.ones(path.shape[1]) if weights is None else weights
    stations = _stations(path, scale)
    refused = 0
    for low, high in np.sort(rng.uniform(size=(tries, 2)), axis=1).tolist():
        if len(path) < 3 or refused >= patience:
            break
        total = stations[-1]
        i, j = bisect_right(stations, low * total) - 1, bisect_right(stations, high * total) - 1
        if i == j:
            continue

        first, second = (
            path[k]
            + (share * total - stations[k])
            / (stations[k + 1] - stations[k])
            * (path[k + 1] - path[k])
            for k, share in ((i, low), (j, high))
        )

        landing = nearest(first, second, periodic)
        if (high - low) * total - math.dist(
            first * scale, landing * scale
        ) < LEAST_GAIN_SHARE * total:
            continue

        checks += 1
        if not edge_free(first, landing):
            refused += 1
            continue

        refused = 0
        path = without_repeats(
            np.concatenate([path[: i + 1], [first, landing], path[j + 1 :] + (landing - second)])
        )
        stations = _stations(path, scale)

    return path, checks


def _stations(path: Array, weights: Array) -> list[float]:
    """Compute the distance of each vertex from the start, along the path."""
    return [0.0, *np.cumsum(edge_lengths(path, weights)).tolist()]


def _skip_vertices(
    path: Array, edge_free: Callable[[Array, Array], bool], periodic: Sequence[int]
) -> tuple[Array, int]:
    """Jump from each kept vertex as far ahead as halving steps find a free edge."""
    kept = [path[0]]
    # Whole turns that the cuts so far have taken out of the rest of the path.
    shift = np.zeros(path.shape[1])
    i, checks = 0, 0
    while i < len(path) - 1:
        jump = len(path) - 1 - i
        while jump > 1:
            target = nearest(kept[-1], path[i + jump] + shift, periodic)
            checks += 1
            if edge_free(kept[-1], target):
                break
            jump //= 2
        target = nearest(kept[-1], path[i + jump] + shift, periodic)
        shift = shift + (target - (path[i + jump] + shift))
        kept.append(target)
        i += jump
    return np.array(kept), checks
