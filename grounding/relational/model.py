"""A relational grounding: demonstrations or a flow propose, what all demonstrations keep filters, the ranker orders."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.layers import sigmoid
from grounding.relational.chart import Chart
from grounding.relational.measures import View
from grounding.relational.proposals import Transfer
from grounding.relational.ranker import Ranker
from grounding.situation import Situation
from grounding.weights import Weights
from tamp.world.pose import Array

BEST_OF = 32
"""Candidates of which the best is returned."""

ROUNDS = 4
"""How often more candidates are drawn when none keeps what all demonstrations keep."""


class RelationalModel:
    """A trained grounding in relational coordinates; numpy only.

    Args:
        weights: Arrays `coordinates`, `faces`, `sizes` (the demonstrations) and `rank.*`; the card's `chart`.
    """

    def __init__(self, weights: Weights) -> None:
        arrays = weights.arrays
        self.card = weights.card
        self.chart = Chart.from_card(weights.card["chart"])
        self.transfer = Transfer(self.chart, arrays["coordinates"], arrays["faces"], arrays["sizes"])
        ranks = {name.removeprefix("rank."): array for name, array in arrays.items() if name.startswith("rank.")}
        self.ranker = Ranker(ranks) if ranks else None

    def propose(self, situation: Situation, count: int, rng: Random) -> Array:
        """At most `count` poses T_world_body, the best first; none for a body that rests on no face."""
        view = View(situation)
        if not view.form.faces:
            return np.zeros((0, 4, 4))
        poses, scores = np.zeros((0, 4, 4)), np.zeros(0)
        for _ in range(ROUNDS):
            drawn = self.transfer.draw(view, max(BEST_OF, 2 * count), rng)
            poses = np.concatenate([poses, drawn])
            scores = np.concatenate([scores, self._scores(view, drawn)])
            if (scores > HOPELESS).sum() >= count:
                break
        best = np.argsort(-scores, kind="stable")[:count]
        return view.T_world_region @ poses[best]

    def classify(self, situation: Situation, poses: Array) -> NDArray[np.float64]:
        """The probability that the relation holds with the body at each pose T_world_body, shape (n,)."""
        view = View(situation)
        if not view.form.faces or not len(poses):
            return np.zeros(len(poses))
        measured = view.measure(view.T_region_world @ poses)
        if self.ranker is not None and self.card["classifies"]:
            return sigmoid(self.ranker.logits(measured)).astype(float)
        return np.exp(-200.0 * self.chart.shortfall(measured)) * (np.abs(measured.low[:, 2]) < 0.03)

    def _scores(self, view: View, poses: Array) -> Array:
        measured = view.measure(poses)
        shortfall = self.chart.shortfall(measured)
        steady = np.minimum(view.steadiness[measured.face], STEADY) / STEADY
        overhang = np.clip(measured.sides.min(axis=1), -OVERHANG, 0.0) / OVERHANG
        scores = steady + 2.0 * overhang + np.minimum(measured.nearest, CLEAR) / CLEAR
        if self.ranker is not None and self.card["ranks"]:
            scores = scores + np.clip(self.ranker.logits(measured), 0.5 * HOPELESS, SURE)
        return np.where(shortfall > 0.0, HOPELESS - 1e3 * shortfall, scores)


STEADY, CLEAR, OVERHANG, SURE = 0.35, 0.01, 0.04, 4.0
"""A tilt withstood (radians), a distance, an overhang (metres) and a logit beyond which more makes no difference."""

HOPELESS = -1e3
"""The score below which a pose misses what all demonstrations keep."""


def relational_weights(
    chart: Chart, transfer: Transfer, rank: Mapping[str, NDArray[Any]], card: Mapping[str, Any]
) -> Weights:
    """What `RelationalModel` is made of."""
    arrays: dict[str, NDArray[Any]] = {
        "coordinates": transfer.coordinates.astype(np.float32),
        "faces": transfer.faces.astype(np.float32),
        "sizes": transfer.sizes.astype(np.float32),
        **{f"rank.{name}": array for name, array in rank.items()},
    }
    return Weights(arrays, {**card, "chart": asdict(chart)})
