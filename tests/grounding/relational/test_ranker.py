"""The ranker's logits in numpy are torch's, of features that are worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.relational.measures import RegionFrame
from grounding.relational.ranker import Ranker, features
from grounding.relational.training import RankerNet


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
