"""Networks in torch: an ensemble's layers, embeddings and steps; numpy computes the same."""

import numpy as np
import pytest
import torch

from grounding.paper.features import BB, PC, completed
from grounding.paper.networks import Batch, Ensemble, critic_shapes, generate, score
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
