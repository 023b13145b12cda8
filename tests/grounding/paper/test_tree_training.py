"""Decision trees are scikit-learn's, the same for the same seed, of boxes and of clouds."""

from dataclasses import replace

import numpy as np
import pytest
from sklearn.tree import DecisionTreeClassifier

from grounding.paper.feature_table import table_of
from grounding.paper.features import BB, BoxFeatures
from grounding.paper.tree_training import grown, train_tree
from grounding.paper.trees import Tree, TreeModel
from tamp.errors import InputError


def test_a_tree_is_scikit_learns(data):
    table = table_of(data, BoxFeatures())
    table = replace(table, holds=np.random.default_rng(0).random(240) < 0.5)  # a deep tree
    theirs = DecisionTreeClassifier(random_state=3).fit(table.arguments[:200], table.holds[:200])
    mine = Tree(grown(table, 200, 3), BB)
    noisy = table.arguments + np.random.default_rng(0).normal(
        scale=0.05, size=table.arguments.shape
    )
    assert theirs.get_depth() > 5
    assert np.array_equal(mine.leaf(noisy), theirs.apply(noisy))
    np.testing.assert_allclose(
        mine.positive[mine.leaf(noisy)], theirs.predict_proba(noisy)[:, 1], atol=1e-7
    )


def test_a_tree_of_clouds(data, encoder):
    some = data.take(range(24))
    weights = train_tree(some, "tree-pc", samples=24, seed=0, encoder=encoder)
    model = TreeModel(weights)
    for example in some:
        assert (
            model.classify(example.situation, example.situation.body.matrix[None])[0]
            == example.holds
        )
    assert model.propose(some[0].situation, 4, np.random.default_rng(0)).shape == (4, 4, 4)


def test_same_seed_same_tree(data, tree):
    again = train_tree(data, "tree-bb", samples=240, seed=0)
    assert tree.arrays.keys() == again.arrays.keys()
    assert all(np.array_equal(array, again.arrays[name]) for name, array in tree.arrays.items())


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ({"model": "tree-cb"}, "unknown model 'tree-cb'"),
        ({"model": "tree-pc"}, "needs an encoder"),
        ({"samples": 241}, "a training set of 241 examples; 2 to 240"),
    ],
)
def test_what_no_tree_can_be_grown_of(data, setting, message):
    setting = {"model": "tree-bb", "samples": 20, **setting}
    with pytest.raises(InputError, match=message):
        train_tree(data, setting["model"], samples=setting["samples"], seed=0)
    with pytest.raises(InputError, match="all positive or all negative"):
        train_tree(data.take(np.flatnonzero(data.holds)), "tree-bb", samples=20, seed=0)
