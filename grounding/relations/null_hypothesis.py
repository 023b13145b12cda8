"""The null hypothesis, chance: situations as they come about without the relation being meant, on
furniture of other heights, yaws and sizes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

FACES = np.array(
    [
        np.eye(3),
        [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
        [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
        [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
        [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    ],
    dtype=float,
)
"""Rotations that set a body onto each of its six sides, (6, 3, 3)."""

NEAR, FAR = 0.2, 0.4
"""Shares of near misses (one thing of a right one is wrong) and of what lies anywhere; the rest
lies close to another argument.
"""


def about_z(angle: Array | float) -> Array:
    """Return rotations about the vertical, (..., 3, 3)."""
    a = np.asarray(angle, dtype=float)
    c, s, o, i = np.cos(a), np.sin(a), np.zeros_like(a), np.ones_like(a)
    return np.stack([c, -s, o, s, c, o, o, o, i], axis=-1).reshape(*a.shape, 3, 3)


def along(angle: Array) -> Array:
    """Return horizontal unit vectors, (..., 3)."""
    return np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)


def lowest(s: Situations, argument: int = 0) -> Array:
    """Return the height of an argument's lowest point, (n,)."""
    own = s.corners[s.shape[:, argument]]
    return np.einsum("nvi,ni->nv", own, s.R[:, argument, 2]).min(axis=1) + s.p[:, argument, 2]


def highest(s: Situations, argument: int = 0) -> Array:
    """Return the height of an argument's highest point, (n,)."""
    own = s.corners[s.shape[:, argument]]
    return np.einsum("nvi,ni->nv", own, s.R[:, argument, 2]).max(axis=1) + s.p[:, argument, 2]


def floor_of(s: Situations, argument: int) -> Array:
    """Return the height of the floor of a container, or of an argument's lowest point, (n,)."""
    inner = s.inner[s.shape[:, argument]]
    low = lowest(s, argument)
    return np.where(inner[:, 3] > 0, s.p[:, argument, 2] + inner[:, 2], low)


def drop(s: Situations, onto: Array, argument: int = 0) -> None:
    """Move an argument up or down so that its lowest point is at a height, in place."""
    s.p[:, argument, 2] += onto - lowest(s, argument)


def chance(shown: Situations, rng: Random, count: int) -> Situations:
    """Make situations like the shown ones on other furniture, argument 0 anywhere plausible."""
    s = _elsewhere(_resized(shown.rows(rng.integers(0, len(shown), count)), rng), rng)
    near, far = spoilt(s, rng), scattered(s, rng)
    around = _close(s, far, rng)

    which = rng.choice(3, count, p=[NEAR, FAR, 1 - NEAR - FAR])
    chosen = s.rows(np.arange(count))
    for kind, part in enumerate((near, far, around)):
        rows = np.flatnonzero(which == kind)
        chosen.p[rows], chosen.R[rows] = part.p[rows], part.R[rows]
    return chosen


def _resized(s: Situations, rng: Random) -> Situations:
    """Give every argument a shape of its own, of another size."""
    n, k = s.shape.shape
    scale = rng.uniform(0.7, 1.4, (n * k, 1)) * np.ones(3)
    scale[:, 1] *= rng.uniform(0.8, 1.25, n * k)
    rows = s.shape.ravel()
    foot = np.stack([lowest(s, j) for j in range(k)], axis=1)
    resized = replace(
        s,
        corners=s.corners[rows] * scale[:, None],
        counts=s.counts[rows],
        half=s.half[rows] * scale,
        inner=s.inner[rows] * np.concatenate([scale, scale[:, 2:]], axis=1),
        shape=np.arange(n * k).reshape(n, k),
    )
    for j in range(k):
        drop(resized, foot[:, j], j)
    return resized


def _elsewhere(s: Situations, rng: Random) -> Situations:
    """Turn and lift the furniture with everything on it; turn the other bodies where they stand."""
    n, k = s.shape.shape
    turn = rng.uniform(-np.pi, np.pi, n)
    lift = rng.uniform(0.2, 1.2, n) - s.support[:, 0]
    foot = np.stack([lowest(s, j) for j in range(k)], axis=1)

    middle = np.concatenate([s.support[:, 2:4], np.zeros((n, 1))], axis=1)[:, None]
    s.p[:] = middle + np.einsum("nij,nkj->nki", about_z(turn), s.p - middle)
    s.R[:] = about_z(turn)[:, None] @ s.R
    s.support[:, 1] += turn
    s.support[:, 0] += lift
    s.R[:, 1:] = about_z(rng.uniform(-np.pi, np.pi, (n, k - 1))) @ s.R[:, 1:]
    for j in range(k):
        drop(s, foot[:, j] + lift, j)
    return s


def scattered(s: Situations, rng: Random) -> Situations:
    """Put argument 0 anywhere on the furniture, on any side."""
    n, far = len(s), s.rows(np.arange(len(s)))
    local = rng.uniform(-0.9, 0.9, (n, 2)) * s.support[:, 4:6]
    turned = np.einsum("nij,nj->ni", about_z(s.support[:, 1])[:, :2, :2], local)
    far.p[:, 0, :2] = s.support[:, 2:4] + turned
    far.R[:, 0] = about_z(rng.uniform(-np.pi, np.pi, n)) @ FACES[rng.integers(0, 6, n)]
    drop(far, s.support[:, 0])
    return far


def spoilt(s: Situations, rng: Random) -> Situations:
    """Change one thing of each situation: the place, the yaw, the side that is down, the height, or
    the side of the other body.
    """
    n, near = len(s), s.rows(np.arange(len(s)))
    what, level = rng.integers(0, 5, n), lowest(s)
    w, r = rng.uniform(-np.pi, np.pi, n), rng.uniform(0.05, 0.25, n)
    near.p[:, 0] += along(w) * np.where(what < 2, r, 0.0)[:, None]
    turn = np.where((what == 2)[:, None, None], about_z(w), np.eye(3))
    near.R[:, 0] = turn @ near.R[:, 0]
    face = FACES[rng.integers(1, 6, n)]
    near.R[:, 0] = np.where((what == 3)[:, None, None], near.R[:, 0] @ face, near.R[:, 0])
    drop(near, level)

    if s.arguments > 1:
        mirrored = 2 * near.p[:, -1] - near.p[:, 0]
        swap = (what == 4) & (rng.random(n) < 0.6)
        near.p[:, 0] = np.where(swap[:, None], mirrored, near.p[:, 0])
        down = (what == 4) | (rng.random(n) < 0.3)
        drop(near, np.where(down, s.support[:, 0], lowest(near)))
    return near


def _close(s: Situations, far: Situations, rng: Random) -> Situations:
    """Put argument 0 close to another one: beside it, on it, in it or above it."""
    n, around = len(s), far.rows(np.arange(len(s)))
    for j in range(1, s.arguments):
        mine = rng.random(n) < (0.9 if j == 1 else 0.45)
        w = rng.uniform(-np.pi, np.pi, n)
        at = s.p[:, j] + along(w) * (rng.random(n) ** 0.7 * 0.4)[:, None]
        around.p[:, 0] = np.where(mine[:, None], at, around.p[:, 0])
        top = s.support[:, 0]
        levels = [top, highest(s, j), floor_of(s, j), top + rng.uniform(0, 0.3, n)]
        which: NDArray[np.intp] = rng.choice(4, n, p=[0.45, 0.3, 0.15, 0.1])
        onto = np.choose(which, levels)
        drop(around, np.where(mine, onto, lowest(around)))
    return around
