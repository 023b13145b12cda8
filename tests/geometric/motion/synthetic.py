"""Checkers with obstacles given by formulas, for planning without a robot model."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tamp.geometric.scene.pose import Array


class Sampled:
    """A checker whose edges are decided by fine sampling; obstacles are a function of the configuration (10,).

    Attributes:
        edges: How many edges were asked for.
    """

    def __init__(self, collides: Callable[[Array], bool], step: float = 0.01) -> None:
        self.collides = collides
        self.step = step
        self.edges = 0

    def free(self, conf: Array, /) -> bool:
        return not self.collides(conf)

    def edge_free(self, start: Array, end: Array, /) -> bool:
        self.edges += 1
        count = max(2, int(np.ceil(np.linalg.norm(end - start) / self.step)) + 1)
        return not any(self.collides(conf) for conf in np.linspace(start, end, count))


class JointLimits:
    """Joint limits of a seven-jointed arm, radians."""

    lower = (-3.0,) * 7
    upper = (3.0,) * 7


def wall_with_gap(conf: Array) -> bool:
    """In joint space: a wall at q1 = 0 that leaves a gap where q2 > 1.5."""
    q = conf[3:]
    return bool(abs(q[0]) < 0.2 and q[1] < 1.5)


def round_table(conf: Array) -> bool:
    """On the floor: a disc of 0.8 m radius about the origin, for a base whose shape is a disc of 0.4 m."""
    return bool(np.hypot(conf[0], conf[1]) < 1.2)
