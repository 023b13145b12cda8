"""The trainer: each model as if it were trained alone, on from a state, the same for the same seed."""

import numpy as np
import pytest
import torch
from torch.nn.functional import softplus

from grounding.paper.networks import Batch, score
from grounding.paper.trainer import SCHEMES, Trainer
from grounding.paper.trainer_options import TrainerOptions
from grounding.paper.training import features_of


@pytest.fixture(scope="module")
def table(data):
    return features_of(data, "gnn-bb", None, lambda _: None)


def trained(table, sizes, seeds, scheme="both", **args):
    trainer = Trainer(
        table, True, scheme, sizes, seeds, TrainerOptions(critic_catches_up=2, **args)
    )
    trainer.run()
    return list(trainer.models())


VARIED = {"turned": True, "scaled": True, "residual": True}


@pytest.mark.parametrize("varied", [{}, VARIED])
def test_a_model_is_what_it_would_be_if_trained_alone(table, varied):
    together = trained(table, [240, 20], [0, 3], iterations=3, **varied)
    alone = trained(table, [20], [3], iterations=3, **varied)
    assert len(together[1]) == 24
    for name, array in together[1].items():
        np.testing.assert_allclose(array, alone[0][name], atol=1e-4)
    assert not np.array_equal(
        together[0]["generator.main.0.weight"], together[1]["generator.main.0.weight"]
    )


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_same_seed_gives_the_same_weights(table, scheme):
    once, again = (trained(table, [240, 20], [0, 3], scheme, iterations=3) for _ in range(2))
    assert all(
        np.array_equal(a[name], b[name]) for a, b in zip(once, again, strict=True) for name in a
    )


@pytest.mark.parametrize("varied", [{}, VARIED])
def test_a_run_goes_on_from_its_state(table, tmp_path, varied):
    class Stop(Exception):
        pass

    def stop(line):
        if line.startswith("generator 2"):
            raise Stop

    args = TrainerOptions(iterations=6, critic_catches_up=3, save_every=2, block=2, **varied)
    whole, cut, resumed = (Trainer(table, True, "both", [240, 20], [0, 3], args) for _ in range(3))
    whole.run()
    state = tmp_path / "state.safetensors"
    with pytest.raises(Stop):
        cut.run(state, stop)
    lines = []
    resumed.run(state, lines.append)
    assert lines[0] == "going on after 6 + 0 iterations"
    for expected, found in zip(whole.models(), resumed.models(), strict=True):
        assert all(np.array_equal(expected[name], found[name]) for name in expected)


def test_a_mean_that_keeps_all_of_itself_never_moves(table):
    options = TrainerOptions(iterations=3, critic_catches_up=2, mean_weights=1.0)
    trainer = Trainer(table, True, "both", [240], [0], options)
    first = next(trainer.models())
    trainer.run()
    last = next(trainer.models())
    for name, array in first.items():
        moved = not np.array_equal(array, last[name])
        assert moved is name.startswith("classifier"), name


def test_classifiers_that_are_taken_over_are_those_that_come_out(table):
    given = trained(table, [240, 20], [0, 3], "classifier", iterations=3)
    options = TrainerOptions(iterations=3, critic_catches_up=2)
    trainer = Trainer(table, True, "discriminator", [240, 20], [0, 3], options)
    trainer.take_classifiers(given)
    lines = []
    trainer.run(progress=lines.append)
    assert [line.split()[0] for line in lines] == ["generator"]
    for one, found in zip(given, trainer.models(), strict=True):
        for name in (name for name in one if name.startswith("classifier")):
            assert np.array_equal(one[name], found[name])


def test_the_classifiers_gradient_is_brought_to_the_critics_length(table):
    options = TrainerOptions(iterations=1, critic_catches_up=2, scaled_classifier=True)
    trainer = Trainer(table, True, "both", [240, 20], [0, 3], options)
    trainer.critic.flat.mul_(7.0)  # as one that is far ahead
    seen = trainer._scenes.batch(torch.arange(16).expand(2, 16))
    proposed = Batch(seen.arguments.clone().requires_grad_(), seen.others, seen.share)

    def slope(loss):
        return torch.autograd.grad(loss, proposed.arguments)[0]

    both = slope(trainer._scaled_loss(proposed))
    critic = slope(-score(trainer.critic.fixed, proposed).sum())
    lengths = [one.norm(dim=2).mean(dim=1) for one in (both - critic, critic)]
    torch.testing.assert_close(lengths[0], lengths[1])
    alone = slope(softplus(-score(trainer.classifier.fixed, proposed)).sum())
    unscaled = alone.norm(dim=2).mean(dim=1)
    assert ((unscaled / lengths[1] - 1).abs() > 0.1).all()  # they were not of one length before


@pytest.mark.parametrize(("size", "spared"), [(20, 0), (99, 0), (100, 10), (240, 24)])
def test_a_tenth_of_a_training_set_is_spared_of_a_hundred_or_more(table, size, spared):
    trainer = Trainer(table, True, "both", [size], [0])
    assert trainer._spared[0].tolist() == list(range(size - spared, size))
    assert trainer._seen[0].tolist() == list(range(size - spared))
