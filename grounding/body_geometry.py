"""The geometry of a body that groundings look at, in the body's own frame."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scaling import scale_part
from tamp.geometric.scene.scene import Body, Part
from tamp.geometric.stability.hulls import body_hull
from tamp.geometric.stability.stable_poses import Face, stable_faces

DIRECTIONS = 128
"""Directions in which a hull's extreme vertices are kept; more vertices would change no
decision.
"""

FEW = 42
"""The same where speed counts."""


@lru_cache(maxsize=512)
def geometry_of(parts: tuple[Part, ...]) -> BodyGeometry:
    """Return the form of these parts, worked out once."""
    return BodyGeometry(parts)


class BodyGeometry:
    """A body's geometry at its size. Metres, in the body's frame.

    Args:
        parts: The body's convex parts.
    """

    def __init__(self, parts: tuple[Part, ...]) -> None:
        self.parts = parts
        self.scale = 1.0
        self._unit: BodyGeometry = self

    def scaled(self, factor: float) -> BodyGeometry:
        """Scale the form about its frame's origin; what is known of this one is not worked out
        again.
        """
        if factor == 1.0:
            return self
        form = BodyGeometry(
            tuple(scale_part(part, factor * self.scale) for part in self._unit.parts)
        )
        form.scale, form._unit = factor * self.scale, self._unit
        return form

    @property
    def unit(self) -> BodyGeometry:
        """Return the form of scale 1 that this one was made of."""
        return self._unit

    @cached_property
    def corners(self) -> Array:
        """Return the bounding box along its own axes: the low and the high corner, shape (2, 3)."""
        if self._unit is not self:
            return self._unit.corners * self.scale
        return np.stack(bounds(self.parts, Pose()))

    @cached_property
    def vertices(self) -> Array:
        """Return corners of its convex hull, the outermost ones in DIRECTIONS directions, shape (v,
        3).
        """
        if self._unit is not self:
            return self._unit.vertices * self.scale
        points, triangles = body_hull(self._body)
        points = points[np.unique(triangles)]
        chosen = np.unique(np.argmax(points @ sphere(DIRECTIONS).T, axis=0))
        return np.ascontiguousarray(points[chosen]) if len(points) > DIRECTIONS else points

    @cached_property
    def outer(self) -> Array:
        """Return fewer of `vertices`, the outermost ones in FEW directions and along its axes,
        shape (v, 3).
        """
        if self._unit is not self:
            return self._unit.outer * self.scale
        directions = np.concatenate([sphere(FEW), np.eye(3), -np.eye(3)])
        chosen = np.unique(np.argmax(self.vertices @ directions.T, axis=0))
        return self.vertices[chosen] if len(self.vertices) > FEW else self.vertices

    @cached_property
    def radius(self) -> float:
        """Return the radius of the sphere about the frame's origin that contains it, metres."""
        return (
            float(np.linalg.norm(self.vertices, axis=1).max())
            if self._unit is self
            else self._unit.radius * self.scale
        )

    @cached_property
    def outer_box(self) -> Array:
        """Return the bounding box of `outer` alone, shape (2, 3)."""
        if self._unit is not self:
            return self._unit.outer_box * self.scale
        return np.stack([self.outer.min(axis=0), self.outer.max(axis=0)])

    @cached_property
    def centre_of_mass(self) -> Array:
        """Return the centre of mass at uniform density, shape (3,)."""
        return (
            self._unit.centre_of_mass * self.scale
            if self._unit is not self
            else centre_of_mass(self._body)
        )

    @cached_property
    def faces(self) -> tuple[Face, ...]:
        """Return the stable faces, the ways in which it can rest, the steadiest first."""
        if self._unit is self:
            return tuple(sorted(stable_faces(self._body), key=lambda face: -face.angle))
        s = self.scale
        return tuple(
            replace(
                face,
                height=face.height * s,
                extent=face.extent * s,
                outline=face.outline * s,
                base=face.base * s,
                centre=face.centre * s,
            )
            for face in self._unit.faces
        )

    @cached_property
    def piece_boxes(self) -> Array:
        """Return the bounding box of each part along the form's axes, shape (parts, 2, 3)."""
        if self._unit is not self:
            return self._unit.piece_boxes * self.scale
        return np.array([piece.corners for piece in self.pieces]).reshape(-1, 2, 3)

    @cached_property
    def pieces(self) -> tuple[BodyGeometry, ...]:
        """Return each part as a form of its own."""
        if self._unit is not self:
            return tuple(piece.scaled(self.scale) for piece in self._unit.pieces)
        return tuple(BodyGeometry((part,)) for part in self.parts)

    @cached_property
    def _body(self) -> Body:
        return Body("form", self.parts, Pose(), movable=True)


def sphere(count: int) -> Array:
    """Return unit vectors spread evenly (Fibonacci's lattice), shape (count, 3)."""
    z = 1 - 2 * (np.arange(count) + 0.5) / count
    angle = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    ring = np.sqrt(1 - z * z)
    return np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=1)
