"""Exact collision between convex parts by python-fcl; the only user of that library."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING

import fcl
import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Cylinder, Part, Shape, Sphere

if TYPE_CHECKING:
    from jaxtyping import Float


MAX_CACHED_GEOMETRIES = 4096
"""Shapes whose geometry is kept: hulls take a millisecond to build."""


class FclBody:
    """The parts of one body (or link) as FCL objects that can be moved; remembers where they stand.

    Args:
        parts: Convex parts in the body's frame.
    """

    def __init__(self, parts: tuple[Part, ...]) -> None:
        self.objects = [fcl.CollisionObject(geometry(part.shape)) for part in parts]
        self._T_body_part = [part.pose.matrix for part in parts]
        self._at: list[Array | None] = [None] * len(parts)

    @classmethod
    def of_meshes(cls, meshes: Iterable[tuple[Float[Array, "n 3"], NDArray[np.int64]]]) -> FclBody:
        """Make a body of meshes: vertices (n, 3) in the body's frame and faces (m, 3)."""
        body = cls(())
        for vertices, faces in meshes:
            model = fcl.BVHModel()
            model.beginModel(len(vertices), len(faces))
            model.addSubModel(vertices, faces)
            model.endModel()
            body.objects.append(fcl.CollisionObject(model))
            body._T_body_part.append(np.eye(4))
            body._at.append(None)
        return body

    def place(self, index: int, T_world_body: Float[Array, "4 4"]) -> fcl.CollisionObject:
        """Place part `index` with the body at `T_world_body` (4, 4)."""
        if self._at[index] is not T_world_body:
            matrix = T_world_body @ self._T_body_part[index]
            self.objects[index].setTransform(fcl.Transform(matrix[:3, :3], matrix[:3, 3]))
            self._at[index] = T_world_body
        return self.objects[index]


@lru_cache(maxsize=MAX_CACHED_GEOMETRIES)
def geometry(shape: Shape) -> fcl.CollisionGeometry:
    """Build the FCL geometry of a shape, in the shape's own frame; one for all its objects."""
    if isinstance(shape, Box):
        return fcl.Box(*shape.size)
    if isinstance(shape, Cylinder):
        return fcl.Cylinder(shape.radius, shape.height)
    if isinstance(shape, Sphere):
        return fcl.Sphere(shape.radius)
    faces = np.column_stack([np.full(len(shape.faces), 3), shape.faces]).ravel()
    return fcl.Convex(np.array(shape.vertices), len(shape.faces), faces)


def touch(first: fcl.CollisionObject, second: fcl.CollisionObject, padding: float) -> bool:
    """Check whether two objects are nearer than `padding` metres; with 0, that they intersect."""
    if padding <= 0.0:
        return fcl.collide(first, second) > 0
    return fcl.distance(first, second) < padding


def gap(first: fcl.CollisionObject, second: fcl.CollisionObject) -> float:
    """Compute the distance of two objects, metres; 0 where they intersect."""
    return max(0.0, fcl.distance(first, second))


def depth(first: fcl.CollisionObject, second: fcl.CollisionObject) -> float:
    """Compute the penetration depth, metres by which one object has to move to leave another; 0
    where they are apart.
    """
    result = fcl.CollisionResult()
    fcl.collide(
        first, second, fcl.CollisionRequest(num_max_contacts=20, enable_contact=True), result
    )
    return max((abs(float(contact.penetration_depth)) for contact in result.contacts), default=0.0)
