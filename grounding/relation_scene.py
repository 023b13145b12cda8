"""The situation that a grounding sees of a scene: the relation's two arguments and what is around
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from grounding.body_geometry import BodyGeometry, geometry_of
from tamp.errors import InputError
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Cavity, Part, Scene, Surface

SURROUNDINGS = 1.0
"""Bodies whose boxes are within this distance of an argument's box are surroundings (paper, section
IV-B), metres.
"""


@dataclass(frozen=True, eq=False)
class Placed:
    """A form somewhere: T_world_body, shape (4, 4)."""

    form: BodyGeometry
    matrix: Array

    @cached_property
    def box(self) -> Array:
        """Return the bounding box along the world's axes: low and high corner, shape (2, 3),
        metres.
        """
        centre, half = self.form.corners.mean(axis=0), np.ptp(self.form.corners, axis=0) / 2
        if len(self.form.vertices) > 8:
            points = self.form.vertices @ self.matrix[:3, :3].T
            return np.stack([points.min(axis=0), points.max(axis=0)]) + self.matrix[:3, 3]
        middle, reach = (
            self.matrix[:3, :3] @ centre + self.matrix[:3, 3],
            np.abs(self.matrix[:3, :3]) @ half,
        )
        return np.stack([middle - reach, middle + reach])


@dataclass(frozen=True, eq=False)
class Region:
    """The rectangle on or in its support where a body is wanted.

    Attributes:
        hollow: Whether it is a cavity; else a surface.
        matrix: T_support_region: the middle of the surface or of the cavity's floor, z up, shape
            (4, 4).
        size: x, y and free height in metres, shape (3,); the height above an open surface is
            infinite.
        box: The argument's box in the support's frame, low and high corner, shape (2, 3): under a
            surface all of the support down to its foot; around a cavity the whole container, or its
            compartment of several.
    """

    hollow: bool
    matrix: Array
    size: Array
    box: Array


@dataclass(frozen=True, eq=False)
class RelationScene:
    """The body, the support or container that it is related to, and the surroundings.

    What the paper numbers, the support first, has names here; where arguments stand in an order, it
    is the planner's.

    Attributes:
        support: The body that carries the region.
        region: The surface or cavity of it that is meant.
        body: What is placed, where it is now: at its start, or where a demonstration has it.
        others: The surroundings: bodies within SURROUNDINGS of an argument, neither of the two.
    """

    support: Placed
    region: Region
    body: Placed
    others: tuple[Placed, ...]

    @property
    def T_world_region(self) -> Array:
        """Return the pose of the region's frame, shape (4, 4)."""
        return self.support.matrix @ self.region.matrix


def relation_scene_of(
    scene: Scene, arguments: Sequence[str], at: Array | None = None
) -> RelationScene:
    """Build the situation of (body, surface or cavity), the planner's order of a relation's
    arguments.

    Args:
        scene: The scene.
        arguments: Names.
        at: T_world_body where the body is to be seen, shape (4, 4); by default where it is.

    Raises:
        InputError: They are something else.
    """
    body = scene.bodies.get(arguments[0])
    place = scene.surfaces.get(arguments[1]) or scene.cavities.get(arguments[1])
    if body is None or place is None:
        said = ", ".join(arguments)
        raise InputError(
            f"a learned grounding takes a body, and a surface or container: not ({said})"
        )
    support = scene.bodies[place.body]
    others = [
        _placed(item.parts, item.pose)
        for item in scene.bodies.values()
        if item is not body and item is not support
    ]
    seen = _placed(body.parts, body.pose) if at is None else Placed(geometry_of(body.parts), at)
    return near(_placed(support.parts, support.pose), region_of(support, place), seen, others)


@lru_cache(maxsize=4096)
def _placed(parts: tuple[Part, ...], pose: Pose) -> Placed:
    """Place a body; bodies mostly stay where they are from one situation to the next."""
    return Placed(geometry_of(parts), pose.matrix)


def near(support: Placed, region: Region, body: Placed, others: Sequence[Placed]) -> RelationScene:
    """Return the situation with those of `others` that are surroundings."""
    around = tuple(
        other
        for other in others
        if min(gap(other.box, support.box), gap(other.box, body.box)) <= SURROUNDINGS
    )
    return RelationScene(support, region, body, around)


def region_of(support: Body, place: Surface | Cavity) -> Region:
    """Build the region of a surface or a cavity of a body."""
    return _region(support.parts, len(support.cavities) == 1 and not support.surfaces, place)


@lru_cache(maxsize=512)
def _region(parts: tuple[Part, ...], alone: bool, place: Surface | Cavity) -> Region:
    low, high = bounds(
        parts, place.pose.inverse()
    )  # T_region_support: the box along the region's axes
    half = np.array(place.size[:2]) / 2
    if isinstance(place, Surface):
        corners = np.array([[-half[0], -half[1], min(float(low[2]), 0.0)], [half[0], half[1], 0.0]])
        height = place.clearance
    else:
        height = place.size[2]
        corners = (
            np.stack([low, high])
            if alone
            else np.array([[-half[0], -half[1], 0.0], [*half, height]])
        )

    return Region(
        isinstance(place, Cavity),
        place.pose.matrix,
        np.array([*place.size[:2], height]),
        _turned(corners, place.pose.matrix),
    )


def _turned(corners: Array, matrix: Array) -> Array:
    middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2
    middle, half = matrix[:3, :3] @ middle + matrix[:3, 3], np.abs(matrix[:3, :3]) @ half
    return np.stack([middle - half, middle + half])


def gap(first: Array, second: Array) -> float:
    """Compute the distance between two boxes along the axes, metres; 0 when they overlap."""
    apart = np.maximum(np.maximum(first[0] - second[1], second[0] - first[1]), 0.0)
    return float(np.sqrt(apart @ apart))
