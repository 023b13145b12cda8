"""The loops of RRT-Connect in compiled code: two trees that grow towards each other.

Kuffner and LaValle, "RRT-Connect: An efficient approach to single-query path planning", ICRA 2000;
with a dynamic domain (Yershova, Jaillet, Simeon and LaValle, "Dynamic-domain RRTs", ICRA 2005): a
configuration at which an edge was blocked is extended no more towards samples far from it. It is
always the smaller tree that is extended.

Only the coordinates first..first+d-1 of a configuration move, of which `periodic` (or none, -1)
wraps.
"""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.collision.edge_decision import decide
from tamp.geometric.collision.gjk import INLINE, JIT
from tamp.geometric.collision.kernels import FREE
from tamp.system.compilation import njit

FULL_TURN_RAD = 2.0 * math.pi

DRAWS_PER_EDGE = 100
"""Samples to draw for each edge that may be asked for: most may be outside of the domain."""


@njit(**INLINE)
def uniform(state):
    """Draw a number in [0, 1) and advance the state (1,) of the generator.

    SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
    """
    state[0] += np.uint64(0x9E3779B97F4A7C15)
    z = state[0]
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z = z ^ (z >> np.uint64(31))
    return float(z >> np.uint64(11)) / 9007199254740992.0


@njit(**INLINE)
def _way(start, end, k, periodic):
    """Compute how far coordinate k goes from one to the other, the shorter way round."""
    gap = end[k] - start[k]
    if k == periodic:
        gap -= FULL_TURN_RAD * np.rint(gap / FULL_TURN_RAD)
    return gap


@njit(**INLINE)
def write(conf, rows, row):
    """Copy a configuration into a row."""
    for k in range(len(conf)):
        rows[row, k] = conf[k]


@njit(**JIT)
def _nearest(tree, count, sample, first, weights, periodic):
    """Find which of the first `count` rows is nearest to the sample, and its distance."""
    best, row = math.inf, 0
    for i in range(count):
        square = 0.0
        for k in range(len(weights)):
            gap = weights[k] * _way(tree[i], sample, first + k, periodic)
            square += gap * gap
        if square < best:
            best, row = square, i
    return row, math.sqrt(best)


@njit(**INLINE)
def _steer(start, goal, distance, reach, first, count, periodic, tip):
    """Go from `start` at most `reach` towards `goal`, `distance` away; say if it is met."""
    share = reach / distance if distance > reach else 1.0
    write(start, tip, 0)
    for k in range(first, first + count):
        # Exactly the goal's numbers where it is met, but for whole turns.
        met = share == 1.0 and k != periodic
        tip[0, k] = goal[k] if met else start[k] + share * _way(start, goal, k, periodic)
    return share == 1.0


@njit(**INLINE)
def _append(trees, parents, domains, counts, a, parent, conf):
    """Append a configuration to tree a."""
    row = counts[a]
    write(conf, trees[a], row)
    parents[a, row], domains[a, row] = parent, math.inf
    counts[a] += 1


@njit(**JIT)
def grow(
    trees, parents, domains, counts, lower, upper, first, weights, periodic, reach, domain,
    padding, most, state, room, geometry, work, sample, tip,
):  # fmt: skip
    """Grow two trees until they meet.

    Args:
        trees: (2, rows, conf), each with its roots.
        parents: (2, rows), -1 for a root.
        domains: (2, rows), how far from each a sample may be.
        counts: (2,) rows in use.
        lower, upper: (d,) between which the coordinates that move are drawn.
        weights: (d,) of these coordinates in the distance.
        reach: The longest edge, in that distance.
        domain: How far from where an edge was blocked a sample may be, in that distance.
        padding: As in `decide`.
        most: Edges to ask for.
        state: Of the generator.
        sample, tip: (1, conf) scratch; what does not move is in it already.

    Returns:
        The rows of both trees between which the last edge is free, or -1 twice; and the number of
        edges asked for.
    """
    asked, rows, size = 0, trees.shape[1], len(weights)
    for _ in range(DRAWS_PER_EDGE * most):
        if asked >= most or counts[0] >= rows or counts[1] >= rows:
            break
        for k in range(size):
            sample[0, first + k] = lower[k] + uniform(state) * (upper[k] - lower[k])
        a = 0 if counts[0] < counts[1] or (counts[0] == counts[1] and uniform(state) < 0.5) else 1
        b = 1 - a
        row, distance = _nearest(trees[a], counts[a], sample[0], first, weights, periodic)
        if distance > domains[a, row]:
            continue
        _steer(trees[a, row], sample[0], distance, reach, first, size, periodic, tip)
        asked += 1
        if decide(trees[a, row], tip[0], padding, True, room, geometry, work) != FREE:
            domains[a, row] = domain
            continue
        _append(trees, parents, domains, counts, a, row, tip[0])
        added = counts[a] - 1

        row, distance = _nearest(trees[b], counts[b], trees[a, added], first, weights, periodic)
        while counts[b] < rows:
            met = _steer(
                trees[b, row], trees[a, added], distance, reach, first, size, periodic, tip
            )  # fmt: skip
            asked += 1
            if decide(trees[b, row], tip[0], padding, True, room, geometry, work) != FREE:
                break
            if met:
                return (added, row, asked) if a == 0 else (row, added, asked)
            _append(trees, parents, domains, counts, b, row, tip[0])
            row, distance = counts[b] - 1, distance - reach
    return -1, -1, asked


@njit(**JIT)
def trace(trees, parents, met_first, met_second, path):
    """Write the way between the roots of both trees into `path`; return its number of rows."""
    count, row = 0, met_first
    while row >= 0:
        count += 1
        row = parents[0, row]

    row, place = met_first, count - 1
    while row >= 0:
        write(trees[0, row], path, place)
        row, place = parents[0, row], place - 1

    row = met_second
    while row >= 0:
        write(trees[1, row], path, count)
        row, count = parents[1, row], count + 1
    return count
