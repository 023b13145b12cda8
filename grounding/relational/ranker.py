"""The relational classifier: how a pose fits its region, and by max pooling what around it is most in the way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.layers import dense, layers_of
from grounding.relational.measures import REACH, Measures

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
        """Shape (n,): the larger, the likelier that the relation holds."""
        pose, pair = features(measured)
        pooled = dense(self._pair, pair).max(axis=1)
        return dense(self._main, np.concatenate([pose, pooled], axis=1))[:, 0]


def features(measured: Measures) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Of poses, shape (n, POSE), and of pairs with what is around, (n, at least 1, PAIR)."""
    view = measured.view
    heights = np.stack([measured.low[:, 2], measured.ceiling, measured.high[:, 2]], axis=1)
    sides, balance = np.sort(measured.sides, axis=1), np.sort(measured.balance, axis=1)
    lengths = np.concatenate([heights, sides, balance, measured.nearest[:, None]], axis=1)  # (n, 8)
    tilt = np.linalg.norm(measured.tilt, axis=1, keepdims=True)
    steady = view.steadiness[measured.face][:, None]
    extents = measured.high - measured.low
    constant = np.concatenate([[float(view.region.hollow)], np.minimum(view.region.size, 2.0)])
    pose = np.concatenate(
        [
            np.tanh(8 * lengths),
            np.tanh(100 * lengths),
            np.tanh(4 * tilt), np.tanh(40 * tilt), steady, np.tanh(4 * (steady - tilt)),
            8 * np.sort(extents[:, :2], axis=1), 8 * extents[:, 2:],
            np.tanh(20 * np.minimum(heights[:, :1], 0.0)),
            np.repeat(constant[None], len(tilt), axis=0),
            measured.poses[:, 2:3, 2],
            np.log(np.maximum(extents[:, 2:], 1e-3)),
            np.log(np.maximum(extents[:, :2].min(axis=1, keepdims=True), 1e-3)),
        ],
        axis=1,
    )  # fmt: skip
    around = view.obstacles
    if not around.count:
        return pose.astype(np.float32), np.tile(np.array([1, 1, 1, 1, 0], np.float32), (len(pose), 1, 1))
    apart = np.minimum(measured.apart, REACH).astype(np.float32)
    over = np.maximum(measured.low[:, 2:] - around.high[:, 2], around.low[:, 2] - measured.high[:, 2:])
    over = over.astype(np.float32)
    pair = np.empty((*apart.shape, PAIR), np.float32)
    for row, lengths in enumerate((8 * apart, 100 * apart, 8 * over, 100 * over)):
        np.tanh(lengths, out=pair[:, :, row])
    pair[:, :, 4] = (around.high - around.low).max(axis=1)
    return pose.astype(np.float32), pair
