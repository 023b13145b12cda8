"""Situations made by hand: bodies of four shapes on a table."""

from __future__ import annotations

import math

import numpy as np

from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array
from tests.geometric.making import cuboid

TOP = 0.7
THING, BOX, CRATE, WEDGE = range(4)
HALF = np.array([[0.03, 0.02, 0.05], [0.1, 0.06, 0.04], [0.2, 0.15, 0.1], [0.03, 0.02, 0.05]])
INNER = np.array([[0, 0, 0, 0], [0, 0, 0, 0], [0.18, 0.13, -0.08, 0.18], [0, 0, 0, 0]], dtype=float)
CORNERS = np.array([cuboid(tuple(2 * half)) for half in HALF])
CORNERS[WEDGE, 6:] = CORNERS[WEDGE, :2]  # a triangle from above


def about_z(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def situation(
    *bodies: tuple[int, float, float, float],
    front: float = 0.0,
    middle: tuple[float, float] = (0, 0),
) -> Situations:
    """Bodies, each a shape at x, y and yaw, on a table of 1.2 x 0.8 m whose front has a yaw."""
    shapes = np.array([shape for shape, *_ in bodies])
    p = np.array([[x, y, TOP + HALF[shape][2]] for shape, x, y, _ in bodies])
    R = np.array([about_z(yaw) for *_, yaw in bodies])
    support = np.array([[TOP, front, *middle, 0.6, 0.4]])
    counts = np.full(4, 8)
    return Situations(CORNERS, counts, HALF, INNER, shapes[None], R[None], p[None], support)
