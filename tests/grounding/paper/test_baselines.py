"""The paper's baselines: uniform samplers and decision trees, and the engineer's reference."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from sklearn.tree import DecisionTreeClassifier

from grounding.oracles import paper_oracle
from grounding.paper import networks, uniform
from grounding.paper.encoders import EncoderOptions, train_encoder
from grounding.paper.feature_table import table_of
from grounding.paper.features import BB, BoxFeatures, poses_of
from grounding.paper.networks import Ensemble
from grounding.paper.rotations import quaternions
from grounding.paper.tree_training import grown, train_tree
from grounding.paper.trees import Tree, TreeModel, position_limits
from grounding.paper.uniform import TRIES, UniformModel
from grounding.surface import SurfaceModel
from grounding.weights import Weights
from tamp.errors import InputError


def random_classifier(size, scene, bias=0.0):
    part = Ensemble(networks.classifier_shapes(size, scene), [torch.Generator().manual_seed(0)])
    arrays = {f"classifier.{name}": array for name, array in part.model(0).items()}
    last = max(name for name in arrays if ".main." in name and name.endswith("bias"))
    return Weights({**arrays, last: arrays[last] + np.float32(bias)}, {})


@pytest.fixture(scope="module")
def tree(data):
    return train_tree(data, "tree-bb", samples=240, seed=0)


@pytest.fixture(scope="module")
def encoder(data):
    few = EncoderOptions(iterations=2, batch=4, validation=4, points=64, validate_every=1)
    return Weights(train_encoder(data, "conv", "one", few)[0], {})


def models(data):
    yield UniformModel()
    yield from (UniformModel(random_classifier(BB, scene)) for scene in (False, True))
    yield TreeModel(train_tree(data, "tree-bb", samples=60, seed=0))
    yield SurfaceModel()


def test_same_draws_same_poses(data):
    situation = data[0].situation
    for model in models(data):
        first, again = (model.propose(situation, 3, np.random.default_rng(5)) for _ in range(2))
        assert first.shape == (3, 4, 4)
        assert np.array_equal(first, again)
        np.testing.assert_allclose(
            first[:, :3, :3] @ first[:, :3, :3].transpose(0, 2, 1), [np.eye(3)] * 3, atol=1e-9
        )
        assert model.propose(situation, 0, np.random.default_rng(5)).shape == (0, 4, 4)
        assert model.classify(situation, first).shape == (3,)


def test_uniform_fills_the_grown_box(data):
    situation = data[3].situation
    poses = UniformModel().propose(situation, 4000, np.random.default_rng(0))
    box = situation.body.form.corners.mean(axis=0)
    centres = poses[:, :3, :3] @ box + poses[:, :3, 3] - situation.support.matrix[:3, 3]
    half = np.array([0.4, 0.3, 0.2]) + 0.2  # half of the largest half extent on each side
    assert (np.abs(centres) <= half).all()
    np.testing.assert_allclose(np.abs(centres).max(axis=0), half, atol=0.01)
    np.testing.assert_allclose(centres.mean(axis=0), 0, atol=0.03)
    np.testing.assert_allclose(poses[:, :3, :3].mean(axis=0), np.zeros((3, 3)), atol=0.04)
    assert np.isnan(UniformModel().classify(situation, poses[:2])).all()


@pytest.mark.parametrize("scene", [False, True])
def test_what_the_classifier_accepts_is_taken(data, scene):
    situation = next(example.situation for example in data if len(example.situation.others) == 2)
    drawn = UniformModel().propose(situation, 500, np.random.default_rng(0))
    likely = np.quantile(UniformModel(random_classifier(BB, scene)).classify(situation, drawn), 0.9)
    model = UniformModel(random_classifier(BB, scene, bias=-np.log(likely / (1 - likely))))
    assert (model.classify(situation, drawn) > 0.5).mean() == pytest.approx(0.1, abs=0.01)
    assert (
        model.classify(situation, model.propose(situation, 20, np.random.default_rng(0))) > 0.5
    ).all()


def test_at_most_500_tries(data, monkeypatch):
    judged = []

    def count(network, seen, argument):
        judged.append(len(argument))
        return np.zeros(len(argument))

    monkeypatch.setattr(uniform, "judged", count)
    model = UniformModel(random_classifier(BB, False))
    assert model.propose(data[0].situation, 2, np.random.default_rng(0)).shape == (2, 4, 4)
    assert judged == [*TRIES, *TRIES]
    assert sum(TRIES) == 500


def test_a_classifier_of_clouds_is_refused(data, encoder):
    weights = random_classifier(135, False)
    arrays = {
        **weights.arrays,
        **{f"encoder.{name}": array for name, array in encoder.arrays.items()},
    }
    with pytest.raises(InputError, match="needs a classifier of boxes"):
        UniformModel(Weights(arrays, {}))
    with pytest.raises(InputError, match="have no classifier"):
        UniformModel(Weights({}, {}))


def test_a_tree_knows_what_it_was_trained_on(data, tree):
    model = TreeModel(tree)
    for example in data.take(range(60)):
        assert (
            model.classify(example.situation, example.situation.body.matrix[None])[0]
            == example.holds
        )


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


def test_the_surface_sampler_stands_bodies_on_the_region(data):
    model, good = SurfaceModel(), []
    for example in data.take(range(30)):
        situation = example.situation
        poses = model.propose(situation, 10, np.random.default_rng(0))
        alone = type(situation)(situation.support, situation.region, situation.body, ())
        assert paper_oracle(alone, poses).all()
        assert model.classify(alone, poses).all()
        bottom = [
            (situation.body.form.vertices @ p[:3, :3].T + p[:3, 3])[:, 2].min() for p in poses
        ]
        np.testing.assert_allclose(bottom, situation.T_world_region[2, 3], atol=0.002)
        good.append(model.classify(situation, situation.body.matrix[None])[0] <= example.holds)
    assert all(
        good
    )  # what floats or is sunken is said to; a body among others may be said to collide


def test_the_surface_sampler_has_nothing_under_a_low_ceiling(data):
    situation = data[0].situation
    low = type(situation.region)(
        False, situation.region.matrix, np.array([0.8, 0.6, 0.01]), situation.region.box
    )
    under = type(situation)(situation.support, low, situation.body, situation.others)
    assert SurfaceModel().propose(under, 3, np.random.default_rng(0)).shape == (0, 4, 4)


def test_poses_there_and_back(data):
    seen = BoxFeatures().observe(data[1].situation)
    pose = data[1].situation.body.matrix[None]
    again = poses_of(seen, seen.arguments[1:, :3], quaternions(pose[:, :3, :3]))
    np.testing.assert_allclose(again, pose, atol=1e-12)
