"""What is trained in torch is the same in numpy."""

import numpy as np
import pytest
import torch

from grounding.paper import networks
from grounding.paper.features import BB, PC, BoxFeatures, completed
from grounding.paper.networks import Batch, Ensemble, generate, score
from grounding.paper.numpy_networks import NOISE, Network
from grounding.paper.rotations import rotations
from grounding.paper.runtime import TRIES, PaperModel, generated, judged, unit
from grounding.weights import Weights
from tamp.errors import InputError

SIGHTS = [(False, False), (True, False), (True, True)]  # scene, attention
CASES = [(size, *sight) for size in (BB, PC) for sight in SIGHTS]


def untrained(size, scene, attention=False):
    """An ensemble of two of each network, and the second's arrays."""
    randoms = [torch.Generator().manual_seed(seed) for seed in range(2)]
    parts = {
        "classifier": Ensemble(networks.classifier_shapes(size, scene, attention), randoms),
        "generator": Ensemble(networks.generator_shapes(size, scene, attention), randoms),
    }
    for part in parts.values():
        for name, tensor in part.fixed.items():
            if name.endswith("bias"):
                tensor.uniform_(-0.1, 0.1, generator=randoms[0])
    arrays = {
        f"{name}.{key}": array
        for name, part in parts.items()
        for key, array in part.model(1).items()
    }
    return parts, arrays


@pytest.fixture(scope="module")
def seen(data):
    observations = [BoxFeatures().observe(example.situation) for example in data]
    chosen = [next(o for o in observations if len(o.others) == count) for count in (0, 1, 3)]
    assert len(chosen) == 3
    return chosen


def as_tensors(seen, size, rng):
    """The same for both models, three scenes with zeros after the last of the others."""
    arguments = np.stack([o.arguments.reshape(-1) for o in seen])
    others, share = np.zeros((3, 4, size)), np.zeros((3, 4))
    for row, o in enumerate(seen):
        others[row, : len(o.others)], share[row, : len(o.others)] = (
            o.others,
            1 / max(1, len(o.others)),
        )
    return Batch(
        *(torch.tensor(np.stack([a, a]), dtype=torch.float32) for a in (arguments, others, share))
    )


def widened(o, rng):
    """Its pose with the code of a cloud."""

    def wide(features):
        return np.concatenate(
            [features[:, :3], features[:, 9:13], rng.normal(size=(len(features), 128))], axis=1
        )

    return type(o)(wide(o.arguments), wide(o.others), o.origin, o.centre, o.extents)


@pytest.mark.parametrize(("size", "scene", "attention"), CASES)
def test_classifier_and_generator_agree_with_torch(size, scene, attention, seen):
    rng = np.random.default_rng(0)
    if size == PC:
        seen = [widened(o, rng) for o in seen]
    parts, arrays = untrained(size, scene, attention)
    batch, noise = as_tensors(seen, size, rng), rng.normal(size=(3, NOISE)).astype(np.float32)
    with torch.no_grad():
        logits = score(parts["classifier"].weights, batch)[1]
        moved = generate(parts["generator"].weights, batch, torch.tensor(np.stack([noise, noise])))
        judgement = torch.sigmoid(
            score(parts["classifier"].weights, Batch(moved, batch.others, batch.share))[1]
        )
    classifier, generator = Network(arrays, "classifier"), Network(arrays, "generator")
    for row, o in enumerate(seen):
        positions, turns = generated(generator, o, noise[row : row + 1])
        argument = completed(o, positions, unit(turns))
        np.testing.assert_allclose(argument[0], moved[1, row, size:], atol=1e-5)
        np.testing.assert_allclose(judged(classifier, o, argument)[0], judgement[row], atol=1e-5)
        as_it_is = judged(classifier, o, o.arguments[1:])[0]
        np.testing.assert_allclose(as_it_is, torch.sigmoid(logits[row]), atol=1e-5)


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


def test_attention_weights_the_surroundings(seen):
    """With all weight on one of the others the embedding is that of this one alone."""
    _, arrays = untrained(BB, True, True)
    network, o = Network(arrays, "classifier"), seen[-1]
    arguments, others = o.arguments.reshape(1, -1).astype(np.float32), o.others.astype(np.float32)
    weight, bias = network.attend[0]
    nothing = np.zeros_like(weight)
    network.attend[0] = (nothing, bias)
    mean = network.context(arguments, others)
    network.attend[:] = []
    np.testing.assert_allclose(network.context(arguments, others), mean, atol=1e-6)
    network.attend[:] = [(1e4 * np.abs(weight), bias)]
    picked = network.context(arguments, others)
    network.attend[:] = []
    alone = [network.context(arguments, others[row : row + 1]) for row in range(len(others))]
    assert min(np.abs(picked - one).max() for one in alone) < 1e-4


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


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {
                "classifier.attend.0.weight": np.zeros((32, 1)),
                "classifier.attend.0.bias": np.zeros(1),
            },
            "attends",
        ),
        ({TRIES: np.zeros(1)}, "'choice.tries' must be one number from 1 to 1000"),
        ({TRIES: np.ones(2)}, "'choice.tries' must be one number"),
        (
            {"classifier.main.0.weight": np.zeros((40, 64))},
            "a classifier of 40 features; known: 38",
        ),
        (
            {"classifier.main.1.weight": np.zeros((63, 32))},
            "layer 'classifier.main.1' does not fit",
        ),
        ({"generator.main.0.weight": np.zeros((7,))}, "layer 'generator.main.0' does not fit"),
        ({"generator.main.0.weight": np.zeros((41, 12))}, "the generator is given 41"),
        (
            {"generator.main.2.weight": np.zeros((12, 6)), "generator.main.2.bias": np.zeros(6)},
            "returns 6",
        ),
    ],
)
def test_arrays_of_something_else_are_refused(change, message):
    _, arrays = untrained(BB, False)
    with pytest.raises(InputError, match=message):
        PaperModel(Weights({**arrays, **change}, {}))


def test_a_missing_network_is_said():
    _, arrays = untrained(BB, False)
    with pytest.raises(InputError, match="the weights have no generator"):
        PaperModel(Weights({k: v for k, v in arrays.items() if "generator" not in k}, {}))
