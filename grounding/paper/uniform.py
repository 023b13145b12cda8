"""The paper's sampler baselines (section IV-A): uniform poses, as they come or until a classifier
accepts one.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator as Random

from grounding.paper.features import BB, BoxFeatures, FeatureObservation, completed, poses_of
from grounding.paper.runtime import Network, classified, features_in, judged, unit
from grounding.relation_scene import RelationScene
from grounding.weights import Weights
from tamp.errors import InputError
from tamp.geometric.samplers.placements import BOX_GROWTH_SHARE
from tamp.geometric.scene.pose import Array

TRIES = (20, 60, 120, 300)
"""How many poses are drawn and judged at once, in turn: 500 at most, the paper's budget."""

ACCEPTED = 0.5
"""The probability from which on a pose is accepted."""


class UniformModel:
    """Positions uniform in argument 0's box grown on each side by half its largest half extent;
    random rotations.

    Args:
        weights: Of `mlp-bb` or `gnn-bb`, whose classifier accepts or rejects; None takes what
            comes, and classifies nothing.

    Raises:
        InputError: The weights have no classifier of boxes.
    """

    def __init__(self, weights: Weights | None = None) -> None:
        self._features = BoxFeatures()
        self.classifier = None if weights is None else _box_classifier(weights)

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose `count` poses, in no order: the first accepted, or the last of 500 tries."""
        seen = self._features.observe(situation)
        if self.classifier is None:
            return poses_of(seen, *_drawn(seen, count, rng))
        positions, turns = np.zeros((count, 3)), np.zeros((count, 4))
        for row in range(count):
            positions[row], turns[row] = _accepted(self.classifier, seen, rng)
        return poses_of(seen, positions, turns)

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return the classifier's probabilities, shape (n,); not a number where there is none."""
        if self.classifier is None:
            return np.full(len(poses), np.nan)
        return classified(
            self.classifier, self._features, self._features.observe(situation), situation, poses
        )


def _box_classifier(weights: Weights) -> Network:
    network = Network(weights.arrays, "classifier")
    if features_in(weights.arrays, network).size != BB:
        raise InputError(
            "this sampler needs a classifier of boxes, and the weights' is one of clouds"
        )
    return network


def _accepted(classifier: Network, seen: FeatureObservation, rng: Random) -> tuple[Array, Array]:
    """Sample one accepted position (3,) and its quaternion (4,)."""
    positions, turns, first = np.zeros((1, 3)), np.zeros((1, 4)), 0
    for count in TRIES:
        positions, turns = _drawn(seen, count, rng)
        good = judged(classifier, seen, completed(seen, positions, turns)) > ACCEPTED
        first = int(np.argmax(good)) if good.any() else count - 1
        if good.any():
            break
    return positions[first], turns[first]


def _drawn(seen: FeatureObservation, count: int, rng: Random) -> tuple[Array, Array]:
    """Sample positions (n, 3) relative to argument 0, and quaternions (n, 4), w >= 0 as in the
    features.
    """
    low, high = seen.arguments[0, 3:6], seen.arguments[0, 6:9]
    margin = BOX_GROWTH_SHARE * float((high - low).max()) / 2
    positions = rng.uniform(low - margin, high + margin, size=(count, 3))
    turns = unit(rng.normal(size=(count, 4)))
    return positions, np.where(turns[:, 3:] < 0, -turns, turns)
