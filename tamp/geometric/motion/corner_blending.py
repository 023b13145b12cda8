"""Corner blending: a polyline whose corners are rounded by parabolic blends where that is
certified, along which a path is timed.

What comes out is again a polyline, dense in the roundings. The timed trajectory runs between its
nodes in straight lines, so that it stays exactly on what was checked; tangents and bends say how
fast each node may be passed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.motion.checker import EdgeTest
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


MAX_BLEND_DISTANCE = 0.3
"""The largest distance from a corner at which its rounding begins (radians or metres)."""

BLEND_EDGE_SHARE = 0.4
"""Of an adjacent edge that a rounding may use: a straight part stays between two roundings."""

MAX_BLEND_HALVINGS = 3
"""Smaller roundings to try where larger ones are not free."""

BLEND_CHORD = 0.06
"""Length of the chords of a rounding, of which there are between 2 and 8."""

TIME_STEP_S = 0.05
"""Seconds: a corner is passed unrounded if its jump of velocity takes no longer."""

NODE_SPACING = 0.1
"""Spacing of the nodes on straight parts, at which the acceleration may change."""

MOST_NODES = 10
"""Nodes on one straight part."""


@dataclass(frozen=True, eq=False)
class BlendedPath:
    """Nodes along the geometry, with derivatives of the position by the station.

    Attributes:
        positions: Shape (m, d).
        stations: Path parameter of the nodes, shape (m,), increasing from 0.
        tangents: First derivative at each node, shape (m, d).
        max_derivative: Largest magnitude of the first derivative beside each node, shape (m, d);
            for the speed limits.
        curvature_before: Second derivative just before each node, shape (m, d).
        curvature_after: The same just after it.
        straight: For each interval whether it may be sampled more finely, shape (m - 1,).
    """

    positions: Array
    stations: Array
    tangents: Array
    max_derivative: Array
    curvature_before: Array
    curvature_after: Array
    straight: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Corner:
    """A vertex of the path and how to pass it.

    Attributes:
        vertex: Shape (d,).
        before: Unit direction of the edge that leads to it.
        after: Unit direction of the edge that leads away.
        reach: If positive, it is rounded by a parabola from so far before it to so far after it.
        window: If positive, it is one sample of a smooth curve and passed as it is: no other sample
            stands nearer. If neither is, the motion rests there.
    """

    vertex: Array
    before: Array
    after: Array
    reach: float = 0.0
    window: float = 0.0

    @property
    def blend_length(self) -> float:
        """Return how much of either adjacent edge belongs to the corner; zero where the motion
        rests.
        """
        return self.reach or self.window

    @property
    def bend(self) -> Float[Array, " d"]:
        """Second derivative within the rounding; zero for a corner that is not rounded."""
        return (
            (self.after - self.before) / (2.0 * self.reach)
            if self.reach
            else np.zeros_like(self.before)
        )

    def shares(self) -> Float[Array, " k"]:
        """Return parameters in [0, 1] between which the chords of the rounding run, evenly spaced
        in the station.
        """
        return np.linspace(
            0.0, 1.0, int(np.clip(np.ceil(2.0 * self.reach / BLEND_CHORD), 2, 8)) + 1
        )

    def curve(self) -> Float[Array, "k d"]:
        """Compute the rounding at those parameters, shape (chords + 1, d)."""
        t = self.shares()[:, None]
        return self.vertex + self.reach * (t**2 * self.after - (1 - t) ** 2 * self.before)


def corners(
    path: Float[Array, "n d"], acceleration: Float[Array, " d"], edge_free: EdgeTest | None = None
) -> list[Corner]:
    """Decide how to pass each vertex of a path; at its ends the motion rests.

    A corner is rounded if `edge_free` certifies the chords of the rounding. Vertices that sample a
    smooth curve so closely that the velocity jumps by no more than the acceleration limit allows in
    TICK seconds are passed unrounded.

    Args:
        path: Shape (n, d), n >= 2, no two successive rows equal.
        acceleration: Limits, shape (d,).
        edge_free: Decides straight edges; None rounds nothing.
    """
    steps = np.diff(path, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    along = steps / lengths[:, None]
    inner = [
        _corner(
            path[k],
            along[k - 1],
            along[k],
            float(min(lengths[k - 1], lengths[k])),
            acceleration,
            edge_free,
        )
        for k in range(1, len(path) - 1)
    ]
    return [Corner(path[0], along[0], along[0]), *inner, Corner(path[-1], along[-1], along[-1])]


def _corner(
    vertex: Array,
    before: Array,
    after: Array,
    shorter: float,
    acceleration: Array,
    edge_free: EdgeTest | None,
) -> Corner:
    with np.errstate(divide="ignore"):
        smooth = TIME_STEP_S**2 * float(np.min(acceleration / np.abs(after - before)))
    if 0.5 * shorter <= smooth:
        return Corner(vertex, before, after, window=0.5 * shorter)
    if edge_free is not None:
        for halving in range(MAX_BLEND_HALVINGS + 1):
            rounded = Corner(
                vertex,
                before,
                after,
                reach=min(BLEND_EDGE_SHARE * shorter, MAX_BLEND_DISTANCE) * 0.5**halving,
            )
            if all(edge_free(a, b) for a, b in pairwise(rounded.curve())):
                return rounded
    return Corner(vertex, before, after)


_Node = tuple[
    Array, float, Array, Array, Array, Array, int
]  # Rail's columns, then the edge it lies on, or -1


def blend(passed: list[Corner]) -> BlendedPath:
    """Blend the path through corners at which the motion does not rest, except at the first and the
    last.
    """
    *columns, edges = zip(*_nodes(passed), strict=True)
    on = np.array(edges)
    return BlendedPath(
        *(np.array(column) for column in columns), straight=(on[:-1] == on[1:]) & (on[1:] >= 0)
    )


def _nodes(passed: list[Corner]) -> Iterator[_Node]:
    """Yield the nodes in order: those of each edge's straight part, then those of the corner at its
    end.
    """
    lengths = [float(np.linalg.norm(b.vertex - a.vertex)) for a, b in pairwise(passed)]
    # Of the vertex at the start of the edge; a rounding counts as long as the two legs it replaces.
    station = 0.0
    for k, (first, last) in enumerate(pairwise(passed)):
        extent, u = lengths[k], first.after
        if not _covered(first, last, extent):
            yield from _straight(first, last, station, extent, k)

        station += extent
        if k + 2 == len(passed):
            return

        v = last.after
        if last.reach:
            for t, position in zip(last.shares()[1:-1], last.curve()[1:-1], strict=True):
                tangent = (1 - t) * u + t * v
                yield (
                    position,
                    station + (2 * t - 1) * last.reach,
                    tangent,
                    np.abs(tangent),
                    last.bend,
                    last.bend,
                    -1,
                )
        else:
            gaps = [
                extent if _covered(first, last, extent) else last.window,
                lengths[k + 1] if _covered(last, passed[k + 2], lengths[k + 1]) else last.window,
            ]
            # The jump, spread over the time between the middles of the intervals.
            bend = (v - u) / (0.5 * sum(gaps))

            yield (
                last.vertex,
                station,
                0.5 * (u + v),
                np.maximum(np.abs(u), np.abs(v)),
                bend,
                bend,
                -1,
            )


def _straight(
    first: Corner, last: Corner, station: float, extent: float, edge: int
) -> Iterator[_Node]:
    """Return the part of an edge that belongs to neither corner, with nodes at both ends."""
    u, zero = first.after, np.zeros_like(first.after)
    begin, end = first.blend_length, extent - last.blend_length
    parts, max_derivative = (
        min(max(math.ceil((end - begin) / NODE_SPACING), 1), MOST_NODES),
        np.abs(u),
    )
    for i in range(parts + 1):
        offset = end if i == parts else begin + i * ((end - begin) / parts)
        at_end = i == parts and not last.blend_length
        position = last.vertex if at_end else first.vertex + offset * u
        bends = (first.bend if i == 0 else zero, last.bend if i == parts else zero)
        yield position, station + offset, u, max_derivative, *bends, edge


def _covered(first: Corner, last: Corner, extent: float) -> bool:
    """Check whether the corners at both ends take the whole edge."""
    return first.blend_length + last.blend_length > (1.0 - 1e-6) * extent
