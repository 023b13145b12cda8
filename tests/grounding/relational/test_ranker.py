"""The ranker's logits in numpy are torch's, of features that are worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.relational.measures import RegionFrame
from grounding.relational.ranker import PAIR, POSE, Ranker, features
from grounding.relational.training import RankerNet
from tamp.geometric.scene.pose import Pose
from tests.grounding.forms import TOP, at, box, on_table


def test_numpy_ranks_as_torch_does(scenes: dict[str, Dataset]) -> None:
    net = RankerNet(64, 16)
    ranker = Ranker(net.arrays())
    for example in scenes["on"].take(range(20)):
        view = RegionFrame(example.situation)
        poses = np.repeat(view.T_region_world @ example.situation.body.matrix[None], 5, axis=0)
        poses[:, :2, 3] += np.random.default_rng(0).normal(scale=0.1, size=(5, 2))
        measured = view.measure(poses)
        pose, pair = (torch.tensor(array) for array in features(measured))
        with torch.no_grad():
            logits = net(pose, pair, torch.zeros(pair.shape[:2], dtype=torch.bool)).numpy()
        assert ranker.logits(measured) == pytest.approx(logits, abs=1e-5)


def test_where_nothing_is_around_it_is_as_far_as_can_be() -> None:
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0)))
    poses = np.stack([Pose((0.0, 0.0, 0.02)).matrix, Pose((0.1, 0.0, 0.5)).matrix])
    pose, pair = features(view.measure(poses))
    assert pose.shape == (2, POSE) and pair.tolist() == [[[1, 1, 1, 1, 0]]] * 2


def test_what_is_around_is_told_by_its_distance_its_height_and_its_size() -> None:
    """A cube of 0.1 m, 0.1 m beside the brick; a board of 0.3 m above it, whose height differs by 0.2 m."""
    others = (
        at(box(0.1, 0.1, 0.1), 0.2, 0.0, TOP + 0.05),
        at(box(0.3, 0.3, 0.02), 0.0, 0.0, TOP + 0.25),
    )
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0), *others))
    _, pair = features(view.measure(Pose((0.0, 0.0, 0.02)).matrix[None].copy()))
    assert pair.shape == (1, 2, PAIR)
    for found, apart, over, size in zip(pair[0], (0.1, 0.2), (-0.04, 0.2), (0.1, 0.3), strict=True):
        lengths = (8 * apart, 100 * apart, 8 * over, 100 * over)
        assert found == pytest.approx([*(math.tanh(one) for one in lengths), size], abs=1e-5)


def test_what_is_far_above_is_no_farther_than_the_reach() -> None:
    board = at(box(0.3, 0.3, 0.02), 0.0, 0.0, TOP + 1.0)
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0), board))
    _, pair = features(view.measure(Pose((0.0, 0.0, 0.02)).matrix[None].copy()))
    assert view.obstacles.count == 1 and pair[0, 0, 0] == pytest.approx(math.tanh(8 * 0.4))
