"""Made by hand: situations of bodies of four shapes on a table, and committees of given intervals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from grounding.relations.catalogue import catalogue
from grounding.relations.committee import Committee
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


def committee(
    *members: Mapping[str, tuple[float, float]], arguments: int = 2, weights: Sequence[float] = (),
    scores: Sequence[float] = (), zero: Mapping[str, float] | None = None, typical: Sequence[str] = (),
    side: Sequence[int] = (), soft: float = 1.0,
) -> Committee:  # fmt: skip
    """Conjunctions of intervals by the keys of measures, each with the weight of the others."""
    at = {one.key: column for column, one in enumerate(catalogue(arguments))}
    used = sorted({at[key] for one in members for key in one}) or [0]
    shape = (len(members), max([1, *map(len, members)]))
    conditions = np.full(shape, -1)
    low, high = np.full(shape, -np.inf), np.full(shape, np.inf)
    for row, one in enumerate(members):
        for place, (key, (least, most)) in enumerate(one.items()):
            conditions[row, place] = used.index(at[key])
            low[row, place], high[row, place] = least, most
    middle = np.zeros(len(at))
    for key, angle in (zero or {}).items():
        middle[at[key]] = angle
    count = len(typical)
    return Committee(
        arguments, np.array(used), middle, conditions, low, high, np.full(shape, soft),
        np.array(weights or [1 / len(members)] * len(members)),
        np.array(scores or [0.0] * len(members)),
        np.array([at[key] for key in typical], dtype=np.int64), np.zeros(count), np.ones(count),
        np.array(side or [0] * count, dtype=np.int64),
    )  # fmt: skip
