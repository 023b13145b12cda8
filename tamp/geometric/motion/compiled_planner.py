"""RRT-Connect over the compiled collision kernel: no Python between two edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M, Arrangement
from tamp.geometric.scene.pose import Array
from tamp.system.deadline import Deadline

if TYPE_CHECKING:
    from jaxtyping import Float

EDGES_PER_TREES = 4000
"""Edges that one pair of trees may ask for, some 40 ms; then new ones are planted."""

TREE_CAPACITY = 2048
"""Configurations that a tree may have."""


@dataclass(frozen=True)
class Moving:
    """The coordinates of a configuration (3 + n,) that a planner moves.

    Attributes:
        first: The first of them; the others follow it.
        lower, upper: Their limits, shape (d,), metres and radians.
        weights: Of each in the length of an edge, shape (d,).
        periodic: Which coordinate of the configuration wraps, or -1.
    """

    first: int
    lower: Array
    upper: Array
    weights: Array
    periodic: int = -1


@dataclass(frozen=True)
class Shortening:
    """The effort of shortening a path: random cuts to try, up to so many refused in a row."""

    tries: int
    patience: int


def connect_compiled(
    arrangement: Arrangement,
    moving: Moving,
    start: Float[Array, " conf"],
    goals: Float[Array, "k conf"],
    *,
    seed: int,
    checks: int,
    deadline: Deadline,
    reach: float,
    domain: float,
    shortening: Shortening | None = None,
) -> tuple[Float[Array, "m conf"] | None, int]:
    """Search a path from `start` to any of `goals`, all known to be free and within the limits.

    The trees are planted anew, with another seed, where they became large. Deterministic, as long
    as the deadline does not cut the search, which it does between two plantings.

    Args:
        arrangement: The robot among the bodies.
        moving: The coordinates that may change; the others are alike in start and goals.
        start: Shape (3 + n,).
        goals: Shape (k, 3 + n).
        seed: Of all draws.
        checks: Edges to ask for in the search; shortening asks for a few more.
        deadline: Outer cap on the time.
        reach: The longest edge of the trees, in the weighted unit.
        domain: How far a sample may be from a configuration at which an edge was blocked, likewise.
        shortening: None leaves the trees' path as it is.

    Returns:
        The path (m, 3 + n), each edge of it found free by the kernel, from exactly `start` to
        exactly one of `goals` (up to whole turns of the coordinate that wraps); or None. And the
        number of edges asked for.
    """
    # Compiled with the first search, since most motions are straight lines.
    from tamp.geometric.motion.tree_kernel import connected

    tries, patience = (0, 0) if shortening is None else (shortening.tries, shortening.patience)
    asked, planting = 0, 0
    while asked < checks and not deadline.passed:
        path, more = connected(
            start, np.ascontiguousarray(goals), moving.lower, moving.upper, moving.first,
            moving.weights, moving.periodic, reach, domain, TRANSIT_CLEARANCE_M,
            min(EDGES_PER_TREES, checks - asked), TREE_CAPACITY, tries, patience, seed + planting,
            arrangement.packed,
        )  # fmt: skip
        if len(path):
            return path, asked + more
        # Where the trees ask for nothing more, all that is near them is blocked.
        asked, planting = asked + max(more, 1), planting + 2**32
    return None, asked
