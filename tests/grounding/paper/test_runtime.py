"""The paper's models at work: what they propose, how likely they take it to be, and codes of clouds."""

import numpy as np
import pytest

from grounding.paper.features import BB, CODE, BoxFeatures, completed
from grounding.paper.numpy_networks import NOISE
from grounding.paper.rotations import rotations
from grounding.paper.runtime import (
    CHOICE,
    TRIES,
    TURNED,
    NumpyEncoder,
    PaperModel,
    choosing,
    generated,
    scaled,
    unit,
)
from grounding.weights import Weights
from tamp.errors import InputError
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


def encoder_arrays(scale=2.0, points=3):
    """One layer that gives the first three numbers as they are."""
    return {
        "0.weight": np.eye(3, CODE), "0.bias": np.full(CODE, 0.5),
        "scale": np.array(scale), "points": np.array(points),
    }  # fmt: skip


def test_a_code_is_the_largest_of_each_number_over_the_points():
    """Metres are multiplied by two, of the four points three are looked at, and the bias is added at the end."""
    cloud = np.array([[0.1, -0.2, 0.0], [0.3, -0.4, 0.0], [-0.5, -0.6, 0.0], [9.0, 9.0, 9.0]])
    code = NumpyEncoder(encoder_arrays())(cloud)
    assert code[:4] == pytest.approx([1.1, 0.1, 0.5, 0.5]) and code.shape == (CODE,)


def test_a_cloud_is_scaled_by_one_factor_or_to_the_cube():
    cloud = np.array([[0.0, 0.0, 0.0], [0.5, 0.2, -0.1]])
    assert scaled(cloud, 3.0) == pytest.approx(3.0 * cloud)
    assert scaled(cloud, 0.0) == pytest.approx(2.0 * cloud)
    assert np.isfinite(scaled(np.zeros((2, 3)), 0.0)).all()


@pytest.mark.parametrize("name", ["0.weight", "scale", "points"])
def test_an_encoder_is_whole_or_none(name):
    arrays = encoder_arrays()
    del arrays[name]
    with pytest.raises(InputError, match="have no encoder of clouds"):
        NumpyEncoder(arrays)


def test_an_encoder_of_other_codes_is_none():
    arrays = {**encoder_arrays(), "0.weight": np.eye(3), "0.bias": np.zeros(3)}
    with pytest.raises(InputError, match="have no encoder of clouds"):
        NumpyEncoder(arrays)


def test_who_chooses_says_among_how_many():
    weights = Weights({"x": np.zeros(1)}, {"model": "mlp-bb"})
    assert choosing(weights).arrays[TRIES].tolist() == [CHOICE] and TRIES not in weights.arrays
    assert choosing(weights, 3).arrays[TRIES].tolist() == [3.0]
    turned = choosing(weights, 3, turned=True).arrays
    assert turned[TURNED].tolist() == [1.0] and turned[TRIES].tolist() == [3.0]
