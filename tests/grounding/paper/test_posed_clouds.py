"""Clouds that an encoder is trained on: a data set's bodies, or varied shapes."""

from __future__ import annotations

import pytest
import torch

from grounding.paper.posed_clouds import PosedClouds
from grounding.paper.varied_shapes import PIECES


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
