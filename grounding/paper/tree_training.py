"""Decision trees from a data set; what they are at work is `trees`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from grounding.certainty import MANY, REASON, Labels, no_better_than_chance, too_few
from grounding.dataset import Dataset
from grounding.paper.feature_table import FeatureTable
from grounding.paper.training import features_of
from grounding.paper.trees import LEAF
from grounding.weights import Weights
from tamp.errors import InputError

MODELS = ("tree-bb", "tree-pc")
"""Trees by their features."""


def train_tree(
    data: Dataset,
    model: str,
    *,
    samples: int,
    seed: int,
    encoder: Weights | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Weights:
    """Train a decision tree of scikit-learn's usual settings, grown to the end on the arguments'
    features.

    Args:
        data: The training set.
        model: One of MODELS.
        samples: How many of the examples are seen, in the order of `table.order`.
        seed: Breaks ties between equally good splits.
        encoder: What codes the clouds, for `tree-pc`.
        progress: Told how far it is.

    Raises:
        InputError: An unknown model, examples of one kind only or fewer than asked for, no encoder.
    """
    if model not in MODELS:
        raise InputError(f"unknown model '{model}'", found=model, choices=MODELS)
    if not 2 <= samples <= len(data):
        raise InputError(f"a training set of {samples} examples; 2 to {len(data)} are possible")
    if model == "tree-pc" and encoder is None:
        raise InputError(
            f"model '{model}' needs an encoder of clouds",
            remedy="Train one: tamp-learn encoder --help",
        )
    if not 0 < int(data.holds.sum()) < len(data):
        raise InputError(
            "the demonstrations are all positive or all negative",
            remedy="Add some of the other kind.",
        )

    table = features_of(data, model, encoder, progress, samples)
    progress(f"a tree of {samples} scenes")
    extra = {f"encoder.{name}": array for name, array in encoder.arrays.items()} if encoder else {}
    arrays = grown(table, samples, seed)
    why = _chance(table, samples, seed) if samples < MANY else None

    return Weights(
        {**arrays, **extra},
        {
            "relation": data.relation,
            "model": model,
            "samples": samples,
            "seed": seed,
            "data": {
                key: data.card[key]
                for key in ("split", "seed", "count", "commit")
                if key in data.card
            },
            "architecture": {"nodes": len(arrays["tree.feature"]), "features": table.features},
            **({"classifies": False, REASON: why} if why else {}),
        },
    )


def _chance(table: FeatureTable, samples: int, seed: int) -> str | None:
    """Return why trees of halves of the examples know no more than chance of the other halves."""
    from sklearn.tree import DecisionTreeClassifier

    arguments, holds = table.arguments[:samples], table.holds[:samples]

    def fit(train: NDArray[np.intp], test: NDArray[np.intp]) -> Labels:
        tree = DecisionTreeClassifier(random_state=seed).fit(arguments[train], holds[train])
        return np.asarray(tree.predict(arguments[test]), dtype=bool)

    return too_few(holds) or no_better_than_chance(holds, fit)


def grown(table: FeatureTable, samples: int, seed: int) -> dict[str, np.ndarray]:
    """Grow the tree of the table's first examples, as `trees.TreeModel` wants its arrays."""
    from sklearn.tree import DecisionTreeClassifier

    arguments, holds = table.arguments[:samples], table.holds[:samples]
    tree = DecisionTreeClassifier(random_state=seed).fit(arguments, holds).tree_
    leaf = tree.children_left < 0
    positive = arguments[holds][:, table.features :]
    return {
        "tree.feature": np.where(leaf, LEAF, tree.feature).astype(np.int32),
        "tree.threshold": np.where(leaf, 0.0, tree.threshold),
        "tree.left": tree.children_left.astype(np.int32),
        "tree.right": tree.children_right.astype(np.int32),
        "tree.positive": tree.value[:, 0, 1].astype(np.float32),
        "tree.low": positive.min(axis=0),
        "tree.high": positive.max(axis=0),
    }
