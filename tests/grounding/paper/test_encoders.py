"""Auto-encoders of clouds: they learn, the same seed gives the same, torch's codes are the runtime's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.paper.cloud_embeddings import embedding_table
from grounding.paper.encoders import (
    ENCODERS,
    SCALINGS,
    EncoderOptions,
    chamfer,
    scaled,
    train_encoder,
)
from grounding.paper.feature_table import table_of
from grounding.paper.features import CloudFeatures
from grounding.paper.posed_clouds import PosedClouds
from grounding.paper.runtime import NumpyEncoder
from grounding.paper.varied_shapes import PIECES
from tamp.errors import InputError

FEW = EncoderOptions(iterations=2, batch=4, validation=4, points=128, validate_every=1)


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


@pytest.mark.parametrize("scaling", SCALINGS)
@pytest.mark.parametrize("about_middle", [False, True])
def test_codes_of_a_data_set_are_the_runtimes(
    data: Dataset, scaling: str, about_middle: bool
) -> None:
    some = data.take(range(12))
    encoder = NumpyEncoder(train_encoder(data, "conv", scaling, FEW)[0])
    fast = embedding_table(some, encoder, about_middle=about_middle)
    slow = table_of(some, CloudFeatures(encoder, about_middle=about_middle))
    for name in ("arguments", "others", "share", "holds"):
        assert getattr(fast, name) == pytest.approx(getattr(slow, name), abs=1e-5), name


def test_codes_of_few_scenes_without_their_surroundings(data: Dataset) -> None:
    encoder = NumpyEncoder(train_encoder(data, "conv", "one", FEW)[0])
    whole, part = (
        embedding_table(data, encoder),
        embedding_table(data, encoder, count=8, surroundings=False),
    )
    assert len(part.holds) == len(part.others) == 8
    assert not part.others.any() and not part.share.any()
    assert part.arguments == pytest.approx(whole.arguments[:8], abs=1e-5)
    assert np.array_equal(part.holds, whole.holds[:8])


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


def test_varied_shapes_are_furniture_and_bodies_of_all_heights() -> None:
    clouds = PosedClouds.varied(0, "cpu", 64)
    again, other = PosedClouds.varied(0, "cpu", 64), PosedClouds.varied(1, "cpu", 64)
    assert torch.equal(clouds.turn, again.turn) and torch.equal(clouds.unit, again.unit)
    assert not torch.equal(clouds.turn, other.turn)
    scales = clouds.turn.norm(dim=2)
    assert scales.amax(dim=1).numpy() == pytest.approx(scales.amin(dim=1).numpy(), rel=1e-5)
    furniture = clouds.template < PIECES
    assert furniture.float().mean() == pytest.approx(0.5)
    upright = clouds.turn[furniture, 2, 2] / scales[furniture, 2]
    assert upright.numpy() == pytest.approx(1.0, abs=1e-6)
    assert clouds.turn[~furniture, 2, 2].min() < 0


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
