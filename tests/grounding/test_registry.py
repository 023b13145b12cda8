"""Groundings by name: what ships, what needs no weights, and what is said of weights that are none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding import registry
from grounding.paper.trainer_options import HEADLINE_SCHEME
from grounding.registry import (
    GROUNDINGS,
    MODELS,
    PARAMETER_FREE,
    RELATIONS,
    SHARED_WEIGHTS,
    TRAINING_VARIANTS,
    load_model,
    shipped_model,
    shipped_weights,
)
from grounding.train import OPTIONS, TRAINERS
from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError
from tamp.geometric.samplers.placements import SurfacePlacements
from tamp.geometric.samplers.sampler import Generator


def test_every_name_is_a_grounding_and_every_trained_one_has_a_trainer() -> None:
    assert {*MODELS} == {*TRAINERS, *SHARED_WEIGHTS}
    assert all(models and {*models} <= {*TRAINERS} for models in OPTIONS.values())
    for relation in RELATIONS:
        assert {*GROUNDINGS[relation]} == {*MODELS, *TRAINING_VARIANTS, *PARAMETER_FREE}
        assert isinstance(GROUNDINGS[relation]["surface"](), SurfacePlacements)  # the planner's own


@pytest.mark.parametrize("relation", RELATIONS)
@pytest.mark.parametrize("name", [*MODELS, *TRAINING_VARIANTS, *PARAMETER_FREE])
def test_every_name_ships(relation: str, name: str) -> None:
    assert shipped_model(relation, name)
    assert isinstance(GROUNDINGS[relation][name](), Generator)
    if name not in PARAMETER_FREE:
        card = read_weights(shipped_weights(relation, name)).card
        assert card["relation"] == relation
        assert card["commit"] and card["data"]["split"] == "train"
        headline = HEADLINE_SCHEME.get(relation) if card["data"].get("layout") == "paper" else None
        assert card.get("scheme", "both") == (
            name.rpartition("-")[2] if name in TRAINING_VARIANTS else headline or "both"
        )


def test_what_ships_is_small() -> None:
    assert sum(path.stat().st_size for path in registry.SHIPPED.iterdir()) < 15e6


def test_weights_that_do_not_ship(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "SHIPPED", tmp_path)
    with pytest.raises(
        InputError,
        match=r"tamp-learn train inside --model gnn-bb --out .*inside_gnn-bb\.safetensors",
    ):
        shipped_model("inside", "uniform+gnn")
    with pytest.raises(
        InputError,
        match=r"train on --model mlp-bb --scheme classifier --out .*on_mlp-bb-classifier",
    ):
        shipped_model("on", "mlp-bb-classifier")
    with pytest.raises(InputError, match="Did you mean 'uniform'"):
        shipped_model("on", "unifrom")
    with pytest.raises(InputError, match="unknown relation 'under'"):
        shipped_model("under", "uniform")


@pytest.mark.parametrize("name", TRAINERS)
@pytest.mark.parametrize(
    "arrays",
    [
        {},
        {"x": np.zeros(3)},
        {
            f"{part}.main.0.{key}": np.zeros((38,))
            for part in ("classifier", "generator")
            for key in ("weight", "bias")
        },
        {
            f"tree.{key}": np.zeros(19)
            for key in ("feature", "threshold", "left", "right", "positive", "low", "high")
        },
        {
            name: np.zeros((2, 2))
            for name in ("coordinates", "faces", "sizes", "rank.pose.0.weight")
        },
    ],
)
def test_garbage_is_refused_in_one_line(
    tmp_path: Path, name: str, arrays: dict[str, np.ndarray]
) -> None:
    path = tmp_path / "some.safetensors"
    write_weights(path, Weights(arrays, {"model": name, "relation": "on"}))
    with pytest.raises(InputError, match="some") as caught:
        load_model(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("trained", "wanted", "message"),
    [
        (
            "mlp-bb",
            "uniform+gnn",
            "these are weights of 'mlp-bb'; 'uniform\\+gnn' is not made of them",
        ),
        ("flow", "uniform", "these are weights of 'flow'; 'uniform' is not made of them"),
        ("mlp-bb", "uniform+mpl", "Did you mean 'uniform\\+mlp'"),
        ("encoder", None, "unknown model 'encoder'"),
    ],
)
def test_weights_of_something_else(
    tmp_path: Path, trained: str, wanted: str | None, message: str
) -> None:
    path = tmp_path / "some.safetensors"
    write_weights(path, Weights({}, {"model": trained, "relation": "on"}))
    with pytest.raises(InputError, match=message):
        load_model(path, wanted)
