"""The outline of points in a plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


def outline(points: Float[Array, "n 2"]) -> Float[Array, "m 2"]:
    """Compute the corners of the convex hull of points (n, 2), counterclockwise (Andrew's monotone
    chain).
    """
    ordered = sorted({(round(float(x), 9), round(float(y), 9)) for x, y in points})
    if len(ordered) < 3:
        return np.array(ordered)
    chains: list[list[tuple[float, float]]] = []
    for sequence in (ordered, ordered[::-1]):
        chain: list[tuple[float, float]] = []
        for point in sequence:
            while len(chain) >= 2 and _turn(chain[-2], chain[-1], point) <= 1e-12:
                chain.pop()
            chain.append(point)
        chains.append(chain[:-1])
    return np.array(chains[0] + chains[1])


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
