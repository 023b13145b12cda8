"""Computations that are the same for all bodies of one shape, done once for all scenes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import TypeVar

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Hull, Part

MAX_CACHED_SHAPES = 256
"""Shapes that are remembered of each function; the one asked for longest ago goes first."""

T = TypeVar("T")


def once_a_shape(function: Callable[[Body], T]) -> Callable[[Body], T]:
    """Remember what a function of a body's parts and centre of mass gives, by their content.

    The function sees a body of these alone; whoever calls it must not change what it gives.
    """
    cached: OrderedDict[Hashable, T] = OrderedDict()

    def remembered(body: Body) -> T:
        key = tuple(_content(part) for part in body.parts), body.center_of_mass
        if key not in cached:
            shape = Body("", body.parts, Pose(), movable=True, center_of_mass=body.center_of_mass)
            cached[key] = function(shape)
            if len(cached) > MAX_CACHED_SHAPES:
                cached.popitem(last=False)
        cached.move_to_end(key)
        return cached[key]

    return remembered


def _content(part: Part) -> Hashable:
    shape = part.shape
    if isinstance(shape, Hull):  # compared by identity, and read anew with each problem
        return "hull", shape.vertices.tobytes(), shape.faces.tobytes(), part.pose
    return shape, part.pose
