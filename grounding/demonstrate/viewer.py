"""The viewer: on which side of the furniture one stands who says left, right, behind."""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Scene


def viewer_yaw(scene: Scene, arguments: tuple[str, ...]) -> float:
    """Return the yaw, radians, of the direction in which a viewer looks from the front of what the
    arguments stand on.
    """
    stand = stand_of(scene, arguments)
    return math.pi / 2 if stand is None else stand.pose.yaw + stand.front + math.pi / 2


def stand_of(scene: Scene, arguments: tuple[str, ...]) -> Body | None:
    """Return the furniture that the arguments stand on, or are places of; None for none."""
    found: Body | None = None
    for name in arguments:
        body = scene.bodies.get(name)
        support = name if body is None or body.support is None else body.support
        place = scene.surfaces.get(support) or scene.cavities.get(support)
        owner = None if place is None else scene.bodies[place.body]
        if owner is not None and owner.surfaces:
            return owner
        found = found or owner  # a container, unless there is a table
    return found


def nearest_side(stand: Body, eye: float) -> int:
    """Return the front, degrees as a problem file has it, that is the side nearest to the viewer.

    Args:
        stand: The furniture.
        eye: The direction from there to the viewer's eye, radians in the world.
    """
    return 90 * (round((eye - stand.pose.yaw) / (math.pi / 2) + 1) % 4)


def depth(stand: Body) -> float:
    """Return how deep furniture is as seen from its front, metres."""
    low, high = bounds(stand.parts, Pose())  # in its own frame, however it is turned
    sideways = round(stand.front / (math.pi / 2)) % 2
    return float((high - low)[0 if sideways else 1])


def front_edge(stand: Body) -> Array:
    """Return the middle of the front's upper edge, (3,) metres in the world."""
    low, high = bounds(stand.parts, Pose())
    middle, back = (low + high) / 2, depth(stand) / 2
    x, y = math.sin(stand.front) * back, -math.cos(stand.front) * back
    return stand.pose.apply(np.array([[middle[0] + x, middle[1] + y, high[2]]]))[0]
