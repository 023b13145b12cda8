"""Distance queries between convex parts, compiled.

`separation` is the Gilbert-Johnson-Keerthi algorithm (1988) on the Minkowski difference A - B. It
answers not with a distance but with a decision, and each decision carries its own proof: "apart"
rests on a separating plane, whose gap is computed from the two support functions alone (a lower
bound of the distance whatever the simplex looked like), "close" rests on two points of A and B (an
upper bound).
"""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.collision.tables import (
    BOX,
    CENTRE,
    CYLINDER,
    KIND,
    POINT,
    RADIUS_OFFSET,
    SIZE,
    VERTEX_COUNT,
    VERTICES,
)
from tamp.system.compilation import njit

APART, CLOSE, BETWEEN, UNSURE = 0, 1, 2, 3
"""At least `far` apart; nearer than `near`; certainly between the two; rounding keeps it from
saying."""

JIT = {
    "nogil": True,
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "no_rewrites": True,
    "_nrt": False,
}
"""For functions that only compiled code calls. They are not cached on their own: `check_edge` is,
with them inside.

They allocate nothing, so that nothing has to be counted (`_nrt`), and have no array expression to
rewrite: both would only take time when they are compiled.
"""

INLINE = {**JIT, "forceinline": True}
"""For the small ones among them: a call passes each array as nine numbers."""


@njit(**INLINE, fastmath={"nnan", "nsz", "reassoc", "contract"})
def _farthest(vertices, first, last, x, y, z):
    """Find the column first..last-1 of `vertices` farthest along (x, y, z), up to rounding.

    Two passes, so that both compile to vector instructions; fast mathematics only reorders the
    maximum here.
    """
    value = -1e300
    for k in range(first, last):
        value = max(value, vertices[0, k] * x + vertices[1, k] * y + vertices[2, k] * z)
    value -= 1e-12
    for k in range(first, last):
        if vertices[0, k] * x + vertices[1, k] * y + vertices[2, k] * z >= value:
            return k
    return first


@njit(**INLINE)
def turned(poses, i, x, y, z):
    """Rotate a direction of frame i into the world's frame."""
    return (
        poses[i, 0] * x + poses[i, 1] * y + poses[i, 2] * z,
        poses[i, 3] * x + poses[i, 4] * y + poses[i, 5] * z,
        poses[i, 6] * x + poses[i, 7] * y + poses[i, 8] * z,
    )


@njit(**INLINE)
def turned_back(poses, i, x, y, z):
    """Rotate a direction of the world's frame into frame i."""
    return (
        poses[i, 0] * x + poses[i, 3] * y + poses[i, 6] * z,
        poses[i, 1] * x + poses[i, 4] * y + poses[i, 7] * z,
        poses[i, 2] * x + poses[i, 5] * y + poses[i, 8] * z,
    )


@njit(**INLINE)
def placed_at(poses, i, x, y, z):
    """Transform a point of frame i into the world's frame."""
    x, y, z = turned(poses, i, x, y, z)
    return x + poses[i, 9], y + poses[i, 10], z + poses[i, 11]


@njit(**INLINE)
def in_frame(poses, i, x, y, z):
    """Transform a point of the world's frame into frame i."""
    return turned_back(poses, i, x - poses[i, 9], y - poses[i, 10], z - poses[i, 11])


@njit(**JIT)
def support(shapes, i, poses, vertices, dx, dy, dz):
    """Return the support point of part i's core, farthest along (dx, dy, dz), in the world."""
    x, y, z = turned_back(poses, i, dx, dy, dz)
    kind = shapes[i, KIND]
    if kind == POINT:
        return poses[i, 9], poses[i, 10], poses[i, 11]
    if kind == BOX:
        px = math.copysign(shapes[i, SIZE], x)
        py = math.copysign(shapes[i, SIZE + 1], y)
        pz = math.copysign(shapes[i, SIZE + 2], z)
    elif kind == CYLINDER:
        radial = math.sqrt(x * x + y * y)
        scale = shapes[i, SIZE] / radial if radial > 1e-12 else 0.0
        px, py, pz = x * scale, y * scale, math.copysign(shapes[i, SIZE + 2], z)
    else:
        first = int(shapes[i, VERTICES])
        k = _farthest(vertices, first, first + int(shapes[i, VERTEX_COUNT]), x, y, z)
        px, py, pz = vertices[0, k], vertices[1, k], vertices[2, k]
    return placed_at(poses, i, px, py, pz)


@njit(**INLINE)
def centre(shapes, i, poses):
    """Return the world position of the centre of part i's box."""
    return placed_at(poses, i, shapes[i, CENTRE], shapes[i, CENTRE + 1], shapes[i, CENTRE + 2])


@njit(**INLINE)
def _dot(s, i, j):
    return s[i, 0] * s[j, 0] + s[i, 1] * s[j, 1] + s[i, 2] * s[j, 2]


@njit(**INLINE)
def _on_segment(s, i, j):
    """Weigh rows i, j of s at the point of their segment that is nearest to the origin."""
    aa, ab, bb = _dot(s, i, i), _dot(s, i, j), _dot(s, j, j)
    length = aa - 2.0 * ab + bb
    if length <= 0.0:
        return 1.0, 0.0
    t = min(1.0, max(0.0, (aa - ab) / length))
    return 1.0 - t, t


@njit(**JIT)
def _on_triangle(s, i, j, k):
    """Weigh rows i, j, k of s where their triangle is nearest the origin (Ericson 2005, 5.1.5)."""
    ix, iy, iz = s[i, 0], s[i, 1], s[i, 2]
    jx, jy, jz = s[j, 0], s[j, 1], s[j, 2]
    kx, ky, kz = s[k, 0], s[k, 1], s[k, 2]
    abx, aby, abz = jx - ix, jy - iy, jz - iz
    acx, acy, acz = kx - ix, ky - iy, kz - iz

    d1 = -(abx * ix + aby * iy + abz * iz)
    d2 = -(acx * ix + acy * iy + acz * iz)
    if d1 <= 0.0 and d2 <= 0.0:
        return 1.0, 0.0, 0.0
    d3 = -(abx * jx + aby * jy + abz * jz)
    d4 = -(acx * jx + acy * jy + acz * jz)
    if d3 >= 0.0 and d4 <= d3:
        return 0.0, 1.0, 0.0
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        a, b = _on_segment(s, i, j)
        return a, b, 0.0
    d5 = -(abx * kx + aby * ky + abz * kz)
    d6 = -(acx * kx + acy * ky + acz * kz)
    if d6 >= 0.0 and d5 <= d6:
        return 0.0, 0.0, 1.0
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        a, b = _on_segment(s, i, k)
        return a, 0.0, b
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        a, b = _on_segment(s, j, k)
        return 0.0, a, b

    total = va + vb + vc
    if total <= 0.0:
        a, b = _on_segment(s, i, j)
        return a, b, 0.0
    return va / total, vb / total, vc / total


@njit(**JIT)
def _outside(s, i, j, k, other):
    """Check whether the origin is beyond face i, j, k, seen from `other`; true too when flat."""
    ix, iy, iz = s[i, 0], s[i, 1], s[i, 2]
    jx, jy, jz = s[j, 0], s[j, 1], s[j, 2]
    kx, ky, kz = s[k, 0], s[k, 1], s[k, 2]
    abx, aby, abz = jx - ix, jy - iy, jz - iz
    acx, acy, acz = kx - ix, ky - iy, kz - iz
    nx, ny, nz = aby * acz - abz * acy, abz * acx - abx * acz, abx * acy - aby * acx
    origin = -(nx * ix + ny * iy + nz * iz)
    apex = nx * (s[other, 0] - ix) + ny * (s[other, 1] - iy) + nz * (s[other, 2] - iz)
    flat = 1e-9 * math.sqrt(nx * nx + ny * ny + nz * nz)
    return abs(apex) <= flat or origin * apex < 0.0


@njit(**JIT)
def _reduce(s, n, weights):
    """Find the nearest point of the simplex s[:n] to the origin; keep only the rows that carry it.

    Returns:
        The number of rows left, weights in `weights`; 5 when the origin is inside a tetrahedron.
    """
    weights[0], weights[1], weights[2], weights[3] = 1.0, 0.0, 0.0, 0.0
    if n == 2:
        weights[0], weights[1] = _on_segment(s, np.int64(0), np.int64(1))
    elif n == 3:
        weights[0], weights[1], weights[2] = _on_triangle(s, np.int64(0), np.int64(1), np.int64(2))
    elif n == 4:
        best = math.inf
        b0, b1, b2, b3 = 0.0, 0.0, 0.0, 0.0
        for left_out in range(4):
            i, j, k = (left_out + 1) % 4, (left_out + 2) % 4, (left_out + 3) % 4
            if not _outside(s, i, j, k, left_out):
                continue
            weights[left_out] = 0.0
            weights[i], weights[j], weights[k] = _on_triangle(s, i, j, k)
            x = y = z = 0.0
            for row in range(4):
                x += weights[row] * s[row, 0]
                y += weights[row] * s[row, 1]
                z += weights[row] * s[row, 2]
            square = x * x + y * y + z * z
            if square < best:
                best = square
                b0, b1, b2, b3 = weights[0], weights[1], weights[2], weights[3]
        if best == math.inf:
            return 5
        weights[0], weights[1], weights[2], weights[3] = b0, b1, b2, b3

    left = 0
    for i in range(n):
        if weights[i] > 0.0:
            weights[left] = weights[i]
            s[left, 0], s[left, 1], s[left, 2] = s[i, 0], s[i, 1], s[i, 2]
            left += 1
    return left


@njit(**JIT)
def separation(a, i, poses_a, b, j, poses_b, vertices, near, far, guess, s, weights):
    """Decide how far part i of table a is from part j of table b.

    Args:
        a, poses_a: Rows and world poses of the one; b, poses_b of the other.
        vertices: All hulls' vertices.
        near, far: Distances to decide between, metres, 0 < near <= far.
        guess: (3,) a direction from b to a to try first; overwritten with the best one found.
        s, weights: Scratch (4, 3) and (4,).

    Returns:
        APART: the distance is >= far. CLOSE: < near. BETWEEN: >= near, surely < far. Or UNSURE.
    """
    margin = a[i, RADIUS_OFFSET] + b[j, RADIUS_OFFSET]
    near, far = near + margin, far + margin
    vx, vy, vz = guess[0], guess[1], guess[2]
    norm = math.sqrt(vx * vx + vy * vy + vz * vz)
    if norm < 1e-9:
        vx, vy, vz, norm = 0.0, 0.0, 1.0, 1.0

    n, lower, upper = 0, -math.inf, math.inf
    for _ in range(64):
        ax, ay, az = support(a, i, poses_a, vertices, -vx, -vy, -vz)
        bx, by, bz = support(b, j, poses_b, vertices, vx, vy, vz)
        wx, wy, wz = ax - bx, ay - by, az - bz
        gap = (vx * wx + vy * wy + vz * wz) / norm
        if gap > lower:
            lower = gap
            guess[0], guess[1], guess[2] = vx, vy, vz
            if lower >= far:
                return APART
            if lower >= near and upper < far:
                return BETWEEN
        if upper - lower <= 1e-9:
            break

        s[n, 0], s[n, 1], s[n, 2] = wx, wy, wz
        n = _reduce(s, n + 1, weights)
        if n == 5:
            return CLOSE
        vx = vy = vz = 0.0
        for k in range(n):
            vx += weights[k] * s[k, 0]
            vy += weights[k] * s[k, 1]
            vz += weights[k] * s[k, 2]
        norm = math.sqrt(vx * vx + vy * vy + vz * vz)
        if norm < near:
            return CLOSE
        if norm >= upper:  # no more progress: rounding
            break
        upper = norm
        if lower >= near and upper < far:
            return BETWEEN

    return BETWEEN if near <= lower and upper < far else UNSURE
