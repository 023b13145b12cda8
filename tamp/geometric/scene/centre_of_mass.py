"""The centre of mass of a body: what its file says, or the centroid of its parts, all of one
density.

The judge has one of its own (`tamp.simulation.shapes`), which a test compares with this one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body, Box, Cylinder, Shape, Sphere

if TYPE_CHECKING:
    from jaxtyping import Float

LEAST_VOLUME_M3 = 1e-15
"""Cubic metres that a flat hull counts for, so that it has a centre."""


def centre_of_mass(body: Body) -> Float[Array, " 3"]:
    """Compute the centre of mass in the body's frame, shape (3,), metres; parts that overlap count
    twice there.
    """
    if body.center_of_mass is not None:
        return np.array(body.center_of_mass)
    masses = [volume_and_centroid(part.shape) for part in body.parts]
    centres = [
        part.pose.apply(centroid[None])[0]
        for part, (_, centroid) in zip(body.parts, masses, strict=True)
    ]
    return np.average(centres, axis=0, weights=[volume for volume, _ in masses])


def volume_and_centroid(shape: Shape) -> tuple[float, Float[Array, " 3"]]:
    """Compute the volume of a shape, cubic metres, and its centroid (3,) in its own frame, metres:
    of a hull by tetrahedra over its faces.
    """
    if isinstance(shape, Box):
        return math.prod(shape.size), np.zeros(3)
    if isinstance(shape, Cylinder):
        return math.pi * shape.radius**2 * shape.height, np.zeros(3)
    if isinstance(shape, Sphere):
        return 4 / 3 * math.pi * shape.radius**3, np.zeros(3)

    inside = shape.vertices.mean(axis=0)
    corners = shape.vertices[shape.faces] - inside
    normals = np.cross(corners[:, 1], corners[:, 2])
    volumes = np.abs(np.einsum("ij,ij->i", corners[:, 0], normals)) / 6
    volume = max(float(volumes.sum()), LEAST_VOLUME_M3)
    return volume, inside + (volumes[:, None] * corners.sum(axis=1) / 4).sum(axis=0) / volume
