"""The uniform samplers: the box that they fill, the classifier that accepts, at most 500 tries."""

import numpy as np
import pytest

from grounding.paper import uniform
from grounding.paper.features import BB
from grounding.paper.uniform import TRIES, UniformModel
from grounding.weights import Weights
from tamp.errors import InputError
from tests.grounding.paper.untrained import random_classifier


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
