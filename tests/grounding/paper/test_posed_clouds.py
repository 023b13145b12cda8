"""Clouds that an encoder is trained on: a data set's bodies, or varied shapes."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from grounding.body_geometry import BodyGeometry
from grounding.dataset import Dataset
from grounding.paper.clouds import cloud
from grounding.paper.posed_clouds import PosedClouds, centred
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


def test_a_data_sets_clouds_are_its_bodies_turned_and_scaled(data: Dataset) -> None:
    some = data.take(range(6))
    clouds = PosedClouds.of(some, "cpu", 32)
    expected = [
        item.matrix[:3, :3]
        for scene in some
        for item in (scene.situation.support, scene.situation.body)
    ]
    assert len(clouds) == int((some.arrays["body"] >= 0).sum())
    assert clouds.unit.shape == (len(data.templates), 32, 3)
    first = clouds.take(torch.tensor([1]))[0].numpy()  # the body of the first scene
    body = some[0].situation.body
    points = cloud(BodyGeometry(body.form.unit.parts))[:2048]
    points = (points - points.mean(axis=0))[:32] * body.form.scale
    assert first == pytest.approx(points @ expected[1].T, abs=1e-5)


def test_the_radius_is_that_of_the_farthest_point(data: Dataset) -> None:
    clouds = PosedClouds.of(data.take(range(6)), "cpu", 32)
    farthest = clouds.take(torch.arange(len(clouds))).norm(dim=2).max()
    assert clouds.radius == pytest.approx(float(farthest), rel=1e-5)


def test_a_centred_cloud_is_about_its_centroid(data: Dataset) -> None:
    points, centroid = centred(BodyGeometry(data.templates["brick"]))
    assert points.mean(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
    assert points + centroid == pytest.approx(cloud(BodyGeometry(data.templates["brick"])))
