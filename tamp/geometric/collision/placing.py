"""Places of a robot's parts, and how far each moves along an edge, in compiled code."""

from __future__ import annotations

import math

from tamp.geometric.collision.gjk import INLINE, JIT, centre
from tamp.geometric.collision.tables import FRAME, RADIUS, SLIDES_COLUMN
from tamp.system.compilation import njit


@njit(**INLINE)
def _compose(a, i, b, j, out, k):
    """Set row k of out to pose a[i] times pose b[j]."""
    for r in range(3):
        x, y, z = a[i, 3 * r], a[i, 3 * r + 1], a[i, 3 * r + 2]
        for c in range(3):
            out[k, 3 * r + c] = x * b[j, c] + y * b[j, 3 + c] + z * b[j, 6 + c]
        out[k, 9 + r] = x * b[j, 9] + y * b[j, 10] + z * b[j, 11] + a[i, 9 + r]


@njit(**JIT)
def place_frames(conf, joints, frames):
    """Compute forward kinematics: world poses of base (row 0), joints (1..n)."""
    c, s = math.cos(conf[2]), math.sin(conf[2])
    f = frames
    f[0, 0], f[0, 1], f[0, 2], f[0, 3], f[0, 4], f[0, 5] = c, -s, 0.0, s, c, 0.0
    f[0, 6], f[0, 7], f[0, 8], f[0, 9], f[0, 10], f[0, 11] = 0.0, 0.0, 1.0, conf[0], conf[1], 0.0
    for j in range(1, joints.shape[0] + 1):
        _compose(f, j - 1, joints, j - 1, f, j)
        if joints[j - 1, SLIDES_COLUMN] > 0.0:
            for r in range(3):
                f[j, 9 + r] += conf[2 + j] * f[j, 3 * r + 2]
            continue
        c, s = math.cos(conf[2 + j]), math.sin(conf[2 + j])
        for r in range(0, 9, 3):
            x, y = f[j, r], f[j, r + 1]
            f[j, r], f[j, r + 1] = c * x + s * y, c * y - s * x


@njit(**INLINE)
def place_part(i, frames, change, joints, parts, part_poses, placed, reach):
    """Place part i in the world; reach[i] gets its centre (0..2) and its motion per unit of edge.

    reach[i, 3 + k]: at most by joints 1..k, k = 0..n; then SPEED, BEND and TURN (see kernels.py);
    its last: at most with the base's motion too. `change` has magnitudes first, then signed
    changes.
    """
    frame = int(parts[i, FRAME])
    _compose(frames, frame, part_poses, i, placed, i)

    x, y, z = centre(parts, i, placed)
    reach[i, 0], reach[i, 1], reach[i, 2] = x, y, z
    radius = parts[i, RADIUS]
    last, size = reach.shape[1] - 1, len(change) // 2
    total = 0.0
    reach[i, 3] = 0.0
    # Of the centre's velocity, of the angular velocity, and of the bound of the acceleration.
    vx, vy, vz = change[size], change[size + 1], 0.0
    wx, wy, wz = 0.0, 0.0, change[size + 2]
    bend, turned = 0.0, change[2]
    if change[2] > 0.0:
        dx, dy = x - frames[0, 9], y - frames[0, 10]
        lever = change[2] * (math.sqrt(dx * dx + dy * dy) + radius)
        vx, vy = vx - wz * dy, vy + wz * dx
        bend = lever * change[2]
    for j in range(1, frame + 1):
        if change[2 + j] > 0.0 and joints[j - 1, SLIDES_COLUMN] > 0.0:
            step = change[size + 2 + j]
            vx, vy = vx + step * frames[j, 2], vy + step * frames[j, 5]
            vz += step * frames[j, 8]
            total += change[2 + j]
            bend += change[2 + j] * 2.0 * turned
        elif change[2 + j] > 0.0:
            ax, ay, az = frames[j, 2], frames[j, 5], frames[j, 8]
            dx, dy, dz = x - frames[j, 9], y - frames[j, 10], z - frames[j, 11]
            cx, cy, cz = ay * dz - az * dy, az * dx - ax * dz, ax * dy - ay * dx
            lever = change[2 + j] * (math.sqrt(cx * cx + cy * cy + cz * cz) + radius)
            total += lever
            step = change[size + 2 + j]
            vx, vy, vz = vx + step * cx, vy + step * cy, vz + step * cz
            wx, wy, wz = wx + step * ax, wy + step * ay, wz + step * az
            bend += lever * (2.0 * turned + change[2 + j])
            turned += change[2 + j]
        reach[i, 3 + j] = total
    if change[2] > 0.0:
        dx, dy = x - frames[0, 9], y - frames[0, 10]
        total += change[2] * (math.sqrt(dx * dx + dy * dy) + radius)
    speed = math.sqrt(vx * vx + vy * vy + vz * vz) + radius * math.sqrt(wx * wx + wy * wy + wz * wz)
    reach[i, last - 3], reach[i, last - 2], reach[i, last - 1] = speed, bend, turned
    reach[i, last] = total + change[0]
