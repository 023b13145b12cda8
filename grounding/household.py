"""Procedural household shapes with sizes as in the YCB set: boxes, cans, bottles, mugs, bowls and
others.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np
from numpy.random import Generator as Random

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Sphere

WALL = 0.004
"""Thickness of mugs and bowls, metres."""

SEGMENTS = 10
"""Pieces of a round wall."""


def box(rng: Random) -> tuple[Part, ...]:
    """Make a package: no edge shorter than 2 cm or longer than 25 cm."""
    x, y, z = rng.uniform([0.03, 0.05, 0.03], [0.1, 0.18, 0.22])
    return (Part(Box((float(x), float(y), float(z)))),)


def can(rng: Random) -> tuple[Part, ...]:
    """Make a tin, upright."""
    return (Part(Cylinder(float(rng.uniform(0.025, 0.055)), float(rng.uniform(0.03, 0.17)))),)


def ball(rng: Random) -> tuple[Part, ...]:
    """Make a fruit on a small flat foot, so that it rests."""
    radius = float(rng.uniform(0.03, 0.05))
    foot = Cylinder(0.6 * radius, 0.01)
    return Part(Sphere(radius)), Part(foot, Pose((0.0, 0.0, -radius + 0.003)))


def bottle(rng: Random) -> tuple[Part, ...]:
    """Make a bottle: a body, a shoulder and a neck."""
    radius, height = float(rng.uniform(0.025, 0.045)), float(rng.uniform(0.12, 0.24))
    body, neck = 0.65 * height, 0.2 * height
    cone = _ring_hull(radius, 0.4 * radius, body, height - neck)
    return (
        Part(Cylinder(radius, body), _up(body / 2)),
        Part(cone),
        Part(Cylinder(0.4 * radius, neck), _up(height - neck / 2)),
    )


def mug(rng: Random) -> tuple[Part, ...]:
    """Make a mug: a hollow cylinder with a handle."""
    radius, height = float(rng.uniform(0.03, 0.045)), float(rng.uniform(0.06, 0.11))
    handle = 0.6 * height
    bar = Part(Box((0.01, 0.012, handle)), Pose((radius + 0.025, 0.0, height / 2)))
    arms = [
        Part(Box((0.03, 0.012, 0.01)), Pose((radius + 0.01, 0.0, height / 2 + s * handle / 2)))
        for s in (-1, 1)
    ]
    return (*_wall(radius, radius, height), bar, *arms)


def bowl(rng: Random) -> tuple[Part, ...]:
    """Make a bowl: a hollow cone on a flat foot."""
    top = float(rng.uniform(0.06, 0.09))
    return _wall(float(rng.uniform(0.4, 0.6)) * top, top, float(rng.uniform(0.04, 0.065)))


def bracket(rng: Random) -> tuple[Part, ...]:
    """Make a bracket: an L of two boards."""
    width, length, height = (float(v) for v in rng.uniform([0.04, 0.08, 0.06], [0.08, 0.14, 0.14]))
    board = 0.02
    foot = Part(Box((width, length, board)), _up(board / 2))
    return foot, Part(
        Box((width, board, height)), Pose((0.0, (board - length) / 2, board + height / 2))
    )


def dumbbell(rng: Random) -> tuple[Part, ...]:
    """Make a dumbbell: two discs joined by a rod."""
    radius, length = float(rng.uniform(0.025, 0.04)), float(rng.uniform(0.1, 0.18))
    turned = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, math.pi / 2, 0.0)).quaternion
    ends = [
        Part(Cylinder(radius, 0.03), Pose((s * (length - 0.03) / 2, 0.0, 0.0), turned))
        for s in (-1, 1)
    ]
    return (*ends, Part(Cylinder(0.35 * radius, length - 0.04), Pose((0.0, 0.0, 0.0), turned)))


def wedge(rng: Random) -> tuple[Part, ...]:
    """Make a wedge: a prism with a triangular side, such as a piece of cheese."""
    x, y, z = (float(v) for v in rng.uniform([0.05, 0.06, 0.04], [0.1, 0.14, 0.09]))
    corners = np.array(
        [[-x / 2, s * y / 2, 0.0] for s in (-1, 1)]
        + [[x / 2, s * y / 2, 0.0] for s in (-1, 1)]
        + [[-x / 4, s * y / 2, z] for s in (-1, 1)]
    )
    return (Part(hull(corners)),)


def tapered(rng: Random) -> tuple[Part, ...]:
    """Make a tapered cup without a handle, wider at the top, filled."""
    top = float(rng.uniform(0.03, 0.05))
    return (
        Part(
            _ring_hull(float(rng.uniform(0.6, 0.9)) * top, top, 0.0, float(rng.uniform(0.06, 0.14)))
        ),
    )


SHAPES: Mapping[str, Callable[[Random], tuple[Part, ...]]] = {
    "box": box,
    "can": can,
    "bottle": bottle,
    "mug": mug,
    "bowl": bowl,
    "bracket": bracket,
    "dumbbell": dumbbell,
    "wedge": wedge,
    "tapered": tapered,
    "ball": ball,
}
"""Makers by name: each draws one shape of its kind."""

YCB: Mapping[str, tuple[Part, ...]] = {
    "cracker_box": (Part(Box((0.06, 0.16, 0.21))),),
    "sugar_box": (Part(Box((0.045, 0.09, 0.175))),),
    "gelatin_box": (Part(Box((0.028, 0.085, 0.073))),),
    "potted_meat": (Part(Box((0.058, 0.1, 0.085))),),
    "soup_can": (Part(Cylinder(0.033, 0.102)),),
    "tuna_can": (Part(Cylinder(0.0425, 0.033)),),
}
"""Objects of the YCB set whose shape their published sizes give."""


def hull(points: np.ndarray) -> Hull:
    """Compute the convex hull of points (n, 3), its faces outward."""
    from scipy.spatial import ConvexHull

    found = ConvexHull(points)
    vertices = np.array(points[found.vertices])
    index = {old: new for new, old in enumerate(found.vertices)}
    faces = np.array([[index[v] for v in face] for face in found.simplices])
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - vertices.mean(axis=0)) < 0
    faces[inward] = faces[inward][:, ::-1]
    vertices.flags.writeable = False
    return Hull(vertices, faces)


def _ring_hull(low: float, high: float, bottom: float, top: float) -> Hull:
    """Make a truncated cone: radius `low` at height `bottom`, `high` at `top`."""
    turn = np.linspace(0.0, 2 * math.pi, 20, endpoint=False)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    rings = [np.column_stack([r * circle, np.full(20, z)]) for r, z in ((low, bottom), (high, top))]
    return hull(np.concatenate(rings))


def _wall(low: float, high: float, height: float) -> tuple[Part, ...]:
    """Make a floor and SEGMENTS pieces of a wall whose radius grows from `low` to `high`."""
    parts = [Part(Cylinder(low, WALL), _up(WALL / 2))]
    edges = np.linspace(0.0, 2 * math.pi, SEGMENTS + 1)
    for start, end in pairwise(edges):
        corners = [
            ((radius - inset) * math.cos(angle), (radius - inset) * math.sin(angle), z)
            for angle in (start, end)
            for radius, z in ((low, 0.0), (high, height))
            for inset in (0.0, WALL)
        ]
        parts.append(Part(hull(np.array(corners))))
    return tuple(parts)


def _up(height: float) -> Pose:
    return Pose((0.0, 0.0, float(height)))
