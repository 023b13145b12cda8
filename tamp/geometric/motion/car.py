"""Paths of a base that drives like a car: Reeds-Shepp curves, forwards and backwards.

A curve is sampled so closely that its chords are those of a car: its samples lie where the car
reverses, where it steers otherwise, and on its arcs.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.motion.checker import EdgeTest
from tamp.geometric.motion.differential import YAW_COLUMNS
from tamp.geometric.motion.path import inside, unwrap
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline

if TYPE_CHECKING:
    from jaxtyping import Float

CURVE_STEP_M = 0.05
"""The most between the samples of a curve, metres."""

CURVE_STEP_RAD = 0.03
"""The most that a car turns between the samples of a curve: their chord leads aside from its
heading by half of it."""

RETREATS_M = (0.3, 0.6, 1.0, 1.5)
"""Metres to back away straight from furniture before turning, and to come from before the goal."""

MAX_EDGE_M = 2.0
"""The longest edge of the trees, metres of its curve."""


def drive_curves(
    start: Float[Array, " 3"], goal: Float[Array, " 3"], room: Room, edge_free: EdgeTest, *,
    turning_radius: float, seed: int, checks: int, deadline: Deadline,
) -> Float[Array, "n 3"] | None:  # fmt: skip
    """Search a path (n, 3) from start to goal, x, y, yaw, of sampled Reeds-Shepp curves.

    The shortest curve comes first, then curves after backing away from the start, or to a place
    straight behind the goal, or both; then RRTConnect over curves, of whose vertices those are left
    out that a free curve leads past.

    Args:
        start, goal: Free, as the caller knows.
        room: Where the base's centre may be.
        edge_free: Whether an edge is free.
        turning_radius: Of the tightest circle, metres.
        seed: Of OMPL's generator.
        checks: Curves that RRTConnect may ask for.
        deadline: Outer cap on the time.
    """
    from tamp.geometric.motion.sampling_based import PlaneSpace, connect, curve

    plane = PlaneSpace(room.x, room.y, turning_radius)
    step = min(CURVE_STEP_M, CURVE_STEP_RAD * turning_radius)

    def free_curve(a: Array, b: Array) -> Array | None:
        samples = unwrap(curve(plane, a, b, step), YAW_COLUMNS)
        free = all(inside(room, base) for base in samples) and all(
            edge_free(c, d) for c, d in itertools.pairwise(samples)
        )
        return samples if free else None

    def through(stations: list[Array]) -> Array | None:
        pieces: list[Array] = []
        for a, b in itertools.pairwise(stations):
            piece = free_curve(a, b)
            if piece is None:
                return None
            pieces.append(piece if not pieces else piece[1:])
        return unwrap(np.concatenate(pieces), YAW_COLUMNS)

    out = [[], *([behind] for behind in _behind(start, room))]
    into = [[], *([behind] for behind in _behind(goal, room))]
    for first, last in itertools.product(out, into):
        if deadline.passed:
            return None
        found = through([start, *first, *last, goal])
        if found is not None:
            return found

    tree, _ = connect(
        plane, start, [goal], lambda a, b: free_curve(a, b) is not None, seed=seed, checks=checks,
        deadline=deadline, reach=MAX_EDGE_M,
    )  # fmt: skip
    if tree is None:
        return None
    remaining, vertices = [*tree[1:-1], goal], [start]
    while remaining:  # from each vertex jump as far ahead as a free curve leads
        ahead = range(len(remaining) - 1, 0, -1)
        jump = next((k for k in ahead if free_curve(vertices[-1], remaining[k]) is not None), 0)
        vertices.append(remaining[jump])
        remaining = remaining[jump + 1 :]
    return through(vertices)


def _behind(base: Array, room: Room) -> list[Array]:
    """List the places straight behind a base, within the room."""
    back = -np.array([math.cos(base[2]), math.sin(base[2]), 0.0])
    places = [base + distance * back for distance in RETREATS_M]
    return [place for place in places if inside(room, place)]
