"""Evidence for a relation: demonstrations and chance, measured, and the intervals of what holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.relations.catalogue import Measure, catalogue, measure
from grounding.relations.null_hypothesis import chance
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

RIGHT = 3.0
"""Nats that a rejected negative, or a positive that would be kept when left out, is worth."""

UNTOUCHED = 0.03
"""A yaw that varies less was never touched by a hand, radians."""

ROOM = ("room within", "middle within")
"""How keys of measures begin of which more is never worse."""

SAME_SIZE = 0.05
"""Sizes that differ by a smaller share count as one."""

ZERO = 0.006
"""A height that is so small needs no explanation, metres."""


@dataclass(frozen=True)
class Settings:
    """The settings of a committee: what counts as evidence.

    Attributes:
        small: Nats that a condition costs.
        small_alone: The same where there are no negatives.
        floor: Share of chance situations below which rejecting more proves nothing.
        cap: Positives that count as evidence, at most.
        fade: Negatives that halve the weight of chance.
        widen: Mean spacings of the positives by which an interval is wider than they are.
        far: Margins by which a bound may lie beyond the positives where a negative is near.
        idle: Nats against what the negatives, or a hand, did not vary.
        contact: Nats against a height that is not zero.
        temper: Of the votes.
        beam: Conjunctions that are extended.
        depth: Conditions of a conjunction, at most.
        members: Conjunctions that vote, at most.
        count: Chance situations.
    """

    small: float = 6.0
    small_alone: float = 4.0
    floor: float = 0.05
    cap: int = 6
    fade: float = 40.0
    widen: float = 2.0
    far: float = 1.5
    idle: float = 12.0
    contact: float = 6.0
    temper: float = 2.0
    beam: int = 24
    depth: int = 6
    members: int = 60
    count: int = 2000


CLASSIFYING = Settings()
"""What votes on whether a relation holds."""

RANKING = Settings(small=5.0, floor=0.005, widen=1.0, far=1.0, cap=10)
"""A stricter one that ranks proposals, where there are negatives."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Demonstrations and chance, measured once for several committees.

    Attributes:
        measures: The catalogue.
        good: Centred measures of what holds, (p, f).
        bad: Of what does not, (q, f).
        base: Of chance, (b, f).
        period: Of the measures, (f,).
        zero: Middle of the demonstrations' angles, (f,).
        allowed: Whether a measure tells anything in these scenes, (f,).
        one_size: Whether an argument had one size in all that holds.
    """

    measures: Sequence[Measure]
    good: Array
    bad: Array
    base: Array
    period: Array
    zero: Array
    allowed: NDArray[np.bool_]
    one_size: bool


def gather(
    positives: Situations, negatives: Situations | None, rng: Random, count: int = 2000
) -> Evidence:
    """Measure demonstrations and chance."""
    measures = catalogue(positives.arguments)
    good = measure(positives)
    bad = measure(negatives) if negatives is not None and len(negatives) else good[:0]
    base = measure(chance(positives, rng, count))

    period = np.array([one.period for one in measures])
    p = np.where(period > 0, period, 1.0)
    turn = np.exp(2j * np.pi * good / p).mean(axis=0)
    zero = np.where(period > 0, np.angle(turn) / (2 * np.pi) * p, 0.0)
    hollow = np.all(positives.inner[positives.shape, 3] > 0, axis=0)
    allowed = np.array(
        [
            "floor of" not in one.key or bool(hollow[int(one.key.rpartition(" ")[2])])
            for one in measures
        ]
    )
    sizes = positives.half[positives.shape]
    return Evidence(
        measures,
        centred(good, period, zero),
        centred(bad, period, zero),
        centred(base, period, zero),
        period,
        zero,
        allowed,
        bool((np.ptp(sizes, axis=0) < SAME_SIZE * sizes.mean(axis=0)).all(axis=1).any()),
    )


def centred(values: Array, period: Array, zero: Array) -> Array:
    """Return values with those of a period within half of it about their zero."""
    p = np.where(period > 0, period, 1.0)
    return np.where(period > 0, (values - zero + p / 2) % p - p / 2, values)


@dataclass(frozen=True, eq=False)
class Bounds:
    """The interval of each measure, (f,): of the positives, and widened."""

    least: Array
    most: Array
    low: Array
    high: Array
    soft: Array
    scale: Array
    open_below: NDArray[np.bool_]
    open_above: NDArray[np.bool_]
    missed: Array

    @classmethod
    def of(cls, e: Evidence, s: Settings) -> Bounds:
        """Take the positives' range, their resolution, and some of their mean spacing."""
        n, scale = len(e.good), np.array([one.scale for one in e.measures])
        ordered = np.sort(e.good, axis=0)
        least, most = ordered[0], ordered[-1]
        margin = scale + s.widen * (most - least) / max(n - 1, 1)
        open_below = np.array([one.least for one in e.measures]) & (least < 2 * scale)
        second = np.stack([ordered[min(1, n - 1)], ordered[max(n - 2, 0)]])
        missed = (least < second[0] - margin).astype(float) + (most > second[1] + margin)
        # Nobody means that there be no more room than there was: more of it is never worse.
        open_above = np.array([one.key.startswith(ROOM) for one in e.measures])
        low = np.where(open_below, -np.inf, least - margin)
        high = np.where(open_above, np.inf, most + margin)
        return cls(least, most, low, high, 0.5 * margin, scale, open_below, open_above, missed)

    def within(self, values: Array) -> NDArray[np.bool_]:
        """Check which measures are within their intervals, (n, f)."""
        return (values >= self.low) & (values <= self.high)

    def tightened(self, e: Evidence, s: Settings, columns: list[int]) -> tuple[Array, Array]:
        """Return a conjunction's bounds: half way to a negative that nothing else of it rejects."""
        inside = self.within(e.bad)
        low, high = self.low[columns].copy(), self.high[columns].copy()
        for place, column in enumerate(columns):
            others = [other for other in columns if other != column]
            alone = e.bad[inside[:, others].all(axis=1), column]
            above = alone[alone > self.most[column] + 0.5 * self.scale[column]]
            below = alone[alone < self.least[column] - 0.5 * self.scale[column]]
            if len(above):
                half_way = (above.min() + self.most[column]) / 2
                farthest = self.most[column] + s.far * (high[place] - self.most[column])
                high[place] = min(half_way, farthest)
            if len(below):
                half_way = (below.max() + self.least[column]) / 2
                farthest = self.least[column] - s.far * (self.least[column] - low[place])
                low[place] = max(half_way, farthest)
        return low, high
