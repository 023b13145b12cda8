"""What is trained in torch is the same in numpy."""

import numpy as np

from grounding.paper.features import BB, BoxFeatures, completed
from grounding.paper.numpy_networks import NOISE
from grounding.paper.rotations import rotations
from grounding.paper.runtime import TRIES, PaperModel, generated, unit
from grounding.weights import Weights
from tests.grounding.paper.untrained import untrained


def test_a_proposal_is_the_pose_of_the_generated_features(data):
    _, arrays = untrained(BB, True)
    model, situation = PaperModel(Weights(arrays, {})), data[0].situation
    poses = model.propose(situation, 5, np.random.default_rng(0))
    assert poses.shape == (5, 4, 4)
    noise = np.random.default_rng(0).standard_normal((5, NOISE), dtype=np.float32)
    o = BoxFeatures().observe(situation)
    positions, turns = generated(model.generator, o, noise)
    np.testing.assert_allclose(poses[:, :3, :3], rotations(unit(turns.astype(float))), atol=1e-6)
    box = situation.body.form.corners.mean(axis=0)
    np.testing.assert_allclose(
        poses[:, :3, :3] @ box + poses[:, :3, 3], o.origin + positions, atol=1e-6
    )
    argument = BoxFeatures().at(o, situation, poses)
    expected = completed(o, positions.astype(float), unit(turns.astype(float)))
    same = np.sign(
        (argument[:, 9:13] * expected[:, 9:13]).sum(axis=1)
    )  # q and -q are the same turn
    expected[:, 9:13] *= same[:, None]
    np.testing.assert_allclose(argument, expected, atol=1e-6)


def test_the_same_seed_proposes_the_same(data):
    _, arrays = untrained(BB, False)
    model = PaperModel(Weights(arrays, {}))
    first, again = (model.propose(data[0].situation, 3, np.random.default_rng(4)) for _ in range(2))
    assert np.array_equal(first, again)
    assert model.classify(data[0].situation, first).shape == (3,)


def test_the_own_classifier_chooses(data):
    _, arrays = untrained(BB, True)
    situation = data[0].situation
    chosen = PaperModel(Weights({**arrays, TRIES: np.array([8.0], np.float32)}, {}))
    drawn = PaperModel(Weights(arrays, {}))
    all_of_them = drawn.propose(situation, 24, np.random.default_rng(3))
    likely = drawn.classify(situation, all_of_them).reshape(3, 8)
    found = chosen.propose(situation, 3, np.random.default_rng(3))
    expected = all_of_them.reshape(3, 8, 4, 4)[range(3), likely.argmax(axis=1)]
    np.testing.assert_allclose(found, expected, atol=1e-6)
    assert chosen.propose(situation, 0, np.random.default_rng(3)).shape == (0, 4, 4)
