"""Networks in torch: an ensemble's layers, embeddings and steps; numpy computes the same."""

import numpy as np
import pytest
import torch

from grounding.paper.features import BB, PC, completed
from grounding.paper.networks import (
    Batch,
    Ensemble,
    classifier_shapes,
    critic_shapes,
    embedding,
    generate,
    generator_shapes,
    score,
)
from grounding.paper.numpy_networks import NOISE, Network
from grounding.paper.runtime import generated, judged, unit
from tests.grounding.paper.untrained import untrained

SIGHTS = [(False, False), (True, False), (True, True)]  # scene, attention


CASES = [(size, *sight) for size in (BB, PC) for sight in SIGHTS]


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


def test_a_step_of_the_optimiser_is_torchs_rmsprop():
    ensemble = Ensemble(critic_shapes(BB), [torch.Generator().manual_seed(0)])
    weights = [tensor.detach().clone().requires_grad_() for tensor in ensemble.weights.values()]
    optimiser = torch.optim.RMSprop(weights, lr=1e-3)
    random = torch.Generator().manual_seed(1)
    for _ in range(3):
        for mine, other in zip(ensemble.parts(ensemble.gradient), weights, strict=True):
            other.grad = torch.randn(other.shape, generator=random)
            mine.copy_(other.grad)
        optimiser.step()
        ensemble.update(1e-3)
    assert ensemble.gradient.abs().max() == 0
    for mine, other in zip(ensemble.weights.values(), weights, strict=True):
        torch.testing.assert_close(mine, other)


def test_layers_are_the_papers():
    assert classifier_shapes(BB, False) == {
        "main.0": (38, 64), "main.1": (64, 32), "main.2": (32, 1)
    }  # fmt: skip
    assert generator_shapes(BB, False)["main.0"] == (38 + NOISE, 12)
    assert generator_shapes(BB, True) == {
        "scene.0": (57, 64), "scene.1": (64, 32), "scene.2": (32, 16),
        "main.0": (38 + 16 + NOISE, 12), "main.1": (12, 12), "main.2": (12, 7),
    }  # fmt: skip
    assert classifier_shapes(BB, True, attention=True)["attend.0"] == (32, 1)
    assert critic_shapes(PC)["main.0"] == (270, 64) and critic_shapes(PC)["main.3"] == (12, 1)


@pytest.mark.parametrize("attention", [False, True])
def test_a_scene_without_others_has_the_last_layers_bias(attention):
    parts, _ = untrained(BB, True, attention)
    weights = parts["classifier"].weights
    random = torch.Generator().manual_seed(5)
    others, arguments = (
        torch.randn(shape, generator=random) for shape in ((2, 3, 4, BB), (2, 3, 2 * BB))
    )
    share = torch.zeros(2, 3, 4)
    share[:, 1, 0] = 1.0
    found = embedding(weights, Batch(arguments, others, share))
    bias = weights["scene.2.bias"].expand(2, 3, -1)
    torch.testing.assert_close(found[:, [0, 2]], bias[:, [0, 2]])
    assert (found[:, 1] - bias[:, 1]).abs().max() > 1e-3
    padded = others.clone()
    padded[:, 1, 1:] = 9.0  # what has no share does not count
    torch.testing.assert_close(embedding(weights, Batch(arguments, padded, share)), found)


def test_a_model_of_an_ensemble_starts_as_it_would_alone():
    """Bounds are Xavier's with the gain of a ReLU; biases are zero."""
    shapes = classifier_shapes(BB, False)
    together = Ensemble(shapes, [torch.Generator().manual_seed(seed) for seed in (3, 4)])
    alone = Ensemble(shapes, [torch.Generator().manual_seed(4)]).model(0)
    assert all((array == alone[name]).all() for name, array in together.model(1).items())
    bound = (12 / (38 + 64)) ** 0.5
    weight = alone["main.0.weight"]
    assert weight.shape == (38, 64) and 0.95 * bound < np.abs(weight).max() <= bound
    assert not alone["main.0.bias"].any()
