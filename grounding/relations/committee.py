"""A committee (ensemble) of short conjunctions of intervals: which measures of the demonstrations
are no coincidence.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from grounding.relations.catalogue import catalogue, measure
from grounding.relations.evidence import CLASSIFYING, Bounds, Evidence, Settings, centred
from grounding.relations.search import conjunctions, prices
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

TYPICAL = 8
"""Measures in which proposals are to be like the demonstrations, at most."""

OFFSETS = ("middle", "gap above", "gap below", "either side gap")
"""Measures of which one along each axis is among them."""

AGREED = 0.7
"""Nats by which demonstrations have to agree more than chance there."""

WORTH = 0.5
"""Nats that one of them adds at least."""


@dataclass(frozen=True, eq=False)
class Committee:
    """Conjunctions and their weights.

    Attributes:
        arguments: Of the relation.
        used: Columns of the catalogue that are looked at, (u,).
        zero: Middle of each measure's circle where it is an angle, by column of the catalogue,
            (f,).
        conditions: Rows of `used` of each member's conditions, -1 for none, (members, depth).
        low: Bounds, (members, depth).
        high: The same.
        soft: What one step beyond a bound is, (members, depth).
        weights: Of the members, sum 1, (members,).
        scores: Their evidence in nats, (members,).
        typical: Columns of the catalogue in which the demonstrations are alike, (t,).
        median: Of the demonstrations in these, (t,).
        spread: Their mean deviation and the resolution, (t,).
        side: 1 where less is never worse, -1 where more is not, 0 elsewhere, (t,).
    """

    arguments: int
    used: NDArray[np.int64]
    zero: Array
    conditions: NDArray[np.int64]
    low: Array
    high: Array
    soft: Array
    weights: Array
    scores: Array
    typical: NDArray[np.int64]
    median: Array
    spread: Array
    side: NDArray[np.int64]
    _period: Array = field(init=False)

    def __post_init__(self) -> None:
        period = np.array([one.period for one in catalogue(self.arguments)])
        object.__setattr__(self, "_period", period)

    def centred(self, values: Array) -> Array:
        """Return measures with angles about the middle of the demonstrations'."""
        return centred(values, self._period, self.zero)

    def votes(self, values: Array) -> Array:
        """Return each member's probability by centred measures (n, f), shape (n, members)."""
        x = values[:, self.used[self.conditions]]
        z = np.minimum(x - self.low, self.high - x) / self.soft
        z = np.where(self.conditions >= 0, z, 2.0).min(axis=2)
        empty = (self.conditions < 0).all(axis=1)
        voted = 1.0 / (1.0 + np.exp(-np.clip(2.0 * z, -30.0, 30.0)))
        return np.where(empty, 0.5, voted)

    def predict(self, situations: Situations) -> Array:
        """Return the probability that the relation holds in each situation, (n,)."""
        return self.votes(self.centred(measure(situations))) @ self.weights

    def margin(self, values: Array, like: float) -> Array:
        """Return how far inside the members' bounds situations are, and how like the
        demonstrations: what proposals are ranked by, (n,).
        """
        strong = self.weights > 0.01
        conditions = self.conditions[strong]
        x = values[:, self.used[conditions]]
        z = np.minimum(x - self.low[strong], self.high[strong] - x) / self.soft[strong]
        z = np.where(conditions >= 0, z, 2.0)
        deep = np.minimum(z, 2.0) + 1.0 * np.log(np.maximum(z, 2.0) / 2.0)
        each = 2.0 * np.minimum(z, 0.0).sum(axis=2) + deep.min(axis=2)

        off = values[:, self.typical] - self.median
        off = np.where(self.side == 0, np.abs(off), off * self.side) / self.spread
        return each @ self.weights[strong] - like * np.clip(off, -1.0, 4.0).sum(axis=1)


def fit(evidence: Evidence, settings: Settings = CLASSIFYING) -> Committee:
    """Find the conjunctions that explain demonstrations, and weigh them."""
    e, s = evidence, settings
    bounds = Bounds.of(e, s)
    found = conjunctions(e, s, bounds)

    used = sorted({column for one in found.members for column in one}) or [0]
    row = {column: index for index, column in enumerate(used)}
    shape = (len(found.members), max([1, *map(len, found.members)]))
    conditions = np.full(shape, -1, dtype=np.int64)
    low, high, soft = np.full(shape, -np.inf), np.full(shape, np.inf), np.ones(shape)
    for index, one in enumerate(found.members):
        columns = list(one)
        conditions[index, : len(one)] = [row[column] for column in columns]
        low[index, : len(one)], high[index, : len(one)] = bounds.tightened(e, s, columns)
        soft[index, : len(one)] = bounds.soft[columns]

    typical = np.array(_typical(e, s, bounds), dtype=np.int64)
    median = np.median(e.good, axis=0)
    centre = np.array([one.key.startswith("middle: ") for one in e.measures])
    centre &= np.abs(median) < bounds.scale  # nobody means a few millimetres
    spread = bounds.scale + np.abs(e.good - median).mean(axis=0)

    return Committee(
        arguments=next(k for k in range(1, 9) if len(catalogue(k)) == len(e.measures)),
        used=np.array(used, dtype=np.int64),
        zero=e.zero,
        conditions=conditions,
        low=low,
        high=high,
        soft=soft,
        weights=found.weights,
        scores=found.scores,
        typical=typical,
        median=np.where(centre, 0.0, median)[typical],
        spread=spread[typical],
        side=(bounds.open_below.astype(np.int64) - bounds.open_above)[typical],
    )


def _typical(e: Evidence, s: Settings, bounds: Bounds) -> list[int]:
    """Choose measures in which the demonstrations are alike and chance is not, each beside the
    others.
    """
    inside = bounds.within(e.base)
    prior = prices(e, s, bounds)
    left, chosen = np.ones(len(inside), dtype=bool), list[int]()
    while len(chosen) < TYPICAL and left.sum() > 20:
        gain = -np.log(inside[left].mean(axis=0) + 0.02) - 0.5 * prior
        gain[chosen] = -np.inf
        best = int(np.argmax(gain))
        if gain[best] < WORTH:
            break
        chosen.append(best)
        left &= inside[:, best]
    return [*dict.fromkeys([*chosen, *_framed(e)])]


def _framed(e: Evidence) -> list[int]:
    """Choose two offsets from another argument, along both axes of the frame in which the
    demonstrations agree most.
    """
    spread = e.good.std(axis=0) + np.array([one.scale for one in e.measures])
    agreed = np.log(np.maximum(e.base.std(axis=0), 1e-9) / spread)
    agreed -= 0.5 * np.array([one.cost for one in e.measures])
    best: dict[str, dict[str, int]] = {}
    for column, one in enumerate(e.measures):
        kind, _, at = one.key.partition(": ")
        if kind in OFFSETS and " in " in at and e.allowed[column]:
            axis, _, frame = at.partition(" of ")
            axes = best.setdefault(frame, {})
            if axis not in axes or agreed[column] > agreed[axes[axis]]:
                axes[axis] = column
    if not best:
        return []
    columns = max(best.values(), key=lambda axes: sum(agreed[column] for column in axes.values()))
    return [column for column in columns.values() if agreed[column] > AGREED]
