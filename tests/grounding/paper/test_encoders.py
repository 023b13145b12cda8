"""Auto-encoders of clouds: they learn, the same seed gives the same, torch's codes are the runtime's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.paper.encoders import (
    ENCODERS,
    SCALINGS,
    chamfer,
    scaled,
    train_encoder,
)
from grounding.paper.posed_clouds import PosedClouds
from tamp.errors import InputError
from tests.grounding.paper.untrained import FEW


@pytest.mark.parametrize("kind", ENCODERS)
@pytest.mark.parametrize("scaling", SCALINGS)
def test_same_seed_same_encoder(data: Dataset, kind: str, scaling: str) -> None:
    (first, score), (again, same) = (train_encoder(data, kind, scaling, FEW) for _ in range(2))
    assert score == same
    assert first.keys() == again.keys()
    assert all(np.array_equal(first[name], again[name]) for name in first)


def test_it_learns(data: Dataset) -> None:
    longer = replace(FEW, iterations=150, validate_every=50, batch=8)
    assert (
        train_encoder(data, "conv", "each", longer)[1]
        < 0.5 * train_encoder(data, "conv", "each", FEW)[1]
    )


def test_chamfer_is_of_the_nearest_points() -> None:
    first, second = torch.rand((2, 20, 3)), torch.rand((2, 20, 3))
    squares = ((first[:, :, None] - second[:, None]) ** 2).sum(-1)
    expected = squares.min(2).values.mean(1) + squares.min(1).values.mean(1)
    assert chamfer(first, second).numpy() == pytest.approx(expected.numpy(), abs=1e-5)


def test_scaled_clouds_fill_the_cube(data: Dataset) -> None:
    clouds = PosedClouds.of(data, "cpu", 256)
    every = clouds.take(torch.arange(len(clouds)))
    assert scaled(every, 0.5 / clouds.radius).abs().max() <= 0.5 + 1e-6
    each = scaled(every, 0.0)
    assert (each.amax(dim=1) - each.amin(dim=1)).amax(dim=1).numpy() == pytest.approx(1.0, abs=1e-5)


def test_an_encoder_of_varied_shapes_needs_no_data(data: Dataset) -> None:
    varied = replace(FEW, shapes="varied")
    arrays, score = train_encoder(None, "conv", "one", varied)
    assert (arrays.keys(), score) == (train_encoder(data, "conv", "one", varied)[0].keys(), score)
    assert float(arrays["scale"]) < 0.5  # the largest of them is larger than a metre
    with pytest.raises(InputError, match="no scenes"):
        train_encoder(None, "conv", "one", FEW)
    with pytest.raises(InputError, match="unknown shapes 'vary'"):
        train_encoder(None, "conv", "one", replace(FEW, shapes="vary"))


def test_unknown_encoders(data: Dataset) -> None:
    with pytest.raises(InputError, match="unknown encoder 'con'"):
        train_encoder(data, "con")
    with pytest.raises(InputError, match="unknown scaling 'a'"):
        train_encoder(data, "conv", "a")
