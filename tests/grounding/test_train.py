"""Training: what cannot be trained is said first; what is trained says what it is of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding import train as module
from grounding.certainty import ENOUGH, REASON
from grounding.dataset import read_dataset
from grounding.train import TrainArgs, check, encoder_of, measure, train
from grounding.weights import Weights, write_weights
from tamp.errors import InputError


@pytest.mark.parametrize(
    ("model", "args", "message"),
    [
        ("flow", TrainArgs(scheme="both"), "model 'flow' has no scheme"),
        ("tree-bb", TrainArgs(iterations=3), "model 'tree-bb' has no iterations"),
        ("mlp-bb", TrainArgs(encoder=Path("e.safetensors")), "model 'mlp-bb' has no encoder"),
        ("gnn-pc", TrainArgs(), "Train one: tamp-learn encoder on"),
        ("uniform", TrainArgs(), "'uniform' needs no training"),
        ("uniform+gnn", TrainArgs(), "Train that: tamp-learn train on --model gnn-bb"),
        ("transfre", TrainArgs(), "Did you mean 'transfer'"),
    ],
)
def test_what_cannot_be_trained_is_said(model: str, args: TrainArgs, message: str) -> None:
    with pytest.raises(InputError, match=message):
        check("on", model, args)


def test_there_must_be_so_many_scenes_and_one_that_holds(stored: Path) -> None:
    data = read_dataset(stored)
    with pytest.raises(InputError, match="has 4 scenes, not 5"):
        train(data, "transfer", TrainArgs(samples=5))
    negative = data.take(np.flatnonzero(~data.holds))
    with pytest.raises(InputError, match="none of the 2 scenes is a positive one"):
        train(negative, "transfer")


def test_few_labels_only_propose_and_the_card_says_of_what(stored: Path) -> None:
    said: list[str] = []
    weights = train(read_dataset(stored), "transfer", TrainArgs(seed=3, commit="abc"), said.append)
    assert said == ["measuring 4 scenes"]
    card = weights.card
    assert (card["relation"], card["model"], card["samples"]) == ("upright", "transfer", 4)
    assert (card["seed"], card["commit"]) == (3, "abc")
    assert card["ranks"] is False and card["classifies"] is False
    assert not any(name.startswith("rank.") for name in weights.arrays)
    assert len(weights.arrays["coordinates"]) == 2  # the two that hold


def test_only_the_first_demonstrations_are_transferred(stored: Path) -> None:
    weights = train(read_dataset(stored), "transfer", TrainArgs(demonstrations=1))
    assert len(weights.arrays["coordinates"]) == 1


def test_an_example_is_measured_where_its_body_is(stored: Path) -> None:
    example = read_dataset(stored)[0]
    measured = measure(example)
    region = example.situation.T_world_region
    assert region @ measured.poses[0] == pytest.approx(example.situation.body.matrix)


def test_an_encoder_is_a_file_of_its_own_or_in_a_model(tmp_path: Path) -> None:
    arrays = {"0.weight": np.ones((3, 128), np.float32)}
    files = {
        "own": Weights(arrays, {"model": "encoder", "kind": "conv"}),
        "model": Weights(
            {f"encoder.{name}": one for name, one in arrays.items()}, {"model": "mlp-pc"}
        ),
    }
    for name, weights in files.items():
        write_weights(tmp_path / name, weights)
        assert {*encoder_of(tmp_path / name).arrays} == {"0.weight"}
    for card in ({"model": "encoder", "kind": "graph"}, {"model": "mlp-bb"}):
        write_weights(tmp_path / "other", Weights(arrays, card))
        with pytest.raises(InputError, match="no encoder of kind 'conv'"):
            encoder_of(tmp_path / "other")


@pytest.mark.parametrize(
    ("score", "why"),
    [
        (0.9, None),
        (0.5, "it is right about 50 %, as saying the same always is"),
        (0.4, "about 40 %"),
    ],
)
def test_a_ranker_that_is_right_as_often_as_chance_does_not_judge(
    score: float, why: str | None, stored: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of many labels the validation split tells it; half of these hold."""

    from grounding.relational import training  # needs torch, as only this test does

    many = read_dataset(stored).take(np.resize(np.arange(4), ENOUGH))
    net = training.RankerNet(8, 4).arrays()
    monkeypatch.setattr(module, "MANY", ENOUGH)
    monkeypatch.setattr(training, "train_ranker", lambda *_: (net, score))
    card = train(many, "transfer").card
    assert card["ranks"] is True and card["validation accuracy"] == score
    assert card["classifies"] is (why is None)
    assert (why or "") in card.get(REASON, "")
