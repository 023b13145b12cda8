"""Bodies that overlap at the start."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from tamp.geometric.loading.load import LoadedProblem
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Scene, Sphere

OVERLAP_TOLERANCE_M = 0.001
"""Metres that two bodies may lie in each other at the start, so that touching is no mistake."""

_ENOUGH = 20


@dataclass(frozen=True)
class Overlap:
    """Two bodies and how deep they lie in each other, metres."""

    first: str
    second: str
    depth: float


def check_overlaps(problem: LoadedProblem) -> None:
    """Refuse a problem in which bodies overlap by more than 1 mm at the start.

    Raises:
        InputError: Two bodies overlap; the deepest of the first pairs is named, at the line of the
            later one.
    """
    found = islice(find_overlaps(problem.scene), _ENOUGH)
    deepest = max(found, key=lambda overlap: overlap.depth, default=None)
    if deepest is None:
        return
    first, second = deepest.first, deepest.second
    raise problem.error(
        f"'{first}' and '{second}' overlap at the start, {deepest.depth * 1000:.1f} mm deep",
        about=max(first, second, key=lambda name: problem.lines.get(name, 0)),
        remedy="Move one of them",
    )


def find_overlaps(scene: Scene) -> Iterator[Overlap]:
    """List the pairs of bodies that lie more than 1 mm in each other at the start, in the scene's
    order.

    The depth is the least distance by which a convex part must move to leave another (FCL on the
    exact shapes).
    """
    bodies = list(scene.bodies.values())
    limits = [bounds(body.parts, body.pose) for body in bodies]
    lows, highs = (np.array([corners[end] for corners in limits]).reshape(-1, 3) for end in (0, 1))
    for index, body in enumerate(bodies):
        later = slice(index + 1, None)
        near = np.all(
            (lows[index] <= highs[later] - OVERLAP_TOLERANCE_M)
            & (lows[later] <= highs[index] - OVERLAP_TOLERANCE_M),
            axis=1,
        )
        for other in np.flatnonzero(near) + index + 1:
            depth = _depth(body, bodies[other])
            if depth > OVERLAP_TOLERANCE_M:
                yield Overlap(body.name, bodies[other].name, depth)


def _depth(first: Body, second: Body) -> float:
    """Compute the deepest penetration of any part of one body by any part of the other; 0 when they
    are apart.
    """
    depth = 0.0
    for part in first.parts:
        low, high = bounds((part,), first.pose)
        for other in second.parts:
            other_low, other_high = bounds((other,), second.pose)
            if np.any(low > other_high) or np.any(other_low > high):
                continue
            depth = max(depth, _part_depth(part, first, other, second))
    return depth


def _part_depth(part: Part, body: Body, other: Part, other_body: Body) -> float:
    import fcl

    result = fcl.CollisionResult()
    request = fcl.CollisionRequest(num_max_contacts=20, enable_contact=True)
    fcl.collide(
        _collision_object(part, body), _collision_object(other, other_body), request, result
    )
    return max((abs(float(contact.penetration_depth)) for contact in result.contacts), default=0.0)


def _collision_object(part: Part, body: Body):
    import fcl

    shape = part.shape
    if isinstance(shape, Box):
        geometry = fcl.Box(*shape.size)
    elif isinstance(shape, Cylinder):
        geometry = fcl.Cylinder(shape.radius, shape.height)
    elif isinstance(shape, Sphere):
        geometry = fcl.Sphere(shape.radius)
    else:
        polygons = (
            np.hstack([np.full((len(shape.faces), 1), 3), shape.faces]).astype(np.int32).ravel()
        )
        geometry = fcl.Convex(np.array(shape.vertices), len(shape.faces), polygons)
    pose = body.pose @ part.pose
    return fcl.CollisionObject(
        geometry, fcl.Transform(np.array(pose.rotation), np.array(pose.position))
    )
