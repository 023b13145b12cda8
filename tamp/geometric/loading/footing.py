"""Supports: what carries a body where it is, found by casting rays along vertical lines.

The judge asks the same by rays of its physics engine.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, Sphere

if TYPE_CHECKING:
    from jaxtyping import Float

SUPPORT_GAP_M = 0.0095
"""Metres of air below a body that still count as resting: 0.5 mm less than the judge allows."""

SUPPORT_PENETRATION_M = 0.001
"""Metres by which a body may stand in what carries it."""

SUPPORT_GAP_SPREAD_M = 0.0015
"""Metres by which the gaps of points that carry may differ."""

CENTRE_TOLERANCE_M = 0.001
"""Metres by which the centre of mass may be out of the points that carry; the judge, who feels a
grid, allows twice.
"""

GRID_LINES = 30
"""Lines along x and y."""

MAX_EDGED_PARTS = 8
"""Parts around a body whose edges are felt as well,"""

EDGE_INSET_M = 1e-4
"""this far inside of them, metres."""

MAX_PARTS_AROUND = 400
"""Parts around a body; where there are more, they lie in each other, which is refused elsewhere."""

MAX_PARTS_LOOKED_AT = 8_000
"""Parts looked at for all bodies together: only in a crowd that lies in itself are there more."""

FLOOR_NAME = "floor"
"""What the floor at z = 0 is called among bodies, and by `on:`; it is no surface of the scene."""


@dataclass(frozen=True)
class Footing:
    """The footing of a body: how it stands.

    Attributes:
        on: Names of the bodies that carry it, FLOOR_NAME included; empty when nothing is
            within SUPPORT_GAP_M below it.
        lean: Metres by which the centre of mass is out of what carries it; not positive inside.
    """

    on: frozenset[str]
    lean: float

    @property
    def why(self) -> str | None:
        """Return why it does not stay where it is; None when it does."""
        if not self.on:
            return "nothing is within 10 mm below it"
        if self.lean > CENTRE_TOLERANCE_M:
            return f"its centre of mass is {1000 * self.lean:.1f} mm beyond what carries it"
        return None


class Ground:
    """The bodies of a scene, each asked for what carries it."""

    def __init__(self, bodies: Mapping[str, Body]) -> None:
        self._parts: list[tuple[str, Part, Array]] = []
        self._fixed = {name for name, body in bodies.items() if not body.movable}
        self._pairs = 0
        boxes: list[tuple[Array, Array]] = []
        for name, body in bodies.items():
            for part in body.parts:
                self._parts.append((name, part, body.pose.matrix @ part.pose.matrix))
                boxes.append(bounds((part,), body.pose))
        self._low = np.array([low for low, _ in boxes]).reshape(-1, 3)
        self._high = np.array([high for _, high in boxes]).reshape(-1, 3)

    def footing(self, body: Body) -> Footing:
        """Find what supports a body, among the others as they are; it may be elsewhere than when
        the ground was made.
        """
        low, high = bounds(body.parts, body.pose)
        around = (self._low[:, :2] < high[:2]).all(axis=1) & (self._high[:, :2] > low[:2]).all(
            axis=1
        )
        around &= (self._high[:, 2] > low[2] - SUPPORT_GAP_M - SUPPORT_GAP_SPREAD_M) & (
            self._low[:, 2] < high[2]
        )

        near = [i for i in np.flatnonzero(around) if self._parts[i][0] != body.name]
        others = [self._parts[i] for i in near]
        self._pairs += len(others)
        if len(others) > MAX_PARTS_AROUND or self._pairs > MAX_PARTS_LOOKED_AT:
            fixed = frozenset(name for name, _, _ in others if name in self._fixed)
            return Footing(fixed or frozenset({others[0][0] if others else FLOOR_NAME}), 0.0)

        few = near[:MAX_EDGED_PARTS]
        xy, under = _underside(
            body,
            low,
            high,
            np.concatenate([self._low[few] + EDGE_INSET_M, self._high[few] - EDGE_INSET_M]),
        )

        tops = np.zeros((len(xy), len(others) + 1))  # the floor's first
        for column, (_, part, T_world_part) in enumerate(others, start=1):
            _, tops[:, column] = vertical(part, T_world_part, xy)
        # What is met higher up is beside the body and not below it.
        tops[tops > under[:, None] + SUPPORT_PENETRATION_M + SUPPORT_GAP_SPREAD_M] = -np.inf

        gaps = under[:, None] - tops
        least = float(gaps.min(initial=np.inf))
        if least > SUPPORT_GAP_M:
            return Footing(frozenset(), math.inf)

        carrying = gaps <= least + SUPPORT_GAP_SPREAD_M
        names = [FLOOR_NAME, *(name for name, _, _ in others)]
        on = frozenset(names[column] for column in np.flatnonzero(carrying.any(axis=0)))

        T, centre = body.pose.matrix, centre_of_mass(body)
        point = (T[:3, :3] @ centre + T[:3, 3])[:2]
        return Footing(on, outside(point, xy[carrying.any(axis=1)]))


def outside(point: Float[Array, " 2"], points: Float[Array, "n 2"]) -> float:
    """Compute the metres by which a point (2,) is outside of the convex hull of points (n, 2); not
    positive inside of it.
    """
    angles = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    return float((point @ directions - (points @ directions).max(axis=0)).max())


def body_points(body: Body) -> Float[Array, "n 3"]:
    """Return points on the surfaces of the body's parts that reach their extents, in its own frame,
    shape (n, 3), metres.
    """
    return np.concatenate([part.pose.apply(_points(part)) for part in body.parts])


def vertical(
    part: Part, T_world_part: Float[Array, "4 4"], xy: Float[Array, "n 2"]
) -> tuple[Float[Array, " n"], Float[Array, " n"]]:
    """Intersect a part with vertical lines at xy (n, 2): the heights (n,) at which they enter and
    leave it; (inf, -inf) where they miss it.
    """
    R = T_world_part[:3, :3]
    along = R[2]  # the world's z in the part's frame
    origins = (np.column_stack([xy, np.zeros(len(xy))]) - T_world_part[:3, 3]) @ R
    shape = part.shape
    if isinstance(shape, Sphere):
        enter, leave = _round(origins, along, shape.radius)
    elif isinstance(shape, Cylinder):
        enter, leave = _round(origins * [1.0, 1.0, 0.0], along * [1.0, 1.0, 0.0], shape.radius)
        caps = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
        slab = _between(origins, along, caps, np.full(2, shape.height / 2))
        enter, leave = np.maximum(enter, slab[0]), np.minimum(leave, slab[1])
    elif isinstance(shape, Box):
        normals = np.concatenate([np.eye(3), -np.eye(3)])
        enter, leave = _between(origins, along, normals, np.tile(np.array(shape.size) / 2, 2))
    else:
        enter, leave = _between(origins, along, *_planes(shape))
    missed = ~(leave > enter)
    return np.where(missed, np.inf, enter), np.where(missed, -np.inf, leave)


def _underside(body: Body, low: Array, high: Array, edges: Array) -> tuple[Array, Array]:
    """Return points (n, 2) of the plane under a body, and the heights (n,) of its surface there.

    Lines pass the edges (k, 3) of what is around, too.
    """
    steps: list[Array] = []
    for axis in (0, 1):
        inside = edges[(edges[:, axis] > low[axis]) & (edges[:, axis] < high[axis]), axis]
        steps.append(
            np.concatenate([np.linspace(low[axis], high[axis], GRID_LINES + 2)[1:-1], inside])
        )
    grid = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2)
    points = body.pose.apply(body_points(body))
    lowest = points[points[:, 2] < low[2] + 2 * SUPPORT_GAP_SPREAD_M][:, :2]
    middle = (low + high)[:2] / 2
    # A line along an edge may miss it.
    xy = np.concatenate([grid, middle + (lowest - middle) * 0.998])
    under = np.full(len(xy), np.inf)
    for part in body.parts:
        enter, _ = vertical(part, body.pose.matrix @ part.pose.matrix, xy)
        np.minimum(under, enter, out=under)
    seen = np.isfinite(under)
    return xy[seen], under[seen]


def _round(origins: Array, along: Array, radius: float) -> tuple[Array, Array]:
    """Intersect lines with the points nearer to the origin than a radius: entry and exit."""
    a, b, c = along @ along, origins @ along, np.einsum("ij,ij->i", origins, origins) - radius**2
    if a < 1e-12:
        inside = c < 0
        return np.where(inside, -np.inf, np.inf), np.where(inside, np.inf, -np.inf)
    root = b * b - a * c
    half = np.sqrt(np.maximum(root, 0.0))
    hit = root > 0
    return np.where(hit, (-b - half) / a, np.inf), np.where(hit, (-b + half) / a, -np.inf)


def _between(origins: Array, along: Array, normals: Array, offsets: Array) -> tuple[Array, Array]:
    """Intersect lines with an intersection of half-spaces: where they enter and leave it."""
    slope, room = normals @ along, offsets - origins @ normals.T
    with np.errstate(divide="ignore", invalid="ignore"):
        t = room / slope
    beside = ((np.abs(slope) < 1e-12) & (room < 0)).any(axis=1)
    enter = np.where(slope < -1e-12, t, -np.inf).max(axis=1)
    leave = np.where(slope > 1e-12, t, np.inf).min(axis=1)
    return np.where(beside, np.inf, enter), np.where(beside, -np.inf, leave)


def _planes(hull: Hull) -> tuple[Array, Array]:
    a, b, c = (hull.vertices[hull.faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    kept = lengths > 1e-15
    normals = normals[kept] / lengths[kept, None]
    return normals, np.einsum("ij,ij->i", normals, a[kept])


def _points(part: Part) -> Array:
    shape = part.shape
    if isinstance(shape, Hull):
        return np.asarray(shape.vertices)
    if isinstance(shape, Box):
        signs = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
        return signs * np.array(shape.size) / 2
    turn = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(48)])
    if isinstance(shape, Cylinder):
        return np.concatenate(
            [circle * shape.radius + [0.0, 0.0, z * shape.height / 2] for z in (-1.0, 1.0)]
        )
    tilts = np.linspace(-np.pi / 2, np.pi / 2, 17)
    return (
        np.concatenate([circle * np.cos(tilt) + [0.0, 0.0, np.sin(tilt)] for tilt in tilts])
        * shape.radius
    )
