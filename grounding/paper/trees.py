"""The paper's decision trees (section IV-A): one that classifies, and whose positive leaves are
boxes to sample in.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.paper.features import (
    BB,
    PC,
    BoxFeatures,
    CloudFeatures,
    FeatureObservation,
    Features,
    poses_of,
)
from grounding.paper.rotations import rotations
from grounding.paper.runtime import RESIDUAL, Arrays, NumpyEncoder, unit
from grounding.relation_scene import RelationScene
from grounding.weights import Weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array

LEAF = -1
"""The feature that a leaf differentiates upon."""

NODES = ("feature", "threshold", "left", "right", "positive")
"""One number a node: what it looks at; `x <= threshold` goes left, the rest right; its share of
positive examples.
"""


class TreeModel:
    """`tree-bb` or `tree-pc`, as its arrays say.

    Args:
        weights: Arrays `tree.feature`, `tree.threshold`, `tree.left`, `tree.right`,
            `tree.positive`, shape (nodes,), children after their parents; `tree.low`, `tree.high`,
            shape (f,), the range of argument 1's features in positive examples; for clouds,
            `encoder.*`.

    Raises:
        InputError: The arrays are not those of such a tree.
    """

    def __init__(self, weights: Weights) -> None:
        self._features = _features(weights.arrays)
        self.tree = Tree(weights.arrays, self._features.size)

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose `count` poses, each from a random positive leaf; none when the tree has none."""
        if not len(self.tree.leaves):
            return np.zeros((0, 4, 4))
        seen = self._observe(situation)
        chosen = rng.integers(len(self.tree.leaves), size=count)
        low, high = self.tree.low[chosen], self.tree.high[chosen]
        places = _columns(self._features.size)
        turns = unit(rng.uniform(low[:, places[1]], high[:, places[1]]))
        low, high = position_limits(low, high, turns, seen)
        return poses_of(seen, rng.uniform(low, high), turns)

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return the share of positive examples in each pose's leaf, shape (n,)."""
        seen = self._observe(situation)
        argument = self._features.at(seen, situation, poses)
        return self.tree.positive[self.tree.leaf(_rows(seen, argument))]

    def _observe(self, situation: RelationScene) -> FeatureObservation:
        return self._features.observe(replace(situation, others=()))


class Tree:
    """Nodes as arrays.

    Args:
        arrays: See `TreeModel`.
        size: Numbers a body, f.

    Attributes:
        positive: The share of positive examples in each node, shape (nodes,).
        leaves: The positive leaves, shape (l,).
        low: Least value of each of argument 1's features in these leaves, shape (l, f).
        high: Largest values, shape (l, f).

    Raises:
        InputError: They are no tree.
    """

    def __init__(self, arrays: Arrays, size: int) -> None:
        missing = [name for name in (*NODES, "low", "high") if f"tree.{name}" not in arrays]
        if missing:
            raise _refused(f"no '{missing[0]}'")
        columns = [arrays[f"tree.{name}"] for name in NODES]
        if (
            len({column.shape for column in columns}) > 1
            or columns[0].ndim != 1
            or not len(columns[0])
        ):
            raise _refused("nodes that do not fit each other")

        self._feature, self._left, self._right = (
            columns[index].astype(np.intp) for index in (0, 2, 3)
        )
        self._threshold, self.positive = (
            columns[1].astype(np.float64),
            columns[4].astype(np.float64),
        )
        inner = self._feature != LEAF
        children = np.stack([self._left, self._right])[:, inner]
        if (children <= np.flatnonzero(inner)).any() or (children >= len(inner)).any():
            raise _refused("a node whose children do not come after it")
        if (self._feature[inner] < 0).any() or (self._feature >= 2 * size).any():
            raise _refused("a node that looks at a feature that there is not")
        bounds = [arrays[f"tree.{name}"].astype(np.float64) for name in ("low", "high")]
        if any(bound.shape != (size,) for bound in bounds):
            raise _refused(f"a range of other than {size} features")
        if (bounds[0] > bounds[1]).any():
            raise _refused("a range that ends before it begins")
        self.leaves = np.flatnonzero(~inner & (self.positive > 0.5))
        self.low, self.high = (limits[self.leaves] for limits in self._limits(*bounds))
        if (self.low > self.high).any():
            raise _refused("a leaf that no example can reach")

    def leaf(self, features: Array) -> NDArray[np.intp]:
        """Find the leaves of both arguments' features, shape (n, 2 f); returns (n,)."""
        values = features.astype(np.float32)  # what it was trained on
        node, rows = np.zeros(len(features), np.intp), np.arange(len(features))
        while len(rows):
            rows = rows[self._feature[node[rows]] != LEAF]
            now = node[rows]
            goes_left = values[rows, self._feature[now]] <= self._threshold[now]
            node[rows] = np.where(goes_left, self._left[now], self._right[now])
        return node

    def _limits(self, least: Array, most: Array) -> tuple[Array, Array]:
        """Compute the limits of argument 1's features in each node, from the root down, shape
        (nodes, f).

        Edges of the box along the world's axes are unlimited at the root: they follow from position
        and rotation.
        """
        size = len(least)
        low, high = np.tile(least, (len(self.positive), 1)), np.tile(most, (len(self.positive), 1))
        if size == BB:
            low[:, 3:9], high[:, 3:9] = -np.inf, np.inf
        for node in np.flatnonzero(self._feature != LEAF):
            left, right, column = self._left[node], self._right[node], self._feature[node] - size
            low[[left, right]], high[[left, right]] = low[node], high[node]
            if column >= 0:
                high[left, column] = min(high[left, column], self._threshold[node])
                low[right, column] = max(low[right, column], self._threshold[node])
        return low, high


def position_limits(
    low: Array, high: Array, turns: Array, seen: FeatureObservation
) -> tuple[Array, Array]:
    """Compute the limits of argument 1's position, each shape (n, 3), that limits of its features,
    shape (n, f), amount to.

    Of boxes also those of the box along the world's axes, which reaches as far as the rotations,
    quaternions (n, 4), make it. Limits that contradict each other, for a body of this size, leave
    the point midway.
    """
    least, most = low[:, :3], high[:, :3]
    if low.shape[1] == BB:
        reach = np.abs(rotations(turns)) @ seen.extents
        least = np.maximum(least, np.maximum(low[:, 3:6] + reach, low[:, 6:9] - reach))
        most = np.minimum(most, np.minimum(high[:, 3:6] + reach, high[:, 6:9] - reach))
    middle, contradict = (least + most) / 2, least > most
    return np.where(contradict, middle, least), np.where(contradict, middle, most)


def _columns(size: int) -> tuple[slice, slice]:
    """Return the columns of position and quaternion among a body's features."""
    return slice(0, 3), slice(9, 13) if size == BB else slice(3, 7)


def _rows(seen: FeatureObservation, argument: Array) -> Array:
    return np.concatenate([np.broadcast_to(seen.arguments[0], argument.shape), argument], axis=1)


def _features(arrays: Arrays) -> Features:
    size = arrays["tree.low"].size if "tree.low" in arrays else 0
    if size == BB:
        return BoxFeatures()
    if size == PC:
        encoder = {
            name.removeprefix("encoder."): array
            for name, array in arrays.items()
            if "encoder." in name
        }
        return CloudFeatures(NumpyEncoder(encoder), RESIDUAL in arrays)
    raise _refused(f"a range of {size} features; known: {BB} (boxes), {PC} (clouds)")


def _refused(what: str) -> InputError:
    return InputError(
        f"the weights have no decision tree: {what}",
        remedy="Train it again: tamp-learn train --help",
    )
