"""The robot against one arrangement of bodies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.edge_check import check_edge, pair_of
from tamp.geometric.collision.fcl_pairs import ExactPairs
from tamp.geometric.collision.kernels import FLOOR, FREE, SELF, UNDECIDED
from tamp.geometric.collision.tables import CENTRE, FRAME, ON_FLOOR, RADIUS, Tables
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

TRANSIT_CLEARANCE_M = 0.002
"""Metres: a transit state is free only when everything is at least this far from everything else.
"""

_TIGHT_PADDING_M = 2e-4
"""The padding with which the kernel proves pieces of tight motions free; below the contact gap."""

_TOUCHING_PADDING_M = 1e-6
"""Metres that count as touching: the kernel's verdicts need some padding."""

_MAX_HALVINGS = 12
"""How often an edge that the kernel left undecided is halved before it counts as blocked."""


@dataclass
class Statistics:
    """Counts of an arrangement's work.

    Attributes:
        states, edges: Questions asked of `free` and `edge_free`.
        states_undecided, edges_undecided: Those that one call of compiled code did not answer.
        exact: Pairs that FCL decided.
    """

    states: int = 0
    edges: int = 0
    states_undecided: int = 0
    edges_undecided: int = 0
    exact: int = 0

    @property
    def states_decided(self) -> int:
        """Count the states that one call of compiled code decided."""
        return self.states - self.states_undecided

    @property
    def edges_decided(self) -> int:
        """Count the edges that one call of compiled code decided."""
        return self.edges - self.edges_undecided


class Arrangement:
    """Answers whether configurations and motions of the robot collide. Made by
    `Collisions.arrangement`.

    Checked are the robot against itself and the bodies, the attached body against both, all but the
    base and the arm's foot against the floor, and the base's centre against the room.
    Configurations are float arrays (3 + n,).

    Args:
        tables: What the kernels read.
        exact: FCL on the same parts.

    Attributes:
        packed: The tables as one vector, as compiled code takes them.
    """

    def __init__(self, tables: Tables, exact: ExactPairs) -> None:
        self.tables = tables
        self.packed = tables.packed()
        self.stats = Statistics()
        self._exact = exact

    def free(self, conf: Float[Array, " conf"]) -> bool:
        """Check whether everything is at least TRANSIT_CLEARANCE_M apart at `conf`."""
        self.stats.states += 1
        try:
            code = check_edge(conf, conf, TRANSIT_CLEARANCE_M, self.packed) & 3
        except TypeError:
            # A list, or not in C order; converting always would cost a tenth of the check.
            conf = np.ascontiguousarray(conf, dtype=np.float64)
            code = check_edge(conf, conf, TRANSIT_CLEARANCE_M, self.packed) & 3
        if code != UNDECIDED:
            return code == FREE
        self.stats.states_undecided += 1
        return self._scan(conf, TRANSIT_CLEARANCE_M) is None

    def edge_free(self, start: Float[Array, " conf"], end: Float[Array, " conf"]) -> bool:
        """Check whether the straight line between two configurations is free of collision. Yaw
        turns the way that the numbers go.

        True is a proof: both ends are `free`, and in every state between, checked or not,
        everything is at least TRANSIT_CLEARANCE_M / 2 apart.
        """
        start = np.ascontiguousarray(start, dtype=np.float64)
        end = np.ascontiguousarray(end, dtype=np.float64)
        self.stats.edges += 1
        code = check_edge(start, end, TRANSIT_CLEARANCE_M, self.packed) & 3
        if code != UNDECIDED:
            return code == FREE
        self.stats.edges_undecided += 1
        return self._halves_free(start, end, _MAX_HALVINGS)

    def _halves_free(self, start: Array, end: Array, depth: int) -> bool:
        middle = 0.5 * (start + end)
        if depth == 0 or not self.free(middle):
            return False
        for a, b in ((start, middle), (middle, end)):
            code = check_edge(a, b, TRANSIT_CLEARANCE_M, self.packed) & 3
            if code != FREE and (code != UNDECIDED or not self._halves_free(a, b, depth - 1)):
                return False
        return True

    def hits(self, conf: Float[Array, " conf"], padding: float = 0.0) -> tuple[str, str] | None:
        """Return the names of a colliding pair, nearer than `padding` metres (with 0: that
        intersects or touches); None when free.

        The first name is a link's or the attached body's, the second another such, a body's,
        "floor" or "room".
        """
        conf = np.ascontiguousarray(conf, dtype=np.float64)
        answer = check_edge(conf, conf, max(padding, _TOUCHING_PADDING_M), self.packed)
        code = answer & 3
        if code == UNDECIDED:
            return self._scan(conf, padding)
        return None if code == FREE else self._exact.names(*pair_of(answer))

    def path_hits(
        self, path: Float[Array, "n conf"], step: float = 0.002, padding: float = 0.0
    ) -> tuple[str, str] | None:
        """Return the `hits` along the polyline `path` (m, 3 + n), in states between which no
        point of the robot moves more than `step` metres; pieces that the kernel proves free are not
        sampled.
        """
        path = np.ascontiguousarray(path, dtype=np.float64)
        if len(path) == 1:
            return self.hits(path[0], padding)
        for start, end in pairwise(path):
            if check_edge(start, end, max(2 * padding, _TIGHT_PADDING_M), self.packed) & 3 == FREE:
                continue
            count = max(1, math.ceil(self.motion_bound(start[None], end[None])[0] / step))
            for k in range(count + 1):
                names = self.hits(start + (end - start) * (k / count), padding)
                if names is not None:
                    return names
        return None

    def motion_bound(
        self, start: Float[Array, "n conf"], end: Float[Array, "n conf"]
    ) -> Float[Array, " n"]:
        """Bound how far any point of the robot moves between configurations, (n,), metres."""
        change = np.abs(end - start)
        return np.hypot(change[:, 0], change[:, 1]) + change[:, 2:] @ self._levers

    @cached_property
    def _levers(self) -> Array:
        """Bound how far a turn of the yaw, then of each joint, moves any point, (1 + n,), metres a
        radian.
        """
        tables = self.tables
        parts = tables.parts[tables.parts[:, FRAME] > 0]
        offsets = np.linalg.norm(tables.part_poses[tables.parts[:, FRAME] > 0, 9:], axis=1)
        tip = offsets + np.linalg.norm(parts[:, CENTRE : CENTRE + 3], axis=1) + parts[:, RADIUS]
        lengths = np.linalg.norm(tables.joints[:, 9:], axis=1)
        return np.append(np.cumsum(lengths[::-1])[::-1], 0.0) + tip.max()

    def _scan(self, conf: Array, padding: float) -> tuple[str, str] | None:
        """Check all pairs by FCL."""
        tables = self.tables
        for part in range(len(tables.parts)):
            for other in (FLOOR, *range(len(tables.obstacles))):
                if other == FLOOR and tables.parts[part, ON_FLOOR]:
                    continue
                if self._nearer(conf, part, other, padding):
                    return self._exact.names(part, other)
        for part, other in tables.pairs:
            if self._nearer(conf, int(part), SELF - int(other), padding):
                return self._exact.names(int(part), SELF - int(other))
        return None

    def _nearer(self, conf: Array, part: int, other: int, padding: float) -> bool:
        self.stats.exact += 1
        return self._exact.nearer(conf, part, other, padding)
