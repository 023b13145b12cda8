"""Training: what cannot be trained is said before anything is read."""

from __future__ import annotations

from pathlib import Path

import pytest

from grounding.train import TrainArgs, check
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
