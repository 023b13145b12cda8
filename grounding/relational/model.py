"""A relational grounding: demonstrations or a flow propose, what all demonstrations keep filters,
the ranker orders.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.layers import sigmoid
from grounding.relation_scene import RelationScene
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.flow import Flow
from grounding.relational.measures import Measures, RegionFrame
from grounding.relational.proposals import Transfer
from grounding.relational.ranker import Ranker
from grounding.weights import Weights
from tamp.geometric.scene.pose import Array

BEST_OF = 16
"""Candidates of which the best is returned."""

ROUNDS = 5
"""How often more candidates are drawn, of one pose twice as many each time, when too few keep what
all have kept.
"""


class RelationalModel:
    """A trained grounding in relational coordinates; numpy only.

    Args:
        weights: Arrays `coordinates`, `faces`, `sizes` (the demonstrations), or `flow.*`, and
            `rank.*`; the card's `chart`, `ranks` and `classifies`.

    Raises:
        KeyError: Something is missing.
        TypeError: The chart is another one.
        ValueError: Arrays do not fit each other.
    """

    def __init__(self, weights: Weights) -> None:
        arrays = weights.arrays
        self.card = weights.card
        self.chart = RelationalCoordinates.from_card(weights.card["chart"])
        flow, ranks = _named(arrays, "flow."), _named(arrays, "rank.")
        self.proposals: Transfer | Flow = (
            Flow(self.chart, flow)
            if flow
            else Transfer(self.chart, *(arrays[name] for name in DEMONSTRATIONS))
        )
        self.ranker = Ranker(ranks) if ranks else None
        self._ranks, self._classifies = bool(self.card["ranks"]), bool(self.card["classifies"])

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose at most `count` poses T_world_body, the best first; none for a body that rests on
        no face.
        """
        return self.propose_on_faces(situation, count, rng)[0]

    def propose_on_faces(
        self, situation: RelationScene, count: int, rng: Random
    ) -> tuple[Array, Array]:
        """Propose poses T_world_body, (n, 4, 4), and what turns the face down that each means, (n,
        3, 3).
        """
        view = RegionFrame(situation)
        if not len(view.faces):
            return np.zeros((0, 4, 4)), np.zeros((0, 3, 3))
        poses, scores = np.zeros((0, 4, 4)), np.zeros(0)
        faces = np.zeros(0, dtype=np.intp)
        for turn in range(ROUNDS):
            drawn = self.proposals.draw(view, max(BEST_OF << turn, 2 * count), rng)
            poses = np.concatenate([poses, drawn.poses])
            faces = np.concatenate([faces, drawn.face])
            scores = np.concatenate([scores, self._scores(drawn)])
            if (scores > HOPELESS).sum() >= count:
                break
        best = np.argsort(-scores, kind="stable")[:count]
        return view.T_world_region @ poses[best], view.rotations[faces[best]]

    def classify(self, situation: RelationScene, poses: Array) -> NDArray[np.float64]:
        """Return the probability that the relation holds with the body at each pose T_world_body,
        shape (n,).
        """
        view = RegionFrame(situation)
        if not len(view.faces) or not len(poses):
            return np.zeros(len(poses))
        measured = view.measure(view.T_region_world @ poses)
        if self.ranker is not None and self._classifies:
            return sigmoid(self.ranker.logits(measured)).astype(float)
        return np.exp(-200.0 * self.chart.constraint_violation(measured)) * (
            np.abs(measured.low[:, 2]) < 0.03
        )

    def _scores(self, measured: Measures) -> Array:
        constraint_violation = self.chart.constraint_violation(measured)
        steady = np.minimum(measured.view.steadiness[measured.face], STEADY) / STEADY
        overhang = np.clip(measured.sides.min(axis=1), -OVERHANG, 0.0) / OVERHANG
        scores = steady + 2.0 * overhang + np.minimum(measured.nearest, CLEAR) / CLEAR
        if self.ranker is not None and self._ranks:
            scores = scores + np.clip(self.ranker.logits(measured), 0.5 * HOPELESS, SURE)
        return np.where(constraint_violation > 0.0, HOPELESS - 1e3 * constraint_violation, scores)


STEADY, CLEAR, OVERHANG, SURE = 0.35, 0.01, 0.04, 4.0
"""A tilt withstood (radians), a distance, an overhang (metres) and a logit beyond which more makes
no difference.
"""

HOPELESS = -1e3
"""The score below which a pose misses what all demonstrations keep."""


DEMONSTRATIONS = ("coordinates", "faces", "sizes")
"""The arrays of a `Transfer`."""


def relational_weights(
    chart: RelationalCoordinates,
    proposals: Transfer | Mapping[str, NDArray[Any]],
    rank: Mapping[str, NDArray[Any]],
    card: Mapping[str, Any],
) -> Weights:
    """Assemble the weights of a `RelationalModel`; the proposals are demonstrations or the arrays
    of a `Flow`.
    """
    if isinstance(proposals, Transfer):
        arrays = {name: np.asarray(getattr(proposals, name), np.float32) for name in DEMONSTRATIONS}
    else:
        arrays = {f"flow.{name}": array for name, array in proposals.items()}
    return Weights(
        {**arrays, **{f"rank.{name}": array for name, array in rank.items()}},
        {**card, "chart": chart.card},
    )


def _named(arrays: Mapping[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    return {
        name.removeprefix(prefix): array
        for name, array in arrays.items()
        if name.startswith(prefix)
    }
