"""The trainer: each model as if it were trained alone, on from a state, the same for the same seed."""

import numpy as np
import pytest

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


def test_a_model_is_what_it_would_be_if_trained_alone(table):
    together = trained(table, [240, 20], [0, 3], iterations=3)
    alone = trained(table, [20], [3], iterations=3)
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


def test_a_run_goes_on_from_its_state(table, tmp_path):
    class Stop(Exception):
        pass

    def stop(line):
        if line.startswith("generator 2"):
            raise Stop

    args = TrainerOptions(iterations=6, critic_catches_up=3, save_every=2, block=2)
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
