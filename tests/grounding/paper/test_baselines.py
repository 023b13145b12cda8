"""What the paper's baselines and the engineer's reference have in common; the reference among its data."""

import numpy as np

from grounding.oracles import paper_oracle
from grounding.paper.features import BB
from grounding.paper.tree_training import train_tree
from grounding.paper.trees import TreeModel
from grounding.paper.uniform import UniformModel
from grounding.surface import SurfaceModel
from tests.grounding.paper.untrained import random_classifier


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
