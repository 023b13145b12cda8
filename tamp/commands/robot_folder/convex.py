"""Convex hulls of what a URDF collides with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, count

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from tamp.errors import InputError
from tamp.geometric.loading.decomposition import decompose
from tamp.geometric.loading.mesh_file import read_triangles
from tamp.geometric.loading.urdf_link import Capsule, Element
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Sphere

SIDES = 24
"""Of the prism or the ball that stands for a cylinder or a sphere, around it."""

MOST_VERTICES = 160
"""Of a hull; one with more is replaced by a slightly larger one with fewer."""

PIECES = 6
"""Convex pieces of one link's mesh, at most."""

SMALL = 1e-4
"""Cubic metres of a hull that is not decomposed: a tenth of a litre."""

FILLED = 0.9
"""Share of a hull that a mesh fills which is left as it is."""

JOINED = 1.1
"""How much larger than two hulls together their common one may be to stand for both."""


@dataclass(frozen=True, eq=False)
class CollisionElement:
    """A collision element: its triangles in the group's frame, and hulls that stand for it."""

    vertices: Array
    faces: NDArray[np.int64]
    hulls: tuple[Hull, ...]


def solids(elements: Sequence[Element], link: str) -> tuple[CollisionElement, ...]:
    """Read collision elements, each as one hull.

    Raises:
        InputError: A mesh cannot be read, or is flat.
    """
    found: list[CollisionElement] = []
    for element in elements:
        vertices, faces = _triangles(element)
        vertices = element.pose.apply(vertices)
        found.append(CollisionElement(vertices, faces, (hull_of(vertices, link),)))
    return tuple(found)


def pieces(solid: CollisionElement, link: str) -> tuple[Hull, ...]:
    """Decompose an element into several hulls that leave its hollows free; one that is small, or
    nearly fills its hull, stays.
    """
    whole = _volume(solid.hulls[0])
    a, b, c = (solid.vertices[solid.faces[:, i]] for i in range(3))
    filled = abs(float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum())) / 6
    if whole < SMALL or filled > FILLED * whole:
        return solid.hulls
    parts = decompose(solid.vertices, solid.faces, PIECES)
    return tuple(hull_of(part, link) for part in parts) or solid.hulls


def _triangles(element: Element) -> tuple[Array, NDArray[np.int64]]:
    """Return an element's vertices, scaled, and faces, in its own frame."""
    if element.mesh is not None:
        vertices, faces = read_triangles(element.mesh)
        return vertices * np.array(element.scale), faces
    vertices = _corners(element.shape)
    return vertices, np.asarray(ConvexHull(vertices).simplices, dtype=np.int64)


def _corners(shape: Box | Cylinder | Sphere | Capsule | None) -> Array:
    """Return corners of a polyhedron around a primitive."""
    if isinstance(shape, Box):
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        return signs * np.array(shape.size) / 2
    angles = np.arange(SIDES) * 2 * np.pi / SIDES
    ring = np.column_stack([np.cos(angles), np.sin(angles)]) / np.cos(np.pi / SIDES)
    if isinstance(shape, Cylinder):
        return _prism(ring * shape.radius, shape.height / 2)
    if isinstance(shape, Sphere):
        return ball(shape.radius, 0.0)
    if isinstance(shape, Capsule):
        return ball(shape.radius, shape.length / 2)
    raise InputError("a collision element without a geometry")


def _prism(ring: Array, half: float) -> Array:
    return np.concatenate([np.column_stack([ring, np.full(len(ring), z)]) for z in (-half, half)])


def ball(radius: float, half: float) -> Array:
    """Return points around a ball, or around a capsule of that half length."""
    count = 120
    index = np.arange(count) + 0.5
    z, turn = 1 - 2 * index / count, np.pi * (1 + 5**0.5) * index
    across = np.sqrt(1 - z * z)
    points = np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
    inside = -ConvexHull(points).equations[:, 3].max()
    points *= radius / inside
    up = np.array([0.0, 0.0, half])
    return np.concatenate([points + up, points - up]) if half else points


def hull_of(points: Array, link: str) -> Hull:
    """Compute the convex hull of points, with no more than MOST_VERTICES vertices.

    Raises:
        InputError: They lie in a plane.
    """
    points = np.unique(np.asarray(points, dtype=np.float64).round(7), axis=0)
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        thick = _thickened(points)
        try:
            hull, points = ConvexHull(thick), thick
        except (QhullError, ValueError):
            raise InputError(f"link '{link}': a collision shape has no volume") from None
    if len(hull.vertices) > MOST_VERTICES:
        points = _coarser(points[hull.vertices], hull.equations)
        hull = ConvexHull(points)

    new = np.full(len(points), -1)
    new[hull.vertices] = np.arange(len(hull.vertices))
    vertices, faces = points[hull.vertices], new[hull.simplices]
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return Hull(np.ascontiguousarray(vertices), faces.astype(np.int64))


def _thickened(points: Array) -> Array:
    """Give flat points half a millimetre to all sides."""
    steps = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 5e-4
    return (points[:, None] + steps).reshape(-1, 3)


def _coarser(vertices: Array, equations: Array) -> Array:
    """Return fewer points whose hull contains the vertices: the farthest ones in evenly spread
    directions, moved away from the middle until they do.
    """
    index = np.arange(MOST_VERTICES) + 0.5
    z, turn = 1 - 2 * index / MOST_VERTICES, np.pi * (1 + 5**0.5) * index
    across = np.sqrt(1 - z * z)
    directions = np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
    kept = vertices[np.unique((vertices @ directions.T).argmax(axis=0))]
    planes = ConvexHull(kept).equations
    beyond = max(0.0, float((vertices @ planes[:, :3].T + planes[:, 3]).max()))
    middle = kept.mean(axis=0)
    room = float(-(middle @ planes[:, :3].T + planes[:, 3]).max())
    return middle + (kept - middle) * (1.0 + (beyond + 1e-6) / max(room, 1e-4))


def joined(hulls: Sequence[Hull], link: str) -> tuple[Hull, ...]:
    """Merge hulls of one link while that adds next to no volume: fewer make fewer pairs."""
    left = {number: (hull, _volume(hull)) for number, hull in enumerate(hulls)}
    apart: set[tuple[int, int]] = set()
    numbers = count(len(hulls))

    def merge_two() -> bool:
        """Merge the first pair that may be; what was asked of the others is remembered."""
        for first, second in combinations(left, 2):
            if (first, second) in apart:
                continue
            (one, volume), (other, more) = left[first], left[second]
            both = hull_of(np.concatenate([one.vertices, other.vertices]), link)
            whole = _volume(both)
            if whole <= JOINED * (volume + more):
                del left[first], left[second]
                left[next(numbers)] = (both, whole)
                return True
            apart.add((first, second))
        return False

    while merge_two():
        pass
    return tuple(hull for hull, _ in left.values())


def _volume(hull: Hull) -> float:
    return float(ConvexHull(hull.vertices).volume)
