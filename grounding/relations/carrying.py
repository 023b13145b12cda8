"""Carrying over, compiled: coordinates of demonstrations in charts, and poses of these."""

from __future__ import annotations

import math

import numpy as np

from grounding.relations.measure_kernels import _gap, bearing, frames_of, span
from tamp.system.compilation import njit

BESIDE_OVERLAP_M = 0.03
"""A body counts as beside another one where it overlaps it by less along an axis, metres."""

GAP_STEPS = 4
"""Steps by which a gap is reached."""


@njit(cache=True)
def _angle(which, frames, p, free):
    """Return the angle of a frame, of the direction to another argument, or a free one."""
    if which < 0:
        return free
    if which < len(frames):
        return frames[which]
    return bearing(p, 0, which - len(frames) + 1)


@njit(cache=True)
def _extent(corners, counts, shape, R, p, i, angle):
    """Return the middle and half the length of an argument along a horizontal direction."""
    a, b = span(
        corners[shape[i]], counts[shape[i]], R[i], p[i], math.cos(angle), math.sin(angle), 0.0
    )
    return 0.5 * (a + b), 0.5 * (b - a)


@njit(cache=True)
def _coordinate(corners, counts, inner, shape, R, p, origin, mode, angle, axis):
    """Return one coordinate of an offset, and the side on which it is outside of the other."""
    x, a = _extent(corners, counts, shape, R, p, 0, angle)
    y, b = _extent(corners, counts, shape, R, p, origin, angle)
    d = x - y
    if mode == 1 and abs(d) > a + b - BESIDE_OVERLAP_M:
        return abs(d) - a - b, math.copysign(1.0, d)
    if mode == 2:
        return d / max(b, 1e-3), 0.0
    if mode == 3:
        wide = inner[shape[origin], axis] if inner[shape[origin], 3] > 0.0 else b
        return min(1.0, max(-1.0, d / max(wide - a, 1e-3))), 0.0
    return d, 0.0


@njit(cache=True)
def coordinates_of(corners, counts, inner, shapes, Rs, ps, supports, codes, place, outside, yaw):
    """Write the coordinates of situations in charts, arrays as in `Carried`."""
    k = shapes.shape[1]
    frames = np.empty(k + 1 + (1 if k > 2 else 0))
    for d in range(len(shapes)):
        shape, R, p, support = shapes[d], Rs[d], ps[d], supports[d]
        frames_of(R, p, support[1], frames)
        for c in range(len(codes)):
            origin, frame, mode, turn = codes[c]
            yaw[c, d] = _angle(turn, frames, p, 0.0)

            if origin == 0:
                _on_furniture(corners, counts, shape, R, p, support, mode, place[c, d])
                continue

            angle = _angle(frame, frames, p, bearing(p, origin, 0))
            if mode == 4:
                place[c, d, 0] = bearing(p, origin, 0) - angle
                place[c, d, 1] = _gap(corners, counts, shape, R, p, origin, False)
            elif mode == 5:
                length = math.hypot(p[2, 0] - p[1, 0], p[2, 1] - p[1, 1])
                x, y = math.cos(angle), math.sin(angle)
                u, v = p[0, 0] - p[1, 0], p[0, 1] - p[1, 1]
                place[c, d, 0] = (x * u + y * v) / max(length, 1e-6)
                place[c, d, 1] = x * v - y * u
            else:
                for axis in range(2):
                    place[c, d, axis], outside[c, d, axis] = _coordinate(
                        corners, counts, inner, shape, R, p, origin, mode,
                        angle + axis * 0.5 * math.pi, axis,
                    )  # fmt: skip


@njit(cache=True)
def _on_furniture(corners, counts, shape, R, p, support, mode, place):
    """Write how far argument 0 is from an edge of the furniture."""
    if mode == 6:
        return
    axis = 0 if mode < 9 else 1
    sign = -1.0 if mode in (7, 9) else 1.0
    angle = support[1] + axis * 0.5 * math.pi
    x, a = _extent(corners, counts, shape, R, p, 0, angle)
    middle = x - math.cos(angle) * support[2] - math.sin(angle) * support[3]
    place[0] = support[4 + axis] - sign * middle - a


@njit(cache=True)
def turned(R, angle, out):
    """Write a rotation that is turned about the vertical."""
    c, s = math.cos(angle), math.sin(angle)
    for j in range(3):
        x, y = R[0, j], R[1, j]
        out[0, j], out[1, j], out[2, j] = c * x - s * y, s * x + c * y, R[2, j]


@njit(cache=True)
def _put(corners, counts, inner, shape, R, p, origin, mode, angle, place, outside):
    """Put argument 0 where coordinates say, in the plane."""
    qx, qy = 0.0, 0.0
    for axis in range(2):
        direction = angle + axis * 0.5 * math.pi
        x, y = math.cos(direction), math.sin(direction)
        at, a = _extent(corners, counts, shape, R, p, 0, direction)
        _, b = _extent(corners, counts, shape, R, p, origin, direction)
        q = place[axis]
        if mode == 1 and outside[axis] != 0.0:
            q = outside[axis] * (place[axis] + a + b)
        elif mode == 2:
            q = place[axis] * b
        elif mode == 3:
            wide = inner[shape[origin], axis] if inner[shape[origin], 3] > 0.0 else b
            q = place[axis] * max(wide - a, 0.0)
        off = at - x * p[0, 0] - y * p[0, 1]  # of the middle of its extent from its own middle
        qx, qy = qx + x * (q - off), qy + y * (q - off)
    p[0, 0], p[0, 1] = p[origin, 0] + qx, p[origin, 1] + qy


@njit(cache=True)
def _rest(corners, counts, shape, R, p, onto):
    low, _ = span(corners[shape[0]], counts[shape[0]], R[0], p[0], 0.0, 0.0, 1.0)
    p[0, 2] += onto - low


@njit(cache=True)
def _furnish(corners, counts, shape, R, p, support, mode, place, spot):
    """Put argument 0 onto the furniture: anywhere, or so far from one of its edges."""
    for axis in range(2):
        angle = support[1] + axis * 0.5 * math.pi
        x, y = math.cos(angle), math.sin(angle)
        at, a = _extent(corners, counts, shape, R, p, 0, angle)
        q = spot[axis] * max(support[4 + axis] - a, 0.0)
        if mode > 6 and axis == (0 if mode < 9 else 1):
            q = (-1.0 if mode in (7, 9) else 1.0) * (support[4 + axis] - a - place[0])
        move = q + x * support[2] + y * support[3] - at
        p[0, 0], p[0, 1] = p[0, 0] + x * move, p[0, 1] + y * move


@njit(cache=True)
def carry(corners, counts, inner, shape, Rs, ps, supports, codes, place, outside, yaw, rotation,
          free, spot, onto):  # fmt: skip
    """Put argument 0 of n situations, in place, where coordinates in charts say.

    codes (n, 4), place and outside (n, 2), yaw (n,), rotation (n, 3, 3) are of demonstrations, free
    (n, 2) any angles, spot (n, 2) any places from -1 to 1, onto (n,) heights.
    """
    k = ps.shape[1]
    frames = np.empty(k + 1 + (1 if k > 2 else 0))
    for n in range(len(ps)):
        R, p, support = Rs[n], ps[n], supports[n]
        origin, frame, mode, turn = codes[n]
        frames_of(R, p, support[1], frames)
        R[0] = rotation[n]
        angle = _angle(frame, frames, p, free[n, 0])

        if origin > 0:
            away = 0.3 if mode == 4 else 0.0
            direction = angle + place[n, 0]
            p[0, 0] = p[origin, 0] + away * math.cos(direction)
            p[0, 1] = p[origin, 1] + away * math.sin(direction)
            if mode == 5:
                length = math.hypot(p[2, 0] - p[1, 0], p[2, 1] - p[1, 1])
                x, y = math.cos(angle), math.sin(angle)
                u, v = place[n, 0] * length, place[n, 1]
                p[0, 0], p[0, 1] = p[1, 0] + x * u - y * v, p[1, 1] + y * u + x * v
            elif mode != 4:
                _put(corners, counts, inner, shape[n], R, p, origin, mode, angle, place[n],
                     outside[n])  # fmt: skip
        else:
            _furnish(corners, counts, shape[n], R, p, support, mode, place[n], spot[n])

        turned(rotation[n], _angle(turn, frames, p, free[n, 1]) - yaw[n], R[0])
        _rest(corners, counts, shape[n], R, p, onto[n])
        if origin == 0:
            _furnish(corners, counts, shape[n], R, p, support, mode, place[n], spot[n])
        elif mode == 4:
            direction = angle + place[n, 0]
            for _ in range(GAP_STEPS):
                gap = _gap(corners, counts, shape[n], R, p, origin, False)
                p[0, 0] += math.cos(direction) * (place[n, 1] - gap)
                p[0, 1] += math.sin(direction) * (place[n, 1] - gap)
        elif mode != 5:
            _put(corners, counts, inner, shape[n], R, p, origin, mode, angle, place[n], outside[n])
        _rest(corners, counts, shape[n], R, p, onto[n])


@njit(cache=True)
def trouble(corners, counts, inner, shape, Rs, ps, supports, onto, steady, out):
    """Write by how many metres argument 0 is in another one, off the furniture (where it stands on
    that) or, against `steady` (s, 3), down in its own frame, about to tip.
    """
    for n in range(len(ps)):
        R, p, support = Rs[n], ps[n], supports[n]
        bad = 0.0
        for j in range(1, ps.shape[1]):
            if inner[shape[n, j], 3] == 0.0:
                bad += max(0.0, -0.001 - _gap(corners, counts, shape[n], R, p, j, False))

        if abs(onto[n] - support[0]) < 0.005:
            for axis in range(2):
                angle = support[1] + axis * 0.5 * math.pi
                x, y = math.cos(angle), math.sin(angle)
                away = abs(x * (p[0, 0] - support[2]) + y * (p[0, 1] - support[3]))
                bad += max(0.0, away - support[4 + axis] + 0.01)

        best = -1.0
        for s in range(len(steady)):
            down = 0.0
            for axis in range(3):
                down -= R[0, 2, axis] * steady[s, axis]
            best = max(best, down)
        if len(steady) > 0 and best < 0.97:
            bad += 0.1
        out[n] = bad
