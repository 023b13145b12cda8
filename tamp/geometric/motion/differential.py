"""Paths of a base with differential drive: turns on the spot, and straight lines along its heading.

Every path is a sequence of stations in the plane; between two the base turns towards the next one,
or away from it and drives backwards, and drives straight. Each such motion is an edge of its own:
it rests between them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.motion.checker import EdgeTest
from tamp.geometric.motion.path import nearest, unwrap
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline

if TYPE_CHECKING:
    from jaxtyping import Float


YAW_COLUMNS = (2,)
"""Columns of a base configuration x, y, yaw that are angles."""

MAX_EDGE_M = 1.5
"""The longest edge of the trees, metres."""

SAME_STATION_M = 1e-9
"""Metres: stations nearer to each other than this are one."""

RETREATS_M = (0.3, 0.6)
"""Metres to back away straight from furniture before turning, and to come from before the goal."""


def turn_and_drive(
    start: Float[Array, " 3"], goal: Float[Array, " 3"], room: Room, edge_free: EdgeTest,
    rng: np.random.Generator, *, seed: int, checks: int, deadline: Deadline, tries: int,
) -> Float[Array, "n 3"] | None:  # fmt: skip
    """Search a path (n, 3) from start to goal, x, y, yaw, whose edges turn or drive straight.

    Args:
        start, goal: Free, as the caller knows.
        room: Where the base's centre may be.
        edge_free: Whether an edge is free.
        rng: The source of the shortcuts.
        seed: Of OMPL's generator.
        checks: Edges that RRTConnect may ask for.
        deadline: Outer cap on the time.
        tries: Shortcuts.
    """

    def legs(a: Array, b: Array) -> Array | None:
        """Return a free turn, drive and turn between two bases; forwards first, then backwards."""
        for way in ways(a, b):
            if all(edge_free(c, d) for c, d in pairwise(way)):
                return way
        return None

    for via in _vias(start, goal, room):
        if deadline.passed:
            return None
        found = _through([start, *via, goal], legs)
        if found is not None:
            return found

    from tamp.geometric.motion.sampling_based import PlaneSpace, connect

    plane = PlaneSpace(room.x, room.y)
    tree, _ = connect(
        plane, start, [goal], lambda a, b: legs(a, b) is not None, seed=seed, checks=checks,
        deadline=deadline, reach=MAX_EDGE_M,
    )  # fmt: skip
    if tree is None:
        return None
    stations = [start, *tree[1:-1], goal]
    for _ in range(tries):
        if len(stations) < 3 or deadline.passed:
            break
        first, last = sorted(rng.choice(len(stations), 2, replace=False).tolist())
        if last - first > 1 and legs(stations[first], stations[last]) is not None:
            stations = stations[: first + 1] + stations[last:]
    return _through(stations, legs)


def ways(a: Float[Array, " 3"], b: Float[Array, " 3"]) -> list[Float[Array, "k 3"]]:
    """List the ways from one base to another by turn, drive and turn: forwards and backwards, the
    one that turns less first; each shape (k, 3).
    """
    step = b[:2] - a[:2]
    if float(np.linalg.norm(step)) < SAME_STATION_M:
        return [_path([a, np.array([a[0], a[1], b[2]])])]
    heading = math.atan2(step[1], step[0])
    found: list[tuple[float, Array]] = []
    for yaw in (heading, heading + math.pi):
        turned, arrived = np.array([a[0], a[1], yaw]), np.array([b[0], b[1], yaw])
        path = _path([a, turned, arrived, b])
        found.append((float(np.abs(np.diff(path[:, 2])).sum()), path))
    found.sort(key=lambda pair: pair[0])
    return [path for _, path in found]


def _path(rows: list[Array]) -> Array:
    """Make a path of rows, the yaw unwrapped, without those that repeat."""
    path = unwrap(np.array(rows), YAW_COLUMNS)
    kept = [path[0]]
    for row in path[1:]:
        if np.abs(row - kept[-1]).max() > 1e-12:
            kept.append(row)
    return np.array(kept) if len(kept) > 1 else np.array([path[0], path[-1]])


def _vias(start: Array, goal: Array, room: Room) -> list[list[Array]]:
    """List stations between start and goal that a driver would think of: none; straight back from
    the start, or from before the goal; both.
    """
    out = [[], *([back] for back in _behind(start, room))]
    into = [[], *([back] for back in _behind(goal, room))]
    return [[*first, *last] for first in out for last in into]


def _behind(base: Array, room: Room) -> list[Array]:
    found: list[Array] = []
    for distance in RETREATS_M:
        x = base[0] - distance * math.cos(base[2])
        y = base[1] - distance * math.sin(base[2])
        if room.x[0] <= x <= room.x[1] and room.y[0] <= y <= room.y[1]:
            found.append(np.array([x, y, base[2]]))
    return found


def _through(stations: list[Array], legs: Callable[[Array, Array], Array | None]) -> Array | None:
    """Join the legs from station to station."""
    rows = [stations[0]]
    for station in stations[1:]:
        found = legs(rows[-1], nearest(rows[-1], station, YAW_COLUMNS))
        if found is None:
            return None
        rows += list(found[1:])
    return _path(rows)
