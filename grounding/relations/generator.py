"""A generator: demonstrations carried over in the charts that the committee likes best, refined."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.relations.carrying import carry, trouble
from grounding.relations.catalogue import measure
from grounding.relations.charts import Carried, agreement, carried, charts
from grounding.relations.committee import Committee
from grounding.relations.null_hypothesis import about_z, chance, drop, floor_of, highest
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

KEPT = 5
"""Charts that are kept."""

TRIED = 14
"""Demonstrations, each in a chance situation, by which a chart is judged."""

AGREEING, AGREED = 200, 0.04
"""Chance situations against which demonstrations agree in a chart, and what a nat of that is worth,
as a probability.
"""

BLENDED, MIDDLE = 0.5, 0.2
"""Shares of candidates between two demonstrations, and in the middle of all on one side."""

LIKE = 0.4
"""Weight of being like the demonstrations, against being within the bounds."""

FIRST, BEST, EACH = 32, 8, 3
"""Candidates of a proposal; those that are refined; and how often each."""

OTHERWISE = 0.3
"""Share of candidates that stand on another stable face than it was shown, where several are
wanted.
"""

FREE = 0.005
"""Metres by which a demonstration that was carried over may be in another argument, for its chart
to have the credit."""

GOOD = -1.0
"""A score from which on a place is worth trying though others are better."""

APART = (0.01, 0.15)
"""Proposals of one call differ by so much, metres or radians."""

ANY_WAY = np.zeros((0, 3))
"""Down vectors of a body that may be put down in any way."""


@dataclass(frozen=True, eq=False)
class PoseGenerator:
    """Proposes where argument 0 goes.

    Attributes:
        committee: What ranks proposals.
        shown: Demonstrations in the charts that are kept.
        level: What it is put onto: 0 for the furniture, j for the top of argument j, -j for the
            floor of it.
        steady: Whether it stands on a stable face wherever it was shown.
    """

    committee: Committee
    shown: Carried
    level: int
    steady: bool

    def propose(
        self,
        scene: Situations,
        count: int,
        rng: Random,
        steady: Array = ANY_WAY,
        blocked: Callable[[Array, Array], Array] | None = None,
    ) -> tuple[Array, Array]:
        """Propose at most `count` places of argument 0, the best first.

        Args:
            scene: One situation; argument 0 is anywhere.
            count: How many.
            rng: The only source of randomness.
            steady: Down vectors of the ways in which it stands, in its own frame, (s, 3).
            blocked: By how many metres places (n, 3, 3) and (n, 3) are in something else, (n,).

        Returns:
            Rotations (n, 3, 3) and positions of the middle of its box (n, 3), T_world.
        """
        n = FIRST + 3 * (count - 1)
        s = self._first(scene, n, rng, steady if count > 1 else ANY_WAY)
        score = self._score(s, steady, blocked)

        best = np.argsort(-score, kind="stable")[: max(BEST, count)]
        more = s.rows(np.repeat(best, EACH))
        more.p[:, 0, :2] += rng.normal(0, 0.015, (len(more), 2))
        more.R[:, 0] = about_z(rng.normal(0, 0.1, len(more))) @ more.R[:, 0]
        drop(more, self._onto(more))

        score = np.concatenate([score[best], self._score(more, steady, blocked)])
        R = np.concatenate([s.R[best, 0], more.R[:, 0]])
        p = np.concatenate([s.p[best, 0], more.p[:, 0]])
        if count == 1:
            return _spread(R, p, np.argsort(-score, kind="stable"), 1)
        return _spread(R, p, self._varied(score, rng), count)

    def _varied(self, score: Array, rng: Random) -> NDArray[np.intp]:
        """Order places: the best, and in turns any one that is good, and the next best."""
        ranked = np.argsort(-score, kind="stable")
        fine = rng.permutation(np.flatnonzero(score > GOOD))
        mixed = [row for pair in zip(ranked, fine, strict=False) for row in pair]
        return np.array([*dict.fromkeys([*mixed, *ranked.tolist()])], dtype=np.intp)

    def _first(self, scene: Situations, n: int, rng: Random, steady: Array) -> Situations:
        """Carry demonstrations over, or what is between two of them, some on another face."""
        s = scene.rows(np.zeros(n, dtype=np.intp))
        chart = np.arange(n) % len(self.shown.codes)
        one, other = rng.integers(0, len(self.shown.R), (2, n))
        outside = self.shown.outside[chart, one]
        same = (outside == self.shown.outside[chart, other]).all(axis=1)
        mix = np.where(same & (rng.random(n) < BLENDED), rng.uniform(0, 0.6, n), 0.0)[:, None]
        place = (1 - mix) * self.shown.place[chart, one] + mix * self.shown.place[chart, other]

        alike = (self.shown.outside[chart] == outside[:, None]).all(axis=2)[..., None]
        middle = (self.shown.place[chart] * alike).sum(axis=1) / alike.sum(axis=1)
        place = np.where((rng.random(n) < MIDDLE)[:, None], middle, place)
        rotation = self.shown.R[one].copy()
        if self.steady and len(steady):
            turned = np.flatnonzero(rng.random(n) < OTHERWISE)
            rotation[turned] = _turned_down(steady[rng.integers(0, len(steady), len(turned))], rng)
        carry(
            s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support,
            self.shown.codes[chart], place, outside, self.shown.yaw[chart, one],
            rotation, rng.uniform(-np.pi, np.pi, (n, 2)), rng.uniform(-0.95, 0.95, (n, 2)),
            self._onto(s),
        )  # fmt: skip
        return s

    def _onto(self, s: Situations) -> Array:
        return onto(s, self.level)

    def _score(
        self, s: Situations, steady: Array, blocked: Callable[[Array, Array], Array] | None
    ) -> Array:
        """Return how good places are, (n,)."""
        bad = np.empty(len(s))
        down = steady if self.steady else ANY_WAY
        trouble(
            s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, self._onto(s), down, bad
        )
        if blocked is not None:
            bad += blocked(s.R[:, 0], s.p[:, 0])
        values = self.committee.centred(measure(s))
        return self.committee.margin(values, LIKE) - 300.0 * bad


def onto(s: Situations, level: int) -> Array:
    """Return the height of what a level means, (n,)."""
    if level == 0:
        return s.support[:, 0].copy()
    return highest(s, level) if level > 0 else floor_of(s, -level)


def level_of(shown: Situations) -> int:
    """Find what argument 0 stands on wherever it was shown."""
    k = shown.arguments
    hollow = np.all(shown.inner[shown.shape, 3] > 0, axis=0)
    levels = [0, *range(1, k), *(-j for j in range(1, k) if hollow[j])]

    def missed(level: int) -> float:
        moved = shown.rows(np.arange(len(shown)))
        drop(moved, onto(moved, level))
        return float(np.median(np.abs(moved.p[:, 0, 2] - shown.p[:, 0, 2])))

    return min(levels, key=lambda level: missed(level) + 0.002 * levels.index(level))


def learned(
    committee: Committee, shown: Situations, rng: Random, steady: bool = True
) -> PoseGenerator:
    """Choose the charts in which carried demonstrations please the committee most."""
    level = level_of(shown)
    listed = charts(shown.arguments)
    every = carried(shown, listed)
    rows = rng.integers(0, len(shown), TRIED)
    target = chance(shown, rng, TRIED)
    scores = [
        _liked(committee, every, chart, rows, target, level, rng)
        for chart in range(len(every.codes))
    ]
    agreed = agreement(every, carried(chance(shown, rng, AGREEING), listed))
    best = np.argsort(-(np.array(scores) + AGREED * agreed), kind="stable")[:KEPT]
    return PoseGenerator(committee, every.chosen(best), level, steady)


def _liked(
    committee: Committee,
    every: Carried,
    chart: int,
    rows: NDArray[np.intp],
    target: Situations,
    level: int,
    rng: Random,
) -> float:
    s, n = target.rows(np.arange(len(target))), len(target)
    codes = np.repeat(every.codes[chart][None], n, axis=0)
    carry(
        s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, codes, every.place[chart, rows],
        every.outside[chart, rows], every.yaw[chart, rows], every.R[rows],
        rng.uniform(-np.pi, np.pi, (n, 2)), rng.uniform(-0.95, 0.95, (n, 2)), onto(s, level),
    )  # fmt: skip
    bad, anywhere = np.empty(n), np.full(n, np.inf)  # chance puts the others near edges, too
    trouble(s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, anywhere, ANY_WAY, bad)
    return float((committee.predict(s) * (bad < FREE)).mean())


def _turned_down(down: Array, rng: Random) -> Array:
    """Return rotations that turn vectors of a body's frame (n, 3) down, at any yaw, (n, 3, 3)."""
    side = np.where(np.abs(down[:, :1]) < 0.9, np.eye(3)[0], np.eye(3)[1])
    x = np.cross(down, side)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    R = np.stack([x, np.cross(x, down), -down], axis=1)
    return np.asarray(about_z(rng.uniform(-np.pi, np.pi, len(down))) @ R, dtype=float)


def _spread(R: Array, p: Array, order: NDArray[np.intp], count: int) -> tuple[Array, Array]:
    """Take the first that are apart from each other."""
    taken: list[int] = []
    for row in order.tolist():
        if len(taken) == count:
            break
        if taken:
            near = np.abs(p[taken] - p[row]).max(axis=1) < APART[0]
            same = np.einsum("nij,ij->n", R[taken], R[row]) > 1 + 2 * np.cos(APART[1])
            if (near & same).any():
                continue
        taken.append(row)
    return R[taken], p[taken]
