"""A robot's motion against bodies and itself, decided in compiled code.

`check_edge` proves that a straight line in configuration space is free. It takes an interval of the
line, places the robot at its middle and asks of every pair (part, obstacle) whether its distance
there exceeds what the pair can lose within the interval; pairs that do are done with, the others go
on to the two halves. Middles are visited level by level, so that a blocked edge is rejected early.

How much a pair can lose: let T(s) p = E_1(s) ... E_n(s) p place a point p of a part, each E_j moved
by one coordinate (base x and y together, base yaw, joints). Swapping one factor at a time,
    T(s) p - T(m) p = sum_j E_1(s) ... E_(j-1)(s) [E_j(s) - E_j(m)] E_(j+1)(m) ... E_n(m) p,
so |T(s) p - T(m) p| <= sum_j |q_j(s) - q_j(m)| rho_j, with rho_j the distance of the point, placed
at the middle m, from axis j (1 for a translation), bounded by the part's bounding sphere. Steps may
have any length; for two parts of the robot only the joints between them count.

For a body that stands still there is a second bound, which is better in short intervals: with
p' = sum_j q_j' J_j at the middle and p'' = sum_j q_j' (2 sum_(i<j) q_i' a_i + q_j' a_j) x J_j (a_j
the axes of joints that turn, J_j = a_j x (p - o_j), or a_j of one that slides), by Taylor
    |T(s) p - T(m) p| <= h |p'| + h^2 / 2 max |p''|,
where |p'| is at most that of the sphere's centre and its radius times the angular velocity (SPEED),
and |J_j| in the interval at most rho_j + h times the first bound, so that |p''| <= BEND + h * first
bound * TURN^2, with BEND from the rho_j at the middle and TURN the sum of the |q_j'| that turn.

With distance d at the middle, half the interval's motion h and padding p, d >= max(p, h + p / 2)
proves that the pair stays p / 2 apart in the whole interval, and d < p rejects the edge: a pair
whose motion in the interval is below p is always decided.
"""

from __future__ import annotations

import math

from tamp.geometric.collision.gjk import (
    APART,
    BETWEEN,
    CLOSE,
    INLINE,
    JIT,
    in_frame,
    placed_at,
    separation,
    support,
    turned,
)
from tamp.geometric.collision.tables import (
    BOX,
    CENTRE,
    COVER_COUNT,
    COVER_ERROR,
    COVER_SPHERES,
    CYLINDER,
    FRAME,
    HULL,
    KIND,
    POINT,
    RADIUS,
    RADIUS_OFFSET,
    SIZE,
)
from tamp.system.compilation import njit

FREE, HIT, UNDECIDED = 0, 1, 2
FLOOR, ROOM, SELF = -1, -2, -3
"""What a part met: an obstacle's row (>= 0), the floor, the room's edge, or part k of the robot,
written SELF - k."""

INTERVALS, TASKS = 1024, 4096
"""Room for an edge's intervals and their undecided pairs; one that needs more is UNDECIDED."""


@njit(**INLINE)
def _from_core(shapes, i, poses, x, y, z):
    """Bound a world point's distance from part i from below: exact but for hulls (their box)."""
    lx, ly, lz = in_frame(poses, i, x, y, z)
    lx, ly, lz = lx - shapes[i, CENTRE], ly - shapes[i, CENTRE + 1], lz - shapes[i, CENTRE + 2]
    kind = shapes[i, KIND]
    if kind == POINT:
        return math.sqrt(lx * lx + ly * ly + lz * lz) - shapes[i, RADIUS_OFFSET]
    if kind == CYLINDER:
        ox = max(0.0, math.sqrt(lx * lx + ly * ly) - shapes[i, SIZE])
        oz = max(0.0, abs(lz) - shapes[i, SIZE + 2])
        return math.sqrt(ox * ox + oz * oz)
    ox = max(0.0, abs(lx) - shapes[i, SIZE])
    oy = max(0.0, abs(ly) - shapes[i, SIZE + 1])
    oz = max(0.0, abs(lz) - shapes[i, SIZE + 2])
    return math.sqrt(ox * ox + oy * oy + oz * oz)


@njit(**JIT)
def _away(shapes, i, poses, x, y, z, out):
    """Set `out` to the direction from part i's box (inside: its centre) to a world point."""
    lx, ly, lz = in_frame(poses, i, x, y, z)
    lx, ly, lz = lx - shapes[i, CENTRE], ly - shapes[i, CENTRE + 1], lz - shapes[i, CENTRE + 2]
    hx, hy, hz = shapes[i, SIZE], shapes[i, SIZE + 1], shapes[i, SIZE + 2]
    if abs(lx) > hx or abs(ly) > hy or abs(lz) > hz:
        lx -= min(hx, max(-hx, lx))
        ly -= min(hy, max(-hy, ly))
        lz -= min(hz, max(-hz, lz))
    out[0], out[1], out[2] = turned(poses, i, lx, ly, lz)


@njit(**INLINE)
def _leaf_centre(leaves, k, poses, i):
    return placed_at(poses, i, leaves[k, 0], leaves[k, 1], leaves[k, 2])


@njit(**INLINE)
def _from_obstacle(i, far, parts, placed, reach, obstacles, poses, j, leaves, guess):
    """Bound the distance of robot part i from obstacle j, by its bounding sphere, then its leaves.

    A leaf's centre is in the part and the leaf stands out by COVER_ERROR at most; the sphere
    smaller by that is inside: it gives the upper bound, unless the obstacle is a hull: its box
    stood for it.
    """
    x, y, z = reach[i, 0], reach[i, 1], reach[i, 2]
    bound = _from_core(obstacles, j, poses, x, y, z) - parts[i, RADIUS]
    if bound >= far:
        return bound, math.inf
    first, count = int(parts[i, COVER_SPHERES]), int(parts[i, COVER_COUNT])
    leaf_bound = math.inf
    for k in range(first, first + count):
        lx, ly, lz = _leaf_centre(leaves, k, placed, i)
        leaf = _from_core(obstacles, j, poses, lx, ly, lz) - leaves[k, 3]
        if leaf < leaf_bound:
            leaf_bound = leaf
            x, y, z = lx, ly, lz
    if count > 0:
        bound = max(bound, leaf_bound)
    if bound < far and guess[0] == 0.0 and guess[1] == 0.0 and guess[2] == 0.0:
        _away(obstacles, j, poses, x, y, z, guess)
    return bound, leaf_bound + parts[i, COVER_ERROR] if obstacles[j, KIND] != HULL else math.inf


@njit(**JIT)
def _leaf_distance(i, k, far, parts, placed, leaves, guess):
    """Bound the distance of parts i and k from below, at most `far`: leaves on leaves or box.

    `guess` gets the direction from k to i between the spheres that are nearest to each other.
    """
    best = far
    bx = by = bz = 0.0
    first_k, count_k = int(parts[k, COVER_SPHERES]), int(parts[k, COVER_COUNT])
    hx, hy, hz = parts[k, SIZE], parts[k, SIZE + 1], parts[k, SIZE + 2]
    cx, cy, cz = parts[k, CENTRE], parts[k, CENTRE + 1], parts[k, CENTRE + 2]

    for m in range(
        int(parts[i, COVER_SPHERES]), int(parts[i, COVER_SPHERES]) + int(parts[i, COVER_COUNT])
    ):
        x, y, z = _leaf_centre(leaves, m, placed, i)
        radius = leaves[m, 3]
        lx, ly, lz = in_frame(placed, k, x, y, z)
        ox = lx - cx - min(hx, max(-hx, lx - cx))
        oy = ly - cy - min(hy, max(-hy, ly - cy))
        oz = lz - cz - min(hz, max(-hz, lz - cz))
        limit = best + radius
        square = ox * ox + oy * oy + oz * oz
        if limit <= 0.0 or square >= limit * limit:
            continue
        if count_k == 0:
            best = math.sqrt(square) - radius
            bx, by, bz = ox, oy, oz
        for n in range(first_k, first_k + count_k):
            dx, dy, dz = lx - leaves[n, 0], ly - leaves[n, 1], lz - leaves[n, 2]
            limit = best + radius + leaves[n, 3]
            square = dx * dx + dy * dy + dz * dz
            if limit > 0.0 and square < limit * limit:
                best = math.sqrt(square) - radius - leaves[n, 3]
                bx, by, bz = dx, dy, dz

    guess[0], guess[1], guess[2] = turned(placed, k, bx, by, bz)
    return best


@njit(**INLINE)
def _from_self(i, k, far, parts, placed, reach, leaves, guess):
    """Bound the distance between robot parts i and k: spheres against boxes, then leaves."""
    bound = _from_core(parts, i, placed, reach[k, 0], reach[k, 1], reach[k, 2]) - parts[k, RADIUS]
    if bound >= far:
        return bound, math.inf
    bound = max(
        bound,
        _from_core(parts, k, placed, reach[i, 0], reach[i, 1], reach[i, 2]) - parts[i, RADIUS],
    )
    if bound >= far or guess[0] != 0.0 or guess[1] != 0.0 or guess[2] != 0.0:
        return bound, math.inf

    guess[0], guess[1], guess[2] = (
        reach[i, 0] - reach[k, 0], reach[i, 1] - reach[k, 1], reach[i, 2] - reach[k, 2],
    )  # fmt: skip
    swapped = parts[i, COVER_COUNT] == 0
    a, b = (k, i) if swapped else (i, k)
    if parts[a, COVER_COUNT] == 0:
        return bound, math.inf
    leaf_bound = _leaf_distance(a, b, far, parts, placed, leaves, guess)
    if swapped:
        guess[0], guess[1], guess[2] = -guess[0], -guess[1], -guess[2]
    inner = leaf_bound + parts[a, COVER_ERROR]
    if parts[b, COVER_COUNT] > 0:
        inner += parts[b, COVER_ERROR]
    elif parts[b, KIND] != BOX:
        inner = math.inf  # the leaves of a were held against the box around b
    return max(bound, leaf_bound), inner


@njit(**INLINE)
def _from_floor(i, parts, placed, vertices):
    """Return the height of the lowest point of robot part i above the plane z = 0; exact."""
    _, _, z = support(parts, i, placed, vertices, 0.0, 0.0, -1.0)
    return z - parts[i, RADIUS_OFFSET]


@njit(**JIT)
def check(
    i, other, near, far, parts, placed, reach, obstacles, obstacle_poses, vertices, leaves, guess,
    s, weights,
):  # fmt: skip
    """Decide a pair as `separation` does, from its spheres when they suffice.

    `guess`: (0, 0, 0) or where a check of this pair nearby ended, a direction; it gets this one's.
    """
    if other == FLOOR:
        height = _from_floor(i, parts, placed, vertices)
        return APART if height >= far else (CLOSE if height < near else BETWEEN)
    if other >= 0:
        j, b, poses = other, obstacles, obstacle_poses
        bound, inner = _from_obstacle(i, far, parts, placed, reach, b, poses, j, leaves, guess)
        slack = parts[i, COVER_ERROR]
    else:
        j, b, poses = SELF - other, parts, placed
        bound, inner = _from_self(i, j, far, parts, placed, reach, leaves, guess)
        slack = parts[i, COVER_ERROR] + parts[j, COVER_ERROR]

    if bound >= far:
        return APART
    if inner < near:
        return CLOSE
    if bound >= near and bound + slack < far:
        return BETWEEN  # the exact distance would hardly help
    return separation(parts, i, placed, b, j, poses, vertices, near, far, guess, s, weights)


@njit(**INLINE)
def required_clearance(i, other, half, padding, parts, reach):
    """Return the distance that (i, other) needs amid an interval of half length `half`."""
    if other <= SELF:
        k = SELF - other
        a, b = (i, k) if parts[i, FRAME] <= parts[k, FRAME] else (k, i)
        low, high = int(parts[a, FRAME]), int(parts[b, FRAME])
        motion = reach[b, 3 + high] - reach[b, 3 + low]
    else:
        last = reach.shape[1] - 1
        motion, turn = reach[i, last], reach[i, last - 1]
        bend = reach[i, last - 2] + half * motion * turn * turn
        motion = min(motion, reach[i, last - 3] + 0.5 * half * bend)
    return max(padding, half * motion + 0.5 * padding)


@njit(**INLINE)
def spheres_apart(i, k, far, parts, reach):
    """Check whether the bounding spheres of robot parts i and k are at least `far` apart."""
    dx, dy, dz = reach[i, 0] - reach[k, 0], reach[i, 1] - reach[k, 1], reach[i, 2] - reach[k, 2]
    limit = far + parts[i, RADIUS] + parts[k, RADIUS]
    return dx * dx + dy * dy + dz * dz >= limit * limit
