import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.paper.encoders import train_encoder
from grounding.paper.runtime import RESIDUAL, TURNED, PaperModel
from grounding.paper.training import features_of, train
from grounding.weights import Weights
from tamp.errors import InputError
from tests.grounding.paper.untrained import FEW

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
        ({"departures": ["edge-negatives"]}, "lacks negatives close by the limits"),
        ({"model": "mlp-pc", "departures": ["turned-scenes"]}, "turned-scenes is for models on bo"),
        (
            {"model": "gnn-pc", "departures": ["turned-proposals"]},
            "turned-proposals is for models on boxes",
        ),
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


def test_data_with_negatives_at_the_edges_are_a_departure(data):
    edges = Dataset(data.arrays, data.templates, data.kinds, {**data.card, "edges": True})
    setting = {"sizes": [20], "seeds": [0], "iterations": 1}
    with pytest.raises(InputError, match="has negatives close by the limits"):
        train(edges, "mlp-bb", "classifier", **setting)
    (made,) = train(edges, "mlp-bb", "classifier", departures=["edge-negatives"], **setting)
    assert made.card["data"]["edges"] is True


def test_scenes_are_turned_and_scaled_where_that_is_asked_for(data):
    setting = {"sizes": [20], "seeds": [0], "iterations": 2}
    ways = [(), ("turned-scenes",), ("scaled-scenes",), ("turned-scenes", "residual-turn")]
    made = [train(data, "gnn-bb", "discriminator", departures=way, **setting)[0] for way in ways]
    layers = [one.arrays["generator.main.0.weight"].tobytes() for one in made]
    assert len({*layers}) == len(ways)
    assert [RESIDUAL in one.arrays for one in made] == [False, False, False, True]


def test_turned_proposals_are_asked_for_in_the_weights(data):
    setting = {"sizes": [20], "seeds": [0], "iterations": 1}
    (made,) = train(data, "mlp-bb", "classifier", departures=["turned-proposals"], **setting)
    assert TURNED in made.arrays
