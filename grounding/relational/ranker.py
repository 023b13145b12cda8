"""The relational classifier: how a pose fits its region, and by max pooling what around it is most
in the way.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.layers import dense, layers_of
from grounding.relational.kernels import describe_poses
from grounding.relational.measures import SURROUNDINGS_M, Measures

POSE, PAIR = 31, 5
"""Features of a pose, and of a pose and one body around it."""


class Ranker:
    """Probabilities from weights `main` and `pair`.

    Args:
        arrays: Weights, as `layers_of` reads them.
    """

    def __init__(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        self._pair = layers_of(arrays, "pair", PAIR)
        self._main = layers_of(arrays, "main", POSE + self._pair[-1][0].shape[1], 1)

    def logits(self, measured: Measures) -> NDArray[Any]:
        """Compute the ranker's logits, shape (n,): the larger, the likelier that the relation
        holds.
        """
        pose, pair = features(measured)
        pooled = dense(self._pair, pair).max(axis=1)
        return dense(self._main, np.concatenate([pose, pooled], axis=1))[:, 0]


def features(measured: Measures) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Compute the features of poses, shape (n, POSE), and of pairs with what is around, (n, at
    least 1, PAIR).
    """
    view, face = measured.view, measured.face
    pose = np.empty((len(face), POSE), np.float32)
    describe_poses(
        measured.poses, measured.low, measured.high, measured.centre, measured.nearest,
        view.rotations[face], view.steadiness[face], view.region.size, view.region.hollow, pose,
    )  # fmt: skip
    around = view.obstacles
    if not around.count:
        return pose, np.tile(np.array([1, 1, 1, 1, 0], np.float32), (len(pose), 1, 1))
    apart = np.minimum(measured.apart, SURROUNDINGS_M).astype(np.float32)
    over = np.maximum(
        measured.low[:, 2:] - around.high[:, 2], around.low[:, 2] - measured.high[:, 2:]
    )
    over = over.astype(np.float32)
    pair = np.empty((*apart.shape, PAIR), np.float32)
    for row, lengths in enumerate((8 * apart, 100 * apart, 8 * over, 100 * over)):
        np.tanh(lengths, out=pair[:, :, row])
    pair[:, :, 4] = (around.high - around.low).max(axis=1)
    return pose, pair
