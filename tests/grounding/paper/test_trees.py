"""Decision trees at work: what their leaves contain, what they propose, arrays that are no tree."""

import numpy as np
import pytest

from grounding.paper.features import BoxFeatures
from grounding.paper.trees import TreeModel, position_limits
from grounding.weights import Weights
from tamp.errors import InputError


def test_a_tree_knows_what_it_was_trained_on(data, tree):
    model = TreeModel(tree)
    for example in data.take(range(60)):
        assert (
            model.classify(example.situation, example.situation.body.matrix[None])[0]
            == example.holds
        )


def test_the_boxes_of_a_trees_leaves_contain_the_training_sets_positives(data, tree):
    mine, features, looked = TreeModel(tree).tree, BoxFeatures(), 0
    for example in data:
        if not example.holds:
            continue
        seen = features.observe(example.situation)
        (leaf,) = mine.leaf(seen.arguments.reshape(1, -1))
        (row,) = np.flatnonzero(mine.leaves == leaf)
        low, high, own = mine.low[[row]], mine.high[[row]], seen.arguments[1]
        assert (own >= low - 1e-6).all() and (own <= high + 1e-6).all()
        least, most = position_limits(low, high, own[None, 9:13], seen)
        assert (own[:3] >= least - 1e-6).all() and (own[:3] <= most + 1e-6).all()
        looked += 1
    assert looked == 120


def test_a_trees_proposals_are_in_its_positive_leaves(data, tree):
    """What the arguments' own sizes and the norm of a quaternion spoil is left to the paper's method."""
    model, found = TreeModel(tree), []
    for example in data.take(range(0, 60, 3)):
        poses = model.propose(example.situation, 8, np.random.default_rng(0))
        found.append((model.classify(example.situation, poses) > 0.5).mean())
    assert np.mean(found) > 0.5


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tree.left": None}, "no 'left'"),
        ({"tree.low": np.zeros(7)}, "a range of 7 features"),
        ({"tree.high": np.zeros(7)}, "a range of other than 19"),
        ({"tree.left": np.zeros(1, int)}, "nodes that do not fit"),
        ({"tree.left": "zero"}, "children"),
        ({"tree.feature": "far"}, "a feature that there is not"),
    ],
)
def test_arrays_of_no_tree_are_refused(tree, change, message):
    ((name, array),) = change.items()
    arrays = dict(tree.arrays)
    if array is None:
        del arrays[name]
    elif isinstance(array, str):
        arrays[name] = np.where(
            arrays["tree.feature"] < 0, arrays[name], 0 if array == "zero" else 38
        )
    else:
        arrays[name] = array
    with pytest.raises(InputError, match=message):
        TreeModel(Weights(arrays, {}))
