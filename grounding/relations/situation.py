"""Situations: the arguments of a relation where they are, as arrays that a kernel measures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from grounding.body_geometry import geometry_of
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body, Box, Cavity, Part, Scene, Surface

CORNERS = 48
"""Corners of a body's hull that are looked at, at most."""

SLAB = 0.02
"""Thickness that a surface has where it is an argument itself, metres."""

BELOW = 0.02
"""A body may reach so far below the surface on which it is said to stand, metres."""

GROUND = (0.0, 0.0, 0.0, 0.0, 2.0, 2.0)
"""The furniture of what stands on none: the ground, seen from the world's -y."""

Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Situations:
    """A batch of n situations of k arguments over a table of s shapes. Metres, radians.

    Attributes:
        corners: Of the shapes' hulls from the middle of their boxes, the last one repeated, (s, m,
            3).
        counts: How many each has, (s,).
        half: Half the sides of the shapes' own boxes, (s, 3).
        inner: Of a container half the length and width inside, the floor's height from the middle
            of the box, and the depth; zeros for others, (s, 4).
        shape: Rows of the table, (n, k).
        R: Rotations of the bodies in the world, (n, k, 3, 3).
        p: Where the middles of their boxes are, (n, k, 3).
        support: What they stand on: height, yaw of its front, middle x, y, half its sides, (n, 6).
    """

    corners: Array
    counts: Integers
    half: Array
    inner: Array
    shape: Integers
    R: Array
    p: Array
    support: Array

    def __len__(self) -> int:
        return len(self.p)

    @property
    def arguments(self) -> int:
        """Return k."""
        return self.p.shape[1]

    def rows(self, rows: NDArray[np.intp] | Sequence[int]) -> Situations:
        """Return copies of some situations."""
        chosen = np.asarray(rows, dtype=np.intp)
        return replace(
            self,
            shape=self.shape[chosen],
            R=self.R[chosen],
            p=self.p[chosen],
            support=self.support[chosen],
        )


def joined(parts: Sequence[Situations]) -> Situations:
    """Join batches of the same number of arguments."""
    most = max(part.corners.shape[1] for part in parts)
    offsets = np.cumsum([0, *(len(part.counts) for part in parts)])
    padded = [
        np.concatenate(
            [part.corners, np.repeat(part.corners[:, -1:], most - part.corners.shape[1], axis=1)],
            axis=1,
        )
        for part in parts
    ]

    return Situations(
        corners=np.concatenate(padded),
        counts=np.concatenate([part.counts for part in parts]),
        half=np.concatenate([part.half for part in parts]),
        inner=np.concatenate([part.inner for part in parts]),
        shape=np.concatenate(
            [part.shape + offset for part, offset in zip(parts, offsets, strict=False)]
        ),
        R=np.concatenate([part.R for part in parts]),
        p=np.concatenate([part.p for part in parts]),
        support=np.concatenate([part.support for part in parts]),
    )


@dataclass(frozen=True, eq=False)
class Shape:
    """A row of the table of shapes: a body, a surface or a container.

    Attributes:
        corners: Of its hull from the middle of its box, (v, 3).
        half: Half the sides of its own box, (3,).
        inner: As in `Situations`, (4,).
        centre: The middle of its box in its frame, (3,).
    """

    corners: Array
    half: Array
    inner: Array
    centre: Array


@lru_cache(maxsize=1024)
def shape_of(parts: tuple[Part, ...], cavity: Cavity | None = None) -> Shape:
    """Return the shape of a body of these parts, worked out once."""
    form = geometry_of(parts)
    low, high = form.corners
    centre, inner = (low + high) / 2, np.zeros(4)
    if cavity is not None:
        floor = cavity.pose.position[2] - centre[2]
        inner = np.array([cavity.size[0] / 2, cavity.size[1] / 2, floor, cavity.size[2]])
    return Shape(
        np.ascontiguousarray(form.outer[:CORNERS] - centre), (high - low) / 2, inner, centre
    )


@lru_cache(maxsize=512)
def place_shape(place: Surface | Cavity) -> Shape:
    """Return the shape of a place that is an argument itself: a slab below a surface, the room of a
    container.
    """
    x, y = place.size[:2]
    z = place.size[2] if isinstance(place, Cavity) else SLAB
    corners = geometry_of((Part(Box((x, y, z))),)).vertices
    inner = np.array([x / 2, y / 2, -z / 2, z]) if isinstance(place, Cavity) else np.zeros(4)
    middle = z / 2 if isinstance(place, Cavity) else -z / 2
    return Shape(corners, np.array([x, y, z]) / 2, inner, np.array([0.0, 0.0, middle]))


def situation_of(scene: Scene, arguments: Sequence[str]) -> Situations:
    """Return the situation of the arguments where they are, a batch of one.

    Raises:
        InputError: An argument is neither a body nor a place.
    """
    shapes, matrices = zip(*(_placed(scene, name) for name in arguments), strict=True)
    p = np.array([matrix[:3, :3] @ one.centre + matrix[:3, 3] for one, matrix in zip(
        shapes, matrices, strict=True)])  # fmt: skip
    R = np.array([matrix[:3, :3] for matrix in matrices])
    main = min(1, len(arguments) - 1)
    foot = float((shapes[main].corners @ R[main, 2]).min() + p[main, 2])
    support = _own_support(scene, arguments) or support_of(scene, p[main, :2], foot, arguments)
    return table_of(shapes, R[None], p[None], np.array([support]))


def table_of(shapes: Sequence[Shape], R: Array, p: Array, support: Array) -> Situations:
    """Return situations whose arguments have these shapes; R (n, k, 3, 3), p (n, k, 3), support (n,
    6).
    """
    most = max(len(one.corners) for one in shapes)
    corners = np.empty((len(shapes), most, 3))
    for row, one in enumerate(shapes):
        corners[row, : len(one.corners)], corners[row, len(one.corners) :] = (
            one.corners,
            one.corners[-1],
        )
    return Situations(
        corners,
        np.array([len(one.corners) for one in shapes]),
        np.array([one.half for one in shapes]),
        np.array([one.inner for one in shapes]),
        np.tile(np.arange(len(shapes)), (len(p), 1)),
        R,
        p,
        support,
    )


def support_of(
    scene: Scene, at: Array, foot: float, arguments: Sequence[str] = ()
) -> tuple[float, ...]:
    """Find the fixed surface or floor of a container below a point, the highest: as `Situations`
    has it.

    Args:
        scene: The scene.
        at: World x, y.
        foot: The height from which to look down, metres.
        arguments: Bodies that are no furniture here.
    """
    best = GROUND
    for body in scene.bodies.values():
        if body.movable or body.name in arguments:
            continue
        for place in (*body.surfaces, *body.cavities):
            row = place_row(body, place)
            if best[0] < row[0] <= foot + BELOW and _within(row, at):
                best = row
    if best is GROUND:
        return (0.0, 0.0, float(at[0]), float(at[1]), 2.0, 2.0)
    return best


@lru_cache(maxsize=2048)
def _place_row(body: Body, place: Surface | Cavity) -> tuple[float, ...]:
    pose = body.pose @ place.pose
    x, y, z = pose.position
    return (z, pose.yaw + body.front, x, y, place.size[0] / 2, place.size[1] / 2)


def place_row(body: Body, place: Surface | Cavity) -> tuple[float, ...]:
    """Return a place as `Situations.support` has it; turned so that its front looks to -y."""
    z, yaw, x, y, a, b = _place_row(body, place)
    quarter = round(body.front / (math.pi / 2)) % 2
    return (z, yaw, x, y, b, a) if quarter else (z, yaw, x, y, a, b)


def _within(row: Sequence[float], at: Array) -> bool:
    _, yaw, x, y, a, b = row
    c, s = math.cos(yaw), math.sin(yaw)
    u, v = float(at[0]) - x, float(at[1]) - y
    return abs(c * u + s * v) <= a and abs(c * v - s * u) <= b


def _own_support(scene: Scene, arguments: Sequence[str]) -> tuple[float, ...] | None:
    """Return the place that is an argument, where one is: the relation is about that."""
    for name in arguments[1:]:
        place = None if name in scene.bodies and not _is_place(scene, name) else _place(scene, name)
        if place is not None:
            return place_row(scene.bodies[place.body], place)
    return None


def _is_place(scene: Scene, name: str) -> bool:
    """Check whether a name of a body means the place of the same name: that of a fixed one does."""
    return not scene.bodies[name].movable and _place(scene, name) is not None


def _place(scene: Scene, name: str) -> Surface | Cavity | None:
    return scene.surfaces.get(name) or scene.cavities.get(name)


def _placed(scene: Scene, name: str) -> tuple[Shape, Array]:
    """Return the shape of an argument, and T_world_shape."""
    body = scene.bodies.get(name)
    if body is not None and not _is_place(scene, name):
        return shape_of(body.parts, body.cavities[0] if body.cavities else None), body.pose.matrix
    place = _place(scene, name)
    if place is None:
        choices = (*scene.bodies, *scene.surfaces, *scene.cavities)
        raise InputError(f"'{name}' is no body or place", found=name, choices=choices)
    return place_shape(place), scene.world_pose(place).matrix
