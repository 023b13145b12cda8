"""Scenes for the sixteen relations, and a person's hand that demonstrates them: noisy, or lazy in what it varies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.random import Generator as Random

from benchmarks.relations.geometry import (
    Array,
    Batch,
    about,
    about_z,
    along,
    drop,
    flat,
    heading,
    high,
    join,
    local,
    low,
    pick,
    reach,
    separation,
)
from benchmarks.relations.relations import RELATIONS
from grounding.relations.null_hypothesis import FACES


def scenes(name: str, n: int, rng: Random, test: bool = False, lazy: str = "") -> Batch:
    """Arguments 1.. stand on a table, argument 0 anywhere on it; `lazy` keeps one height, yaw or size."""
    k, how = RELATIONS[name].arguments, RELATIONS[name].how
    h, cyl, wall = _sizes(how, 1 if lazy in ("size", "all") else n, k, rng, test)
    if lazy in ("size", "all"):
        h, cyl, wall = (np.repeat(one, n, 0) for one in (h, cyl, wall))
    yaw = rng.integers(0, 4, n) * np.pi / 2 + rng.normal(0, 0.2, n)
    top = rng.uniform(0.15, 1.3, n) if test else rng.uniform(0.45, 0.95, n)
    own = rng.uniform(-np.pi, np.pi, (n, k))
    if lazy in ("height", "all"):
        top[:] = 0.72
    if lazy in ("yaw", "all"):
        yaw[:], own[:] = 0.0, 0.0
    half = np.stack([rng.uniform(0.5, 0.8, n), rng.uniform(0.35, 0.55, n)], 1)
    s = {"h": h, "cyl": cyl, "wall": wall, "yaw": yaw, "top": top, "half": half, "centre": rng.uniform(-2, 2, (n, 2))}
    face = np.where(rng.random((n, k)) < 0.7, 0, rng.integers(0, 6, (n, k)))
    if how in ("in", "lean"):
        face[:, 1:] = 0
    if how == "lean":
        face[:, 0] = 0
    face[cyl & (face > 1)] = 0
    s["R"] = about_z(own) @ FACES[face]
    at = rng.uniform(-0.75, 0.75, (n, k, 2)) * half[:, None]
    if k == 3:
        apart = along(rng.uniform(-np.pi, np.pi, n))[:, :2] * rng.uniform(0.28, 0.55, n)[:, None]
        at[:, 2] = at[:, 1] * 0.5 + apart
        at[:, 1] *= 0.5
    s["p"] = np.zeros((n, k, 3))
    s["p"][..., :2] = s["centre"][:, None] + np.einsum("nij,nkj->nki", about_z(yaw)[:, :2, :2], at)
    for i in range(k):
        drop(s, i)
    return s


def _sizes(how: str, n: int, k: int, rng: Random, test: bool) -> tuple[Array, Array, Array]:
    low_, high_ = (0.02, 0.10) if test else (0.025, 0.07)
    h = rng.uniform(low_, high_, (n, k, 3))
    h[..., 2] = rng.uniform(0.02, 0.14, (n, k)) if test else rng.uniform(0.03, 0.10, (n, k))
    cyl, wall = rng.random((n, k)) < 0.4, np.zeros((n, k))
    if how in ("top", "centre"):
        h[:, 1] = h[:, 0, [0, 0, 0]] * rng.uniform(1.0, 1.8, (n, 3)) + [0.015, 0.015, 0]
    if how == "in":
        cyl[:, 1], wall[:, 1] = False, 0.008
        length = rng.uniform(0.09, 0.2 if test else 0.16, n)
        h[:, 1] = np.stack([length, rng.uniform(0.09, 0.16 if test else 0.13, n), rng.uniform(0.04, 0.10, n)], 1)
        h[:, 0] = np.minimum(h[:, 0], 0.055)
    if how == "lean":
        cyl[:, 0] = False
        h[:, 0, 0] = rng.uniform(0.008, 0.02, n)
        h[:, 0, 2] = rng.uniform(0.06, 0.12, n)
        h[:, 1, 2] = np.maximum(h[:, 1, 2], 0.06)
    h[cyl, 1] = h[cyl, 0]
    return h, cyl, wall


def put(name: str, s: Batch, rng: Random, spread: float = 1.0) -> Batch:
    """Argument 0 as the relation wants it: most of its region for spread 1, the middle of it for less."""
    how, n = RELATIONS[name].how, len(s["p"])

    def u(a: float, b: float) -> Array:
        return (a + b) / 2 + (b - a) / 2 * spread * rng.uniform(-1, 1, n)

    p, other = s["p"], s["p"][:, -1]
    if how == "stand":
        s["R"][:, 0] = about_z(rng.uniform(-np.pi, np.pi, n))
    elif how in ("side", "align", "cup"):
        _beside(name, s, u, rng)
    elif how == "face":
        w = rng.uniform(-np.pi, np.pi, n)
        p[:, 0] = other + along(w) * u(0.18, 0.55)[:, None]
        s["R"][:, 0] = about_z(w + np.pi + u(-0.35, 0.35))
    elif how in ("gap", "square"):
        if how == "square":
            turn = heading(s, 1) + np.pi / 2 * rng.choice([-1, 1], n) + u(-0.25, 0.25)
            s["R"][:, 0] = about_z(turn - heading(s, 0)) @ s["R"][:, 0]
        _slide(s, rng.uniform(-np.pi, np.pi, n), u(0, 0.08 if how == "gap" else 0.1), level=True)
    elif how in ("chord", "beyond"):
        v = p[:, 2] - p[:, 1]
        length = np.linalg.norm(v[:, :2], axis=1)
        t = u(0.25, 0.75) if how == "chord" else 1 + u(0.04, 0.25) / length
        side = np.stack([-v[:, 1], v[:, 0], 0 * t], 1) / length[:, None]
        p[:, 0] = p[:, 1] + v * t[:, None] + side * u(-0.04, 0.04)[:, None]
    elif how in ("top", "in", "centre"):
        _, a, e = flat(s, 0, 1, heading(s, 1))
        room = {"top": e - 0.012, "in": e - a - 0.008, "centre": np.minimum(e, 0.02)}[how]
        d = np.stack([u(-1, 1), u(-1, 1)], 1) * np.maximum(room, 0)
        y = heading(s, 1) + np.pi / 2
        p[:, 0] = other + along(heading(s, 1)) * d[:, :1] + along(y) * d[:, 1:]
    elif how == "edge":
        y = along(s["yaw"] + np.pi / 2)
        move = u(0, 0.08) + reach(s, 0, y) - s["half"][:, 1] - local(s, 0)[:, 1]
        p[:, 0] += y * move[:, None]
    elif how == "lean":
        lean(s, rng.uniform(-np.pi, np.pi, n), u(0.15, 0.5))
        return s
    floor = low(s, 1) + s["wall"][:, 1] if how == "in" else None
    drop(s, 0, high(s, 1) if how in ("top", "centre") else floor)
    return s


def _beside(name: str, s: Batch, u: Callable[[float, float], Array], rng: Random) -> None:
    frame = {"left_of_front": s["yaw"], "left_of_world": 0 * s["yaw"], "set_cup": s["yaw"]}.get(name, heading(s, 1))
    if name == "set_cup":
        s["R"][:, 0] = about_z(heading(s, 0))
    if name == "aligned":
        turn = heading(s, 1) + np.pi * rng.integers(0, 2, len(frame)) + u(-0.2, 0.2)
        s["R"][:, 0] = about_z(turn - heading(s, 0)) @ s["R"][:, 0]
    _, a, e = flat(s, 0, 1, frame)
    gap = {"set_cup": u(0.02, 0.06), "aligned": u(0, 0.12)}.get(name, u(0, 0.2))
    side = {"set_cup": 1, "aligned": rng.choice([-1, 1], len(frame))}.get(name, -1)
    y = {"set_cup": u(-0.01, 0.09), "aligned": u(-0.025, 0.025)}.get(name, u(-0.06, 0.06))
    x = side * (gap + a[:, 0] + e[:, 0])
    s["p"][:, 0] = s["p"][:, 1] + along(frame) * x[:, None] + along(frame + np.pi / 2) * y[:, None]


def _slide(s: Batch, direction: Array, gap: Array, level: bool = False) -> None:
    """Put argument 0 in a direction of argument 1, so far from it."""
    s["p"][:, 0, :2] = s["p"][:, 1, :2] + along(direction)[:, :2] * 0.4
    for _ in range(12):
        s["p"][:, 0] -= along(direction) * (separation(s, 0, 1, level) - gap)[:, None]


def lean(s: Batch, direction: Array, angle: Array) -> None:
    """Lean argument 0 against argument 1, from a direction, at an angle: contact exact."""
    axis = along(direction + np.pi / 2)
    s["R"][:, 0] = about(axis, -angle) @ about_z(direction)
    drop(s, 0)
    _slide(s, direction, 0 * angle)


def noisy(s: Batch, rng: Random, lazy: str = "") -> Batch:
    """A person's hand: 1 cm, 8 degrees; heights are snapped, to 1 mm and 1 degree of tilt."""
    n = len(s["p"])
    s["p"][:, 0] += rng.normal(0, 1, (n, 3)) * [0.01, 0.01, 0.001]
    w = rng.uniform(-np.pi, np.pi, n)
    yaw = 0.0 * w if lazy in ("yaw", "all") else rng.normal(0, 0.14, n)
    s["R"][:, 0] = about(along(w), rng.normal(0, 0.017, n)) @ about_z(yaw) @ s["R"][:, 0]
    return s


def spoil(s: Batch, rng: Random, kind: str) -> Batch:
    """What does not hold: near (one thing of a right one is wrong) or far (anywhere on the table, any side down)."""
    n = len(s["p"])
    if kind == "far":
        at = rng.uniform(-0.9, 0.9, (n, 2)) * s["half"]
        s["p"][:, 0, :2] = s["centre"] + np.einsum("nij,nj->ni", about_z(s["yaw"])[:, :2, :2], at)
        s["R"][:, 0] = about_z(rng.uniform(-np.pi, np.pi, n)) @ FACES[rng.integers(0, 6, n)]
        drop(s, 0)
        return s
    what, level = rng.integers(0, 5, n), low(s, 0)
    w, r = rng.uniform(-np.pi, np.pi, n), rng.uniform(0.05, 0.25, n)
    s["p"][:, 0] += along(w) * np.where(what < 2, r, 0)[:, None]
    s["R"][:, 0] = np.where((what == 2)[:, None, None], about_z(w), np.eye(3)) @ s["R"][:, 0]
    face = FACES[rng.integers(1, 6, n)]
    s["R"][:, 0] = np.where((what == 3)[:, None, None], s["R"][:, 0] @ face, s["R"][:, 0])
    drop(s, 0, level)
    if s["p"].shape[1] > 1:
        mirrored = 2 * s["p"][:, -1] - s["p"][:, 0]
        swap = (what == 4) & (rng.random(n) < 0.6)
        s["p"][:, 0] = np.where(swap[:, None], mirrored, s["p"][:, 0])
        down = (what == 4) | (rng.random(n) < 0.3)
        s["p"][:, 0, 2] = np.where(down, s["top"] + reach(s, 0, np.array([0.0, 0.0, 1.0])), s["p"][:, 0, 2])
    return s


def shown(name: str, count: int, holds: bool, rng: Random, test: bool = False, lazy: str = "") -> Batch:
    """`count` situations with one label: demonstrations by a hand, or test situations without."""
    k, oracle, how = RELATIONS[name]
    parts: list[Batch] = []
    found = 0
    while found < count:
        s = scenes(name, 4 * count + 20, rng, test, lazy)
        spread = 1.0 if test or not holds else 0.7
        s = put(name, s, rng, spread) if lazy not in ("yaw", "all") else _unturned(name, s, rng, spread)
        if holds:
            good = oracle(s)
            s = s if test or how == "lean" else noisy(s, rng, lazy)
            good &= oracle(s) if test else oracle(s, 1.4)
        else:
            few = len(s["p"]) // 3
            s = join(spoil(pick(s, slice(few)), rng, "far"), spoil(pick(s, slice(few, None)), rng, "near"))
            good = ~oracle(s, 1.0 if test else 1.2)
        if k > 1 and how != "in":
            good &= np.min([separation(s, 0, j) for j in range(1, k)], axis=0) > -0.012
        rows = rng.permutation(np.flatnonzero(good))[: count - found]
        parts.append(pick(s, rows))
        found += len(rows)
    return join(*parts)


def _unturned(name: str, s: Batch, rng: Random, spread: float) -> Batch:
    """As `put`, by a hand that turns nothing that it need not turn."""
    R = s["R"].copy()
    s = put(name, s, rng, spread)
    if RELATIONS[name].how in ("stand", "side", "gap", "chord", "beyond", "top", "in", "centre", "edge"):
        s["R"][:, 0] = R[:, 0] if RELATIONS[name].how != "stand" else np.eye(3)
        drop(s, 0, high(s, 1) if RELATIONS[name].how in ("top", "centre") else None)
        if RELATIONS[name].how == "in":
            drop(s, 0, low(s, 1) + s["wall"][:, 1])
    return s
