"""True geometry of boxes, cylinders and open boxes, which shares nothing with what is measured.

A batch of scenes is a dict of arrays, first axis n: half sides h (n, k, 3), whether it is a cylinder (n, k), wall of
open boxes (n, k), rotations R (n, k, 3, 3), positions p (n, k, 3) of the k arguments; of the table its top, yaw (its
front looks along -y), centre and half sides. The first argument is the one that is placed. Metres, radians.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.relations.situation import Shape, Situations

Array = NDArray[Any]

Batch = dict[str, Array]

UP = np.array([0.0, 0.0, 1.0])


def about_z(angle: Array | float) -> Array:
    a = np.asarray(angle, float)
    c, s, o, i = np.cos(a), np.sin(a), np.zeros_like(a), np.ones_like(a)
    return np.stack([c, -s, o, s, c, o, o, o, i], -1).reshape(*a.shape, 3, 3)


def about(axis: Array, angle: Array) -> Array:
    """Rotations about unit axes (n, 3)."""
    k = np.zeros((len(angle), 3, 3))
    x, y, z = axis.T
    k[:, 0, 1], k[:, 0, 2], k[:, 1, 2], k[:, 1, 0], k[:, 2, 0], k[:, 2, 1] = -z, y, -x, z, -y, x
    return np.eye(3) + np.sin(angle)[:, None, None] * k + (1 - np.cos(angle))[:, None, None] * (k @ k)


def pick(s: Batch, rows: Any) -> Batch:
    return {key: value[rows].copy() for key, value in s.items()}


def join(*parts: Batch) -> Batch:
    return {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}


def reach(s: Batch, i: int, u: Array) -> Array:
    """Half extent of argument i along directions u, (n, 3) or (3,)."""
    v = np.abs(np.einsum("nji,nj->ni", s["R"][:, i], np.broadcast_to(u, s["p"][:, i].shape)))
    h = s["h"][:, i]
    flat = np.where(s["cyl"][:, i], h[:, 0] * np.hypot(v[:, 0], v[:, 1]), h[:, 0] * v[:, 0] + h[:, 1] * v[:, 1])
    return flat + h[:, 2] * v[:, 2]


def low(s: Batch, i: int) -> Array:
    return s["p"][:, i, 2] - reach(s, i, UP)


def high(s: Batch, i: int) -> Array:
    return s["p"][:, i, 2] + reach(s, i, UP)


def drop(s: Batch, i: int, onto: Array | None = None) -> None:
    s["p"][:, i, 2] = (s["top"] if onto is None else onto) + reach(s, i, UP)


def along(angle: Array) -> Array:
    return np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)


def heading(s: Batch, i: int) -> Array:
    """The yaw of a body: of its x axis, or of its z axis where that one is upright."""
    R = s["R"][:, i]
    axis = np.where(np.abs(R[:, 2, 0]) < 0.8, 0, 2)
    rows = np.arange(len(R))
    return np.arctan2(R[rows, 1, axis], R[rows, 0, axis])


def bearing(s: Batch, i: int, j: int) -> Array:
    v = s["p"][:, j] - s["p"][:, i]
    return np.arctan2(v[:, 1], v[:, 0])


def wrap(angle: Array) -> Array:
    return (angle + np.pi) % (2 * np.pi) - np.pi


def tilt(s: Batch, i: int) -> Array:
    """Angle between up and the nearest axis of the body."""
    return np.arccos(np.clip(np.abs(s["R"][:, i, 2]).max(1), 0, 1))


def flat(s: Batch, i: int, j: int, frame: Array) -> tuple[Array, Array, Array]:
    """Offset of i from j and their half extents along x, y of a horizontal frame, each (n, 2)."""
    x, y = along(frame), along(frame + np.pi / 2)
    v = s["p"][:, i] - s["p"][:, j]
    return (
        np.stack([(v * x).sum(1), (v * y).sum(1)], 1),
        np.stack([reach(s, i, x), reach(s, i, y)], 1),
        np.stack([reach(s, j, x), reach(s, j, y)], 1),
    )


def separation(s: Batch, i: int, j: int, level: bool = False) -> Array:
    """Largest gap along the candidate axes, negative when they overlap; `level`: horizontal axes only."""
    v = s["p"][:, i] - s["p"][:, j]
    a, b = s["R"][:, i].transpose(0, 2, 1), s["R"][:, j].transpose(0, 2, 1)
    axes = [*a.transpose(1, 0, 2), *b.transpose(1, 0, 2), v * [1, 1, 0]]
    if level:
        axes = [x * [1, 1, 0] for x in axes]
    else:
        crosses = [np.cross(a[:, m], b[:, n]) for m in range(3) for n in range(3)]
        axes += [np.broadcast_to(UP, v.shape), v, *crosses]
    best = np.full(len(v), -np.inf)
    for axis in axes:
        length = np.linalg.norm(axis, axis=1)
        u = axis / np.maximum(length, 1e-9)[:, None]
        gap = np.abs((v * u).sum(1)) - reach(s, i, u) - reach(s, j, u)
        best = np.where(length > 1e-3, np.maximum(best, gap), best)
    return best


def chord(s: Batch) -> tuple[Array, Array, Array]:
    """Where argument 0 is on the line from 1 to 2: share of it, distance beside it, its length."""
    b, c, a = s["p"][:, 1, :2], s["p"][:, 2, :2], s["p"][:, 0, :2]
    v, w = c - b, a - b
    length = np.maximum(np.linalg.norm(v, axis=1), 1e-6)
    return (w * v).sum(1) / length**2, (v[:, 0] * w[:, 1] - v[:, 1] * w[:, 0]) / length, length


def rests(s: Batch, i: int, k: float = 1.0) -> Array:
    return np.abs(low(s, i) - s["top"]) < 0.01 * k


def local(s: Batch, i: int) -> Array:
    """Where an argument is on the table, (n, 2)."""
    return np.einsum("nji,nj->ni", about_z(s["yaw"])[:, :2, :2], s["p"][:, i, :2] - s["centre"])


def trouble(s: Batch) -> Array:
    """Metres by which argument 0 is in another one, off the table, or about to roll."""
    bad = np.zeros(len(s["p"]))
    for j in range(1, s["p"].shape[1]):
        bad += np.where(s["wall"][:, j] > 0, 0, np.maximum(-0.001 - separation(s, 0, j), 0))
    bad += np.maximum(np.abs(local(s, 0)) - s["half"] + 0.01, 0).sum(1)
    return bad + np.where(s["cyl"][:, 0] & (np.abs(s["R"][:, 0, 2, 2]) < 0.7), 0.1, 0)


BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
ROUND = np.array(
    [[np.cos(a), np.sin(a), z] for z in (-1, 1) for a in np.linspace(0, 2 * np.pi, 20, endpoint=False)], float
)


def situations(s: Batch) -> Situations:
    """What the learner sees of a batch."""
    n, k = s["cyl"].shape
    h, cyl, wall = s["h"].reshape(-1, 3), s["cyl"].ravel(), s["wall"].ravel()
    corners = np.repeat(BOX[-1][None, None], len(ROUND), 1).repeat(n * k, 0)
    corners[:, : len(BOX)] = BOX
    corners[cyl] = ROUND
    inner = np.stack([h[:, 0] - wall, h[:, 1] - wall, wall - h[:, 2], 2 * h[:, 2] - wall], 1)
    support = np.column_stack([s["top"], s["yaw"], s["centre"], s["half"]])
    return Situations(
        corners * h[:, None], np.where(cyl, len(ROUND), len(BOX)), h, inner * (wall > 0)[:, None],
        np.arange(n * k).reshape(n, k), s["R"].copy(), s["p"].copy(), support,
    )  # fmt: skip


def shapes(s: Batch, row: int) -> list[Shape]:
    """The shapes of one scene."""
    one = situations(pick(s, [row]))
    return [
        Shape(one.corners[i, : one.counts[i]], one.half[i], one.inner[i], np.zeros(3)) for i in range(len(one.counts))
    ]
