"""Compiled measures of situations, in the order of `catalogue`."""

from __future__ import annotations

import math

import numpy as np

from tamp.system.compilation import njit

FAR = 10.0
"""Metres beside the line between two bodies that stand at one place."""


@njit(cache=True)
def span(corners, count, R, p, x, y, z):
    """Return the least and the largest coordinate of a body along a direction of the world."""
    a = R[0, 0] * x + R[1, 0] * y + R[2, 0] * z
    b = R[0, 1] * x + R[1, 1] * y + R[2, 1] * z
    c = R[0, 2] * x + R[1, 2] * y + R[2, 2] * z
    low, high = np.inf, -np.inf
    for v in range(count):
        at = a * corners[v, 0] + b * corners[v, 1] + c * corners[v, 2]
        low, high = min(low, at), max(high, at)
    origin = x * p[0] + y * p[1] + z * p[2]
    return origin + low, origin + high


@njit(cache=True)
def wrap(angle):
    """Return an angle in [-pi, pi)."""
    return (angle + math.pi) % (2 * math.pi) - math.pi


@njit(cache=True)
def heading(R):
    """Return the yaw of a body's x axis, or of its z axis where that one is upright, radians."""
    if abs(R[2, 0]) < 0.8:
        return math.atan2(R[1, 0], R[0, 0])
    return math.atan2(R[1, 2], R[0, 2])


@njit(cache=True)
def bearing(p, i, j):
    """Return the direction from argument i to argument j, radians."""
    return math.atan2(p[j, 1] - p[i, 1], p[j, 0] - p[i, 0])


@njit(cache=True)
def _heights(low, high, p, inner, shape, top, out, c):
    k = len(low)
    for level in range(3):
        at = low[0] if level == 0 else 0.5 * (low[0] + high[0]) if level == 1 else high[0]
        out[c], out[c + 1] = at - top, at
        c += 2
        for j in range(1, k):
            out[c] = at - low[j]
            out[c + 1] = at - 0.5 * (low[j] + high[j])
            out[c + 2] = at - high[j]
            floor = p[j, 2] + inner[shape[j], 2] if inner[shape[j], 3] > 0.0 else low[j]
            out[c + 3] = at - floor
            c += 4
    return c


@njit(cache=True)
def _ups(R, half, shape, out, c):
    for i in range(len(R)):
        longest, shortest = 0, 0
        most = 0.0
        for axis in range(3):
            up = min(1.0, max(-1.0, R[i, 2, axis]))
            out[c], out[c + 1] = math.acos(up), math.acos(abs(up))
            c += 2
            most = max(most, abs(up))
            if half[shape[i], axis] > half[shape[i], longest]:
                longest = axis
            if half[shape[i], axis] < half[shape[i], shortest]:
                shortest = axis
        out[c] = math.acos(most)
        out[c + 1] = math.acos(min(1.0, abs(R[i, 2, longest])))
        out[c + 2] = math.acos(min(1.0, abs(R[i, 2, shortest])))
        c += 3
    return c


@njit(cache=True)
def frames_of(R, p, yaw, out):
    """Write the angles of the frames of a situation: world, furniture, each other body, the line
    from 1 to 2.
    """
    k = len(R)
    out[0], out[1] = 0.0, yaw
    for j in range(1, k):
        out[1 + j] = heading(R[j])
    if k > 2:
        out[k + 1] = bearing(p, 1, 2)


@njit(cache=True)
def _turns(R, p, frames, out, c):
    k = len(R)
    own = heading(R[0])
    tilted = math.atan2(R[0, 1, 2], R[0, 0, 2])
    for f in range(len(frames) + k - 1):
        towards = f >= len(frames)
        reference = bearing(p, 0, f - len(frames) + 1) if towards else frames[f]
        out[c] = out[c + 1] = out[c + 2] = wrap(own - reference)
        c += 3
        if towards:
            out[c] = wrap(tilted - reference)
            c += 1
    return c


@njit(cache=True)
def _offsets(low, high, other_low, other_high, out, c):
    """Write the measures of an offset along one axis of a frame."""
    e, f = 0.5 * (high - low), 0.5 * (other_high - other_low)
    x = 0.5 * (low + high - other_low - other_high)
    out[c] = x
    out[c + 1], out[c + 2] = low - other_high, other_low - high
    out[c + 3], out[c + 4] = high - other_high, other_low - low
    out[c + 5] = x / max(f, 1e-3)
    out[c + 6], out[c + 7] = abs(x), abs(x) - e - f
    out[c + 8], out[c + 9] = abs(x) + e - f, abs(x) - f
    return c + 10


@njit(cache=True)
def _gap(corners, counts, shape, R, p, j, level):
    """Return the largest gap of argument 0 and j along candidate axes, negative where they
    overlap; `level`: along horizontal axes only.
    """
    best = -np.inf
    for which in range(18):
        if which < 6:
            body, axis = (0, which) if which < 3 else (j, which - 3)
            x, y, z = R[body, 0, axis], R[body, 1, axis], R[body, 2, axis]
        elif which == 6:
            x, y, z = p[0, 0] - p[j, 0], p[0, 1] - p[j, 1], 0.0
        elif which == 7:
            x, y, z = 0.0, 0.0, 1.0
        elif which == 8:
            x, y, z = p[0, 0] - p[j, 0], p[0, 1] - p[j, 1], p[0, 2] - p[j, 2]
        elif level:
            break
        else:
            m, n = (which - 9) // 3, (which - 9) % 3
            x = R[0, 1, m] * R[j, 2, n] - R[0, 2, m] * R[j, 1, n]
            y = R[0, 2, m] * R[j, 0, n] - R[0, 0, m] * R[j, 2, n]
            z = R[0, 0, m] * R[j, 1, n] - R[0, 1, m] * R[j, 0, n]

        if level:
            z = 0.0
        length = math.sqrt(x * x + y * y + z * z)
        if length < 1e-3:
            continue
        x, y, z = x / length, y / length, z / length
        a, b = span(corners[shape[0]], counts[shape[0]], R[0], p[0], x, y, z)
        e, f = span(corners[shape[j]], counts[shape[j]], R[j], p[j], x, y, z)
        best = max(best, a - f, e - b)
    return best


@njit(cache=True)
def _pair(corners, counts, half, inner, shape, R, p, top, yaw, low, frames, j, out, c):
    for f in range(len(frames)):
        out[c] = wrap(bearing(p, j, 0) - frames[f])
        c += 1
        room, within = np.inf, np.inf
        for axis in range(2):
            angle = frames[f] + axis * 0.5 * math.pi
            x, y = math.cos(angle), math.sin(angle)
            a, b = span(corners[shape[0]], counts[shape[0]], R[0], p[0], x, y, 0.0)
            d, e = span(corners[shape[j]], counts[shape[j]], R[j], p[j], x, y, 0.0)
            c = _offsets(a, b, d, e, out, c)
            middle = abs(0.5 * (a + b - d - e))
            wide = inner[shape[j], axis] if inner[shape[j], 3] > 0.0 else 0.5 * (e - d)
            room = min(room, wide - 0.5 * (b - a) - middle)
            within = min(within, 0.5 * (e - d) - middle)

        if f == 1 + j:
            out[c], out[c + 1] = room, within
            c += 2
    out[c] = math.hypot(p[0, 0] - p[j, 0], p[0, 1] - p[j, 1])
    out[c + 1] = _gap(corners, counts, shape, R, p, j, True)
    out[c + 2] = _gap(corners, counts, shape, R, p, j, False)
    out[c + 3] = low[j] - top
    out[c + 4] = wrap(heading(R[j]) - yaw)
    out[c + 5] = (
        math.log(
            max(half[shape[0], 0] * half[shape[0], 1] * half[shape[0], 2], 1e-9)
            / max(half[shape[j], 0] * half[shape[j], 1] * half[shape[j], 2], 1e-9)
        )
        / 3
    )
    return c + 6


@njit(cache=True)
def _line(p, out, c):
    """Write where argument 0 is on the line from 1 to 2."""
    x, y = p[2, 0] - p[1, 0], p[2, 1] - p[1, 1]
    length = max(math.hypot(x, y), 1e-6)
    u, v = p[0, 0] - p[1, 0], p[0, 1] - p[1, 1]
    share, off = (u * x + v * y) / length**2, (x * v - y * u) / length
    out[c], out[c + 1] = share, abs(share - 0.5)
    out[c + 2], out[c + 3] = off, abs(off)
    out[c + 4] = (abs(share - 0.5) - 0.5) * length
    out[c + 5] = abs(wrap(bearing(p, 0, 1) - bearing(p, 0, 2)))
    out[c + 6] = (share - 1.0) * length
    first, second = math.hypot(u, v), math.hypot(p[0, 0] - p[2, 0], p[0, 1] - p[2, 1])
    out[c + 7], out[c + 8], out[c + 9] = first - second, first - length, second - length
    return c + 10


@njit(cache=True)
def _furniture(corners, counts, shape, R, p, support, out, c):
    away = 0.0
    gaps = np.empty(2)
    for axis in range(2):
        angle = support[1] + axis * 0.5 * math.pi
        x, y = math.cos(angle), math.sin(angle)
        a, b = span(corners[shape[0]], counts[shape[0]], R[0], p[0], x, y, 0.0)
        origin = x * support[2] + y * support[3]
        side = support[4 + axis]
        middle = 0.5 * (a + b) - origin
        out[c], out[c + 1] = middle, abs(middle) - side
        out[c + 2], out[c + 3] = a - origin + side, origin + side - b
        gaps[axis] = min(a - origin + side, origin + side - b)
        away += middle * middle
        out[c + 4] = p[0, axis]
        c += 5
    out[c], out[c + 1], out[c + 2] = min(gaps[0], gaps[1]), gaps[0], gaps[1]
    out[c + 3], out[c + 4] = max(gaps[0], gaps[1]), math.sqrt(away)
    return c + 5


@njit(cache=True)
def measure_rows(corners, counts, half, inner, shapes, Rs, ps, supports, out):
    """Measure n situations into `out` (n, f), arrays as in `Situations`."""
    k = shapes.shape[1]
    low, high = np.empty(k), np.empty(k)
    frames = np.empty(k + 1 + (1 if k > 2 else 0))
    for n in range(len(shapes)):
        shape, R, p, support = shapes[n], Rs[n], ps[n], supports[n]
        for i in range(k):
            one = shape[i]
            low[i], high[i] = span(corners[one], counts[one], R[i], p[i], 0.0, 0.0, 1.0)
        frames_of(R, p, support[1], frames)

        row = out[n]
        c = _heights(low, high, p, inner, shape, support[0], row, 0)
        c = _ups(R, half, shape, row, c)
        c = _turns(R, p, frames, row, c)
        for j in range(1, k):
            c = _pair(
                corners, counts, half, inner, shape, R, p, support[0], support[1], low, frames, j,
                row, c,
            )  # fmt: skip
        if k > 2:
            c = _line(p, row, c)
        c = _furniture(corners, counts, shape, R, p, support, row, c)
