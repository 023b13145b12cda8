"""Collision shapes of rigid bodies and links, and how pybullet describes them."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Cylinder, Part, Sphere


@dataclass(frozen=True, eq=False)
class Solid:
    """One convex piece of a body or a link of the robot, as the engine knows it.

    Attributes:
        owner: The body's or the link's name.
        handle: The engine's number of the body, and `link` the one of the link or the shape in it;
            -1 for pybullet's first link, for all of MuJoCo's shapes.
        offset: T_owner_solid, shape (4, 4).
        centre, half: The box around it in the owner's frame, shape (3,) each, metres.
        pad: What the engine adds to its surface, metres.
    """

    owner: str
    handle: int
    link: int
    offset: Array
    centre: Array
    half: Array
    pad: float = 0.0


def described(part: Part, bullet: ModuleType) -> dict[str, Any]:
    """Describe a convex part's collision shape in pybullet's arguments."""
    shape = part.shape
    if isinstance(shape, Box):
        return {"shapeType": bullet.GEOM_BOX, "halfExtents": [edge / 2 for edge in shape.size]}
    if isinstance(shape, Cylinder):
        return {
            "shapeType": bullet.GEOM_CYLINDER,
            "radius": shape.radius,
            "height": shape.height,
        }
    if isinstance(shape, Sphere):
        return {"shapeType": bullet.GEOM_SPHERE, "radius": shape.radius}
    return {"shapeType": bullet.GEOM_MESH, "vertices": shape.vertices.tolist()}


def arrays(pieces: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """Collect the descriptions of several parts in the arrays of a compound shape."""
    names = {
        "shapeType": "shapeTypes",
        "radius": "radii",
        "height": "lengths",
        "halfExtents": "halfExtents",
    }
    blanks: dict[str, Any] = {
        "shapeType": 0,
        "radius": 0.0,
        "height": 0.0,
        "halfExtents": [0.0] * 3,
    }
    return {names[key]: [one.get(key, blank) for one in pieces] for key, blank in blanks.items()}
