"""Layers in numpy: read from arrays that fit, or refused; the surroundings are pooled."""

import numpy as np
import pytest

from grounding.paper.features import BB
from grounding.paper.numpy_networks import Network
from grounding.paper.runtime import TRIES, PaperModel
from grounding.weights import Weights
from tamp.errors import InputError
from tests.grounding.paper.untrained import untrained


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


def test_layers_are_applied_with_nothing_negative_between_them():
    """2 and -2 become 2 and 0; the output is 1 - 2."""
    arrays = {
        "net.main.0.weight": np.array([[1.0, -1.0], [1.0, -1.0]]), "net.main.0.bias": np.zeros(2),
        "net.main.1.weight": np.array([[-1.0], [5.0]]), "net.main.1.bias": np.ones(1),
    }  # fmt: skip
    network = Network(arrays, "net")
    assert network(np.ones((3, 2), np.float32)).tolist() == [[-1.0]] * 3
    assert network.context(np.ones((3, 2), np.float32), np.ones((4, 1), np.float32)).shape == (3, 0)


def test_where_nothing_is_around_the_embedding_is_the_last_layers_bias():
    _, arrays = untrained(BB, True)
    network = Network(arrays, "classifier")
    found = network.context(np.ones((3, 2 * BB), np.float32), np.zeros((0, BB), np.float32))
    assert np.array_equal(found, np.tile(arrays["classifier.scene.2.bias"], (3, 1)))


def test_surroundings_of_other_bodies_are_refused():
    _, arrays = untrained(BB, True)
    with pytest.raises(
        InputError, match="go through 3 layers, 60 numbers a body; it should be 3 and 57"
    ):
        PaperModel(Weights({**arrays, "classifier.scene.0.weight": np.zeros((60, 64))}, {}))
    del arrays["classifier.scene.2.weight"]
    with pytest.raises(InputError):
        PaperModel(Weights(arrays, {}))
