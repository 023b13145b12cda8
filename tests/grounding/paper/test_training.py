import numpy as np
import pytest
import torch

from grounding.paper.encoders import EncoderOptions as EncoderArgs
from grounding.paper.encoders import train_encoder
from grounding.paper.runtime import PaperModel
from grounding.paper.trainer import SCHEMES, Trainer
from grounding.paper.trainer_options import TrainerOptions
from grounding.paper.training import features_of, train
from grounding.weights import Weights
from tamp.errors import InputError

FEW = EncoderArgs(iterations=2, batch=4, validation=4, points=128, validate_every=1)
SETTING = {"sizes": [240, 20], "seeds": [0, 3]}


@pytest.mark.parametrize("model", ["mlp-bb", "gnn-bb"])
def test_a_classifier_learns_the_height(model, data):
    weights = train(data, model, "classifier", sizes=[240], seeds=[0], iterations=300)
    assert weights[0].card["samples"] == 240
    trained = PaperModel(weights[0])
    right = [
        (trained.classify(example.situation, example.situation.body.matrix[None])[0] > 0.5)
        == example.holds
        for example in data.take(range(100))
    ]
    assert np.mean(right) > 0.9


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


def test_a_trained_classifier_is_taken_over_and_nothing_else_changes(data):
    setting = {"sizes": [240, 20], "seeds": [0, 3], "iterations": 4}
    first = train(data, "gnn-bb", "discriminator", **setting)
    alone = train(data, "gnn-bb", "both", **setting)
    lines = []
    taken = train(data, "gnn-bb", "both", **setting, classifiers=first, progress=lines.append)
    assert lines and not any(line.startswith("classifier") for line in lines)
    for one, other in zip(alone, taken, strict=True):
        assert one.card == other.card
        assert all(np.array_equal(one.arrays[name], other.arrays[name]) for name in one.arrays)


def test_codes_about_the_middle_are_in_training_and_in_the_weights(data):
    encoder = Weights(train_encoder(data, "conv", "one", FEW)[0], {})
    setting = {"sizes": [20], "seeds": [0], "iterations": 2, "encoder": encoder}
    (plain,) = train(data, "mlp-pc", "classifier", **setting)
    (about,) = train(data, "mlp-pc", "classifier", departures=["middle-code"], **setting)
    assert about.arrays.keys() - plain.arrays.keys() == {"code.middle"}
    assert about.card["departures"] == ["middle-code"]
    plain_table, about_table = (
        features_of(data, "mlp-pc", encoder, lambda _: None, 20, True, middle)
        for middle in (False, True)
    )
    assert np.array_equal(plain_table.arguments[:, :7], about_table.arguments[:, :7])
    situation = data[0].situation
    codes = [PaperModel(one)._features.observe(situation).arguments[0] for one in (plain, about)]
    rows = [np.abs(about_table.arguments[:, :135] - code).max(axis=1).min() for code in codes]
    assert rows[1] < 1e-4 < rows[0]


def test_another_runs_state_is_refused(data, tmp_path):
    state = tmp_path / "state.safetensors"
    train(data, "mlp-bb", "classifier", sizes=[20], seeds=[0], iterations=2, state=state)
    with pytest.raises(InputError, match="the state of another training"):
        train(data, "mlp-bb", "classifier", sizes=[20], seeds=[1], iterations=2, state=state)
    state.write_bytes(b"nothing")
    with pytest.raises(InputError, match="damaged"):
        train(data, "mlp-bb", "classifier", sizes=[20], seeds=[0], iterations=2, state=state)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"model": "mpl-bb"}, "unknown model 'mpl-bb'"),
        ({"scheme": "boht"}, "unknown scheme 'boht'"),
        ({"sizes": [241], "seeds": [0]}, "training sets of 241 to 241"),
        ({"sizes": [20], "seeds": []}, "1 sizes for 0 seeds"),
        ({"model": "mlp-pc"}, "needs an encoder"),
        ({"departures": ["middle-code"]}, "'mlp-bb' sees no clouds"),
    ],
)
def test_what_cannot_be_trained_is_said(data, change, message):
    setting = {"model": "mlp-bb", "scheme": "both", **SETTING, **change}
    with pytest.raises(InputError, match=message):
        train(data, setting.pop("model"), setting.pop("scheme"), iterations=1, **setting)


def test_threads_are_as_they_were(data):
    before = torch.get_num_threads()
    train(data, "mlp-bb", "classifier", sizes=[20], seeds=[0], iterations=1)
    assert torch.get_num_threads() == before
