"""The largest rectangles, sides along the axes, in convex polygons and in unions of rectangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

_GRID = 24


def inscribed(polygon: Float[Array, "n 2"]) -> Float[Array, " 4"]:
    """Find the largest inscribed rectangle along the axes in a convex polygon (n, 2),
    counter-clockwise or not: x0, x1, y0, y1.

    Both bounds of y are taken at the sides of the rectangle, where a convex polygon is narrowest.
    """
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    xs = np.unique(np.concatenate([polygon[:, 0], np.linspace(low[0], high[0], _GRID)]))
    floor, ceiling = _sides(polygon, xs)
    bottom = np.maximum(floor[:, None], floor[None, :])
    top = np.minimum(ceiling[:, None], ceiling[None, :])
    areas = np.maximum(xs[None, :] - xs[:, None], 0) * np.maximum(top - bottom, 0)
    i, j = np.unravel_index(int(np.argmax(areas)), areas.shape)
    return np.array([xs[i], xs[j], bottom[i, j], top[i, j]])


def _sides(polygon: Array, xs: Array) -> tuple[Array, Array]:
    """Compute lowest and highest y of a convex polygon at each x."""
    floor, ceiling = np.full(len(xs), np.inf), np.full(len(xs), -np.inf)
    for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        within = (xs >= min(ax, bx) - 1e-12) & (xs <= max(ax, bx) + 1e-12)
        ends = (ay, by) if abs(bx - ax) < 1e-12 else None
        if ends is not None:
            floor[within] = np.minimum(floor[within], min(ends))
            ceiling[within] = np.maximum(ceiling[within], max(ends))
            continue

        y = ay + (by - ay) * (xs[within] - ax) / (bx - ax)
        floor[within] = np.minimum(floor[within], y)
        ceiling[within] = np.maximum(ceiling[within], y)
    return floor, ceiling


def largest_of_union(
    rectangles: Float[Array, "n 4"], blocked: Float[Array, "m 4"]
) -> tuple[float, float, float, float]:
    """Find the largest rectangle in a union of rectangles (n, 4: x0, x1, y0, y1) and out of others
    (m, 4).
    """
    xs = _lines(np.concatenate([rectangles[:, :2].ravel(), blocked[:, :2].ravel()]))
    ys = _lines(np.concatenate([rectangles[:, 2:].ravel(), blocked[:, 2:].ravel()]))
    free = np.zeros((len(xs) - 1, len(ys) - 1), dtype=bool)
    if not free.size:
        return 0.0, 0.0, 0.0, 0.0

    mx, my = (xs[1:] + xs[:-1]) / 2, (ys[1:] + ys[:-1]) / 2
    for x0, x1, y0, y1 in rectangles:
        free[np.ix_((mx > x0) & (mx < x1), (my > y0) & (my < y1))] = True
    for x0, x1, y0, y1 in blocked:
        free[np.ix_((mx > x0) & (mx < x1), (my > y0) & (my < y1))] = False

    best, chosen = 0.0, (0.0, 0.0, 0.0, 0.0)
    for first in range(len(mx)):
        open_ = np.ones(len(my), dtype=bool)
        for last in range(first, len(mx)):
            open_ &= free[last]
            if not open_.any():
                break
            edges = np.flatnonzero(np.diff(np.concatenate([[0], open_.astype(np.int8), [0]])))
            for start, end in zip(edges[::2], edges[1::2], strict=True):
                area = (xs[last + 1] - xs[first]) * (ys[end] - ys[start])
                if area > best + 1e-12:
                    best = float(area)
                    chosen = (
                        float(xs[first]),
                        float(xs[last + 1]),
                        float(ys[start]),
                        float(ys[end]),
                    )

    return chosen


def _lines(values: Array) -> Array:
    """Sort values, those that are nearer than a hundredth of a millimetre counted once."""
    ordered = np.unique(values)
    return ordered[np.concatenate([[True], np.diff(ordered) > 1e-5])]
