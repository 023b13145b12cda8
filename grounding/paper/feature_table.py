"""A data set's features, worked out once: what the networks and the trees are trained on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from grounding.dataset import Dataset
from grounding.paper.features import Features

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class FeatureTable:
    """Features of n scenes, in the order in which a training set of any size takes its first ones.

    Attributes:
        arguments: Of argument 0 and 1, shape (n, 2 f).
        others: Of the surroundings, shape (n, k, f), zero where there are fewer than k.
        share: Each one's weight in the mean over them, shape (n, k): 1 / their number, or 0 where
            there is none.
        holds: The labels, shape (n,).
    """

    arguments: Floats
    others: Floats
    share: Floats
    holds: NDArray[np.bool_]

    @cached_property
    def features(self) -> int:
        """Return the number of features a body."""
        return self.others.shape[2]


def table_of(
    data: Dataset,
    features: Features,
    progress: Callable[[str], None] = lambda _: None,
    count: int | None = None,
) -> FeatureTable:
    """Compute the features of the first `count` scenes of `order`, or of all."""
    indices = order(data.holds)[:count]
    arguments = np.zeros((len(indices), 2 * features.size), np.float32)
    most = max(1, data.arrays["body"].shape[1] - 2)
    others = np.zeros((len(indices), most, features.size), np.float32)
    share = np.zeros((len(indices), most), np.float32)
    for row, index in enumerate(indices):
        seen = features.observe(data[int(index)].situation)
        arguments[row] = seen.arguments.reshape(-1)
        count = len(seen.others)
        if count:
            others[row, :count], share[row, :count] = seen.others, 1 / count
        if (row + 1) % 2000 == 0:
            progress(f"features of {row + 1} of {len(indices)} scenes")
    most = max(1, int((share > 0).sum(axis=1).max(initial=0)))
    return FeatureTable(
        arguments, others[:, :most].copy(), share[:, :most].copy(), data.holds[indices]
    )


def order(holds: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Order examples such that each prefix is a smaller training set, shape (n,): shuffled, the
    labels in turn.

    Sets of different sizes are nested, and all training seeds see the same ones.
    """
    shuffled = np.random.default_rng(0).permutation(len(holds))
    labels = holds[shuffled]
    rank = np.where(labels, np.cumsum(labels), np.cumsum(~labels))
    return shuffled[np.lexsort((~labels, rank))]
