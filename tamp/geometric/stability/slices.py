"""Level slices of convex parts, and how far points are from them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array
from tamp.geometric.stability.hulls import outline

if TYPE_CHECKING:
    from jaxtyping import Float, Int


def cut(
    vertices: Float[Array, "n 3"], triangles: Int[NDArray[np.int64], "m 3"], height: float
) -> Float[Array, "k 2"] | None:
    """Cut a convex mesh with a level plane into a polygon; None where it does not meet it, or only
    just.
    """
    above = vertices[:, 2] - height
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    a, b = edges[:, 0], edges[:, 1]
    crossing = above[a] * above[b] < 0.0
    if not crossing.any():
        return None
    share = above[a[crossing]] / (above[a[crossing]] - above[b[crossing]])
    points = vertices[a[crossing]] + share[:, None] * (
        vertices[b[crossing]] - vertices[a[crossing]]
    )
    corners = outline(points[:, :2])
    return corners if len(corners) >= 3 else None


def distances(points: Float[Array, "n 2"], corners: Float[Array, "k 2"]) -> Float[Array, " n"]:
    """Compute the distances of points (n, 2) from a convex polygon; zero inside."""
    inside = np.ones(len(points), dtype=bool)
    least = np.full(len(points), np.inf)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, to = b - a, points - a
        share = np.clip(to @ edge / max(float(edge @ edge), 1e-12), 0.0, 1.0)
        np.minimum(least, np.hypot(*(to - share[:, None] * edge).T), out=least)
        inside &= edge[0] * to[:, 1] - edge[1] * to[:, 0] >= 0.0
    return np.where(inside, 0.0, least)
