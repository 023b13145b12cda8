"""The support surface on top of a body, its highest level face, over all its parts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.loading.rectangles import inscribed, largest_of_union
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.outline import outline
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import LEVEL_COSINE, Box, Cylinder, Hull, Part, Surface

if TYPE_CHECKING:
    from jaxtyping import Float

MIN_TOP_WIDTH_M = 0.05
"""Metres: a face that is narrower carries something only where nothing wider is level and free."""

_SAME_HEIGHT = 0.001
_SAME_YAW = math.radians(0.5)
_HEADROOM_M = 0.05
"""Metres: what begins lower above a face stands on it; what begins higher leaves room under it."""

_EDGE_WIDTH_M = 0.01
"""Metres: of several parts or of a hull, a narrower face is an edge."""

_LID_DISTANCE_M = 0.003
"""Metres from a hull's face within which the mesh itself must lie."""

_MOST_PARTS = 400
_MOST_FACES = 40


@dataclass(frozen=True)
class _Face:
    """A level face of a part, z up: a convex polygon (n, 2) seen from above at a height, its sides
    turned by `yaw`.
    """

    corners: Array
    height: float
    yaw: float


@dataclass(frozen=True)
class _Rectangle:
    """A level rectangle: middle, sides along x and y of a frame turned by `yaw`, height. Metres,
    radians.
    """

    x: float
    y: float
    size: tuple[float, float]
    height: float
    yaw: float


def top_of(
    name: str,
    parts: tuple[Part, ...],
    stance: Pose = Pose(),
    triangles: Float[Array, "n 3 3"] | None = None,
) -> Surface | None:
    """Find the highest level rectangle on which another body may stand, as the surface `name`.

    Faces at one height count together, what stands on them is left out, and a face that is at least
    5 cm wide is preferred to narrower ones above it (a chair's seat to the edge of its back).

    Args:
        name: Of the body and the surface.
        parts: In the body's frame.
        stance: How the body is turned when it stands; a turn about the vertical does not matter.
        triangles: (n, 3, 3) in the body's frame, of the meshes among the parts. Several hulls may
            span air, as over a cup: their faces count only where triangles lie in them.

    Returns:
        The surface in the body's frame, its z up in that stance; None when no face is level.
    """
    if len(parts) > _MOST_PARTS:
        return None
    yaw = Pose.from_xyz_yaw(0, 0, 0, -stance.yaw)
    tilt = Pose((0.0, 0.0, 0.0), (yaw @ stance).quaternion)
    if abs(tilt.quaternion[3]) > 1 - 1e-12:
        tilt = Pose()
    placed = tuple(Part(part.shape, tilt @ part.pose) for part in parts)
    boxes = [bounds((part,), Pose()) for part in placed]
    turned_triangles = None if triangles is None else triangles @ tilt.rotation.T
    best = _highest(placed, boxes, turned_triangles)
    if best is None:
        return None
    turned = Pose.from_xyz_yaw(0, 0, 0, best.yaw)
    x, y, _ = turned.apply(np.array([[best.x, best.y, 0.0]]))[0]
    frame = tilt.inverse() @ Pose((float(x), float(y), best.height), turned.quaternion)
    return Surface(name, name, frame, best.size, _clearance(best, boxes))


def _highest(
    parts: tuple[Part, ...], boxes: list[tuple[Array, Array]], triangles: Array | None
) -> _Rectangle | None:
    faces = [
        face
        for part in parts
        for face in _faces(part)
        if len(parts) == 1 or not isinstance(part.shape, Hull) or _solid(face, triangles)
    ]
    plain = len(parts) == 1 and not isinstance(parts[0].shape, Hull)
    narrow: _Rectangle | None = None
    while faces:
        height = max(face.height for face in faces)
        level = [face for face in faces if face.height >= height - _SAME_HEIGHT]
        faces = [face for face in faces if face.height < height - _SAME_HEIGHT]
        found = _largest(level, height, boxes)
        if found is not None and min(found.size) >= MIN_TOP_WIDTH_M - 1e-9:
            return found
        if found is not None and (plain or min(found.size) >= _EDGE_WIDTH_M):
            narrow = narrow or found
    return narrow


def _clearance(place: _Rectangle, boxes: list[tuple[Array, Array]]) -> float:
    """Compute the free height above a rectangle, metres; infinite under the sky."""
    cos, sin = math.cos(place.yaw), math.sin(place.yaw)
    into = np.array([[cos, sin], [-sin, cos]])
    free = math.inf
    for low, high in boxes:
        x0, x1, y0, y1 = _flat_box(low, high, into)
        beside = abs((x0 + x1) / 2 - place.x) >= (x1 - x0 + place.size[0]) / 2 - 1e-5
        beside |= abs((y0 + y1) / 2 - place.y) >= (y1 - y0 + place.size[1]) / 2 - 1e-5
        if low[2] >= place.height + _HEADROOM_M and not beside:
            free = min(free, float(low[2]) - place.height)
    return free


def _faces(part: Part) -> Iterator[_Face]:
    shape, rotation, position = part.shape, part.pose.rotation, part.pose.matrix[:3, 3]
    if isinstance(shape, Box):
        axis = int(np.argmax(np.abs(rotation[2])))
        if abs(rotation[2, axis]) < LEVEL_COSINE:
            return
        half = np.array(shape.size) / 2
        up = math.copysign(1.0, rotation[2, axis])
        u, v = (axis + 1) % 3, (axis + 2) % 3
        signs = np.zeros((4, 3))
        signs[:, axis], signs[:, u], signs[:, v] = up, (-1, 1, 1, -1), (-1, -1, 1, 1)
        corners = (signs * half) @ rotation.T + position
        yield _Face(
            corners[:, :2], float(corners[:, 2].max()), math.atan2(rotation[1, u], rotation[0, u])
        )

    elif isinstance(shape, Cylinder):
        if abs(rotation[2, 2]) < LEVEL_COSINE:
            return
        # Half of the square in the circle, its sides along the cylinder's x and y.
        side = shape.radius / 2**0.5
        square = np.array([[-side, -side, 0], [side, -side, 0], [side, side, 0], [-side, side, 0]])
        corners = (
            square @ rotation.T
            + position
            + rotation[:, 2] * math.copysign(shape.height / 2, rotation[2, 2])
        )
        yield _Face(
            corners[:, :2], float(corners[:, 2].max()), math.atan2(rotation[1, 0], rotation[0, 0])
        )

    elif isinstance(shape, Hull):
        yield from _hull_face(shape, rotation, position)


def _hull_face(shape: Hull, rotation: Array, position: Array) -> Iterator[_Face]:
    points = shape.vertices @ rotation.T + position
    a, b, c = points[shape.faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    up = normals[:, 2] >= LEVEL_COSINE * lengths
    up &= lengths > 1e-12
    if not up.any():
        return
    chosen = points[np.unique(shape.faces[up])]
    height = float(chosen[:, 2].max())
    corners = outline(chosen[:, :2])
    if len(corners) >= 3:
        sides = np.roll(corners, -1, axis=0) - corners
        longest = sides[np.argmax(np.linalg.norm(sides, axis=1))]
        yield _Face(corners, height, math.atan2(longest[1], longest[0]))


def _solid(face: _Face, triangles: Array | None) -> bool:
    """Check whether most of a hull's face is the surface of the mesh and not a lid over air."""
    if triangles is None:
        return False
    near = triangles[np.all(np.abs(triangles[:, :, 2] - face.height) < _LID_DISTANCE_M, axis=1)][
        :, :, :2
    ]
    a, b, c = near.transpose(1, 0, 2)
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    up = area > 1e-12  # counter-clockwise from above
    a, b, c, area = a[up], b[up], c[up], area[up]
    x0, x1, y0, y1 = inscribed(face.corners)
    steps = (np.arange(8) + 0.5) / 8
    grid = np.stack(np.meshgrid(x0 + (x1 - x0) * steps, y0 + (y1 - y0) * steps), axis=-1).reshape(
        -1, 1, 2
    )
    v = ((grid - a)[..., 0] * (c - a)[:, 1] - (c - a)[:, 0] * (grid - a)[..., 1]) / area
    w = ((b - a)[:, 0] * (grid - a)[..., 1] - (grid - a)[..., 0] * (b - a)[:, 1]) / area
    covered = ((v >= -1e-9) & (w >= -1e-9) & (v + w <= 1 + 1e-9)).any(axis=1)
    return bool(covered.mean() >= 0.9)


def _largest(
    level: list[_Face], height: float, boxes: list[tuple[Array, Array]]
) -> _Rectangle | None:
    """Find the largest free rectangle in the union of level faces, along one face's sides."""
    obstacles = [
        (low, high)
        for low, high in boxes
        if high[2] > height + _SAME_HEIGHT and low[2] < height + _HEADROOM_M
    ]

    yaws: list[float] = []
    for face in level:
        yaw = (face.yaw + math.pi / 4) % (math.pi / 2) - math.pi / 4
        if not any(abs(yaw - other) < _SAME_YAW for other in yaws):
            yaws.append(yaw)

    best: _Rectangle | None = None
    for yaw in sorted(yaws, key=abs)[:8]:
        yaw = 0.0 if abs(yaw) < 1e-9 else yaw
        cos, sin = math.cos(yaw), math.sin(yaw)
        into = np.array([[cos, sin], [-sin, cos]])

        rectangles = np.array([inscribed(face.corners @ into.T) for face in level])
        areas = (rectangles[:, 1] - rectangles[:, 0]) * (rectangles[:, 3] - rectangles[:, 2])
        rectangles = rectangles[np.argsort(-areas, kind="stable")[:_MOST_FACES]]
        blocked = np.array([_flat_box(low, high, into) for low, high in obstacles]).reshape(-1, 4)
        (left, _, near, _), (_, right, _, far) = rectangles.min(axis=0), rectangles.max(axis=0)

        over = (
            (blocked[:, 0] < right)
            & (blocked[:, 1] > left)
            & (blocked[:, 2] < far)
            & (blocked[:, 3] > near)
        )
        if over.sum() > 2 * _MOST_FACES:
            return None

        x0, x1, y0, y1 = largest_of_union(rectangles, blocked[over])
        width, depth = x1 - x0, y1 - y0
        if best is None or width * depth > best.size[0] * best.size[1] + 1e-12:
            best = _Rectangle((x0 + x1) / 2, (y0 + y1) / 2, (width, depth), height, yaw)

    return best if best is not None and min(best.size) > 1e-6 else None


def _flat_box(low: Array, high: Array, into: Array) -> Array:
    corners = np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])]) @ into.T
    return np.array(
        [corners[:, 0].min(), corners[:, 0].max(), corners[:, 1].min(), corners[:, 1].max()]
    )
