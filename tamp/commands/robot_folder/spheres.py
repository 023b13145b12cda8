"""Sphere covers of convex hulls: what the compiled collision check looks at first.

Greedy set cover: candidates are grid points c inside the hull with radius depth(c) + slack, so that
each sphere stands out by at most `slack`; the next one is the one that covers most of the surface
samples left. The smallest slack for which LEAVES spheres suffice is taken. The spheres are then
grown until they provably cover everything: every point of a hull is within PITCH * sqrt(3) / 2 of a
node of the cubic grid of that pitch, so that it suffices that the spheres, made smaller by that
length, cover all nodes within it of the hull.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.distance import cdist

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull

LEAVES = 20
"""Spheres of a hull, at most."""

PITCH = 0.003
"""Of the grid that proves the cover, metres,"""

MOST_NODES = 300_000
"""and how many nodes it has at most: a larger hull's is coarser."""

INSIDE = 0.01
"""Of the grid of candidates, metres; a thin hull's is finer."""

MOST_CANDIDATES = 2000
"""Centres that are tried, at most."""

SAMPLES = 3000
"""Points on the surface that are to be covered."""

HALVINGS = 7
"""Of the interval in which the slack is sought, (0.001, 0.05) metres or wider."""


def cover(hull: Hull, most: int = LEAVES) -> tuple[Array, float] | None:
    """Compute spheres (k, 4) that contain the hull, centres and radii, and how far the farthest
    stands out of it, metres; None where so few do not suffice.
    """
    vertices = np.asarray(hull.vertices)
    normals, offsets = _planes(vertices)
    inside, depths = _candidates(vertices, normals, offsets)
    if not len(inside):
        return None

    samples = _surface(vertices, SAMPLES)
    distances = np.asarray(cdist(samples, inside), dtype=np.float64)
    low, high, best = 0.001, max(0.05, float(np.ptp(vertices, axis=0).max()) / 4), None
    for _ in range(HALVINGS):
        slack = (low + high) / 2
        chosen = _greedy(distances, depths + slack, most)
        if chosen is None:
            low = slack
        else:
            high, best = slack, (chosen, slack)
    if best is None:
        return None

    chosen, slack = best
    centres, radii = inside[chosen], depths[chosen] + slack
    size = np.ptp(vertices, axis=0) + 2 * PITCH
    pitch = max(PITCH, float((np.prod(size) / MOST_NODES) ** (1 / 3)))
    reach = pitch * np.sqrt(3) / 2
    nodes = _grid(vertices, pitch, pitch)
    nodes = nodes[_depth(nodes, normals, offsets) >= -reach]
    growth = np.full(len(nodes), np.inf)
    for centre, radius in zip(centres, radii, strict=True):
        np.minimum(growth, np.linalg.norm(nodes - centre, axis=1) - radius, out=growth)
    radii = radii + growth.max() + reach
    return np.column_stack([centres, radii]), float((radii - depths[chosen]).max())


def _candidates(vertices: Array, normals: Array, offsets: Array) -> tuple[Array, Array]:
    """Return grid points inside the hull, and how deep they are."""
    for pitch in (INSIDE, INSIDE / 2, INSIDE / 4):
        size = np.ptp(vertices, axis=0)
        pitch = max(pitch, float((np.prod(size) / MOST_CANDIDATES) ** (1 / 3)))
        inside = _grid(vertices, pitch, 0.0)
        depths = _depth(inside, normals, offsets)
        inside, depths = inside[depths > 0.0], depths[depths > 0.0]
        if len(inside) >= LEAVES:
            break
    return inside, depths


def _planes(vertices: Array) -> tuple[Array, Array]:
    """Return unit outward normals (f, 3) and offsets (f,): the hull is {x : normals @ x <=
    offsets}.
    """
    equations = np.unique(ConvexHull(vertices).equations.round(9), axis=0)
    return equations[:, :3], -equations[:, 3]


def _grid(vertices: Array, pitch: float, margin: float) -> Array:
    """Return nodes (n, 3) of the cubic grid in the box around the vertices, grown by `margin`."""
    low, high = vertices.min(axis=0) - margin, vertices.max(axis=0) + margin
    axes = [np.arange(a, b + pitch, pitch) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _depth(points: Array, normals: Array, offsets: Array) -> Array:
    """Compute how deep points are inside: the distance to the surface, negative outside."""
    result = np.full(len(points), np.inf)
    for normal, offset in zip(normals, offsets, strict=True):
        np.minimum(result, offset - points @ normal, out=result)
    return result


def _surface(vertices: Array, count: int) -> Array:
    """Return the vertices and about `count` points spread evenly over the surface of their hull."""
    hull = ConvexHull(vertices)
    pitch = float(np.sqrt(2 * hull.area / count))
    points = [vertices]
    for a, b, c in vertices[hull.simplices]:
        n = int(np.ceil(max(np.linalg.norm(b - a), np.linalg.norm(c - a)) / pitch))
        u, v = (w.ravel() / n for w in np.mgrid[0 : n + 1, 0 : n + 1])
        u, v = u[u + v <= 1, None], v[u + v <= 1, None]
        points.append(a + u * (b - a) + v * (c - a))
    return np.unique(np.concatenate(points).round(5), axis=0)


def _greedy(distances: Array, radii: Array, most: int) -> list[int] | None:
    """Choose candidates (columns) that together contain all samples (rows); None where more than
    `most` would be needed.
    """
    covered = distances <= radii
    left = np.ones(len(distances), dtype=bool)
    chosen: list[int] = []
    while left.any():
        if len(chosen) == most:
            return None
        gains = covered[left].sum(axis=0)
        best = int(gains.argmax())
        if gains[best] == 0:
            return None
        chosen.append(best)
        left &= ~covered[:, best]
    return chosen
