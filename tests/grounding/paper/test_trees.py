"""Decision trees at work: what their leaves contain, what they propose, arrays that are no tree."""

from dataclasses import replace

import numpy as np
import pytest

from grounding.paper.features import BoxFeatures
from grounding.paper.trees import Tree, TreeModel, position_limits
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
        ({"tree.low": np.full(19, 9.0)}, "a range that ends before it begins"),
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


def test_a_tree_without_a_positive_leaf_proposes_nothing(data, tree):
    none = {**tree.arrays, "tree.positive": np.zeros_like(tree.arrays["tree.positive"])}
    model = TreeModel(Weights(none, {}))
    assert model.propose(data[0].situation, 5, np.random.default_rng(0)).shape == (0, 4, 4)


def test_limits_of_a_box_are_limits_of_its_position(data):
    """A body of 0.2 x 0.1 x 0.1 m that is not turned: its box's low side from 0.1 m on, its high side to 0.5 m."""
    seen = replace(BoxFeatures().observe(data[0].situation), extents=np.array([0.1, 0.05, 0.05]))
    low, high = np.full((1, 19), -np.inf), np.full((1, 19), np.inf)
    low[0, :3], high[0, :3] = -1.0, 1.0
    low[0, 3], high[0, 6] = 0.1, 0.5
    least, most = position_limits(low, high, np.array([[0.0, 0.0, 0.0, 1.0]]), seen)
    assert least[0].tolist() == pytest.approx([0.2, -1.0, -1.0])
    assert most[0].tolist() == pytest.approx([0.4, 1.0, 1.0])
    high[0, 6] = 0.2  # it does not fit: the middle of 0.2 and 0.1
    least, most = position_limits(low, high, np.array([[0.0, 0.0, 0.0, 1.0]]), seen)
    assert least[0, 0] == most[0, 0] == pytest.approx(0.15)


def test_at_a_threshold_one_goes_left():
    """One node that looks at argument 1's first number: up to 0.5 it goes left."""
    nodes = {
        "feature": [19, -1, -1], "threshold": [0.5, 0.0, 0.0], "left": [1, -1, -1],
        "right": [2, -1, -1], "positive": [0.5, 1.0, 0.0],
    }  # fmt: skip
    arrays = {f"tree.{name}": np.array(column) for name, column in nodes.items()}
    bounds = {"tree.low": np.full(19, -1.0), "tree.high": np.full(19, 1.0)}
    tree = Tree({**arrays, **bounds}, 19)
    features = np.zeros((3, 38))
    features[:, 19] = [0.4, 0.5, 0.6]
    assert tree.leaf(features).tolist() == [1, 1, 2]
    assert tree.leaves.tolist() == [1]
    assert (tree.low[0, 0], tree.high[0, 0]) == (-1.0, 0.5)
    assert tree.high[0, 3] == np.inf  # edges along the world's axes follow from the rest


def test_a_leaf_that_no_example_can_reach_is_refused():
    """Argument 1's first number is at most 0.2; a positive leaf wants it beyond 0.5."""
    nodes = {
        "feature": [19, -1, -1], "threshold": [0.5, 0.0, 0.0], "left": [1, -1, -1],
        "right": [2, -1, -1], "positive": [0.5, 0.0, 1.0],
    }  # fmt: skip
    arrays = {f"tree.{name}": np.array(column) for name, column in nodes.items()}
    bounds = {"tree.low": np.full(19, -1.0), "tree.high": np.full(19, 0.2)}
    with pytest.raises(InputError, match="a leaf that no example can reach"):
        Tree({**arrays, **bounds}, 19)
