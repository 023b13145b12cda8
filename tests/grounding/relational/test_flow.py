"""The flow's velocity in numpy is torch's; what it looks at is worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.flow import COORDINATES, Flow, condition, surroundings
from grounding.relational.flow_training import FlowNet, SceneBatch
from grounding.relational.measures import RegionFrame
from grounding.train import measure


def test_numpy_flows_as_torch_does(scenes: dict[str, Dataset]) -> None:
    net, rng = FlowNet(32), np.random.default_rng(0)
    chart = RelationalCoordinates.fit(
        [measure(example) for example in scenes["on"] if example.holds]
    )
    flow = Flow(chart, {**net.arrays(), "scale": np.ones(COORDINATES, np.float32)})
    for example in scenes["on"].take(range(20)):
        view = RegionFrame(example.situation)
        known = np.repeat(condition(view)[:1], 3, axis=0)
        around, half = surroundings(view), np.asarray(view.region.size[:2] / 2, np.float32)
        x, time = (
            rng.normal(size=(3, COORDINATES)).astype(np.float32),
            np.full((3, 1), 0.5, np.float32),
        )
        padded = np.zeros((1, len(around) + 1, 6), np.float32)
        padded[0, : len(around)] = around
        missing = np.arange(len(around) + 1) == len(around)
        several = SceneBatch(
            torch.tensor(known), torch.tensor(padded).expand(3, -1, -1), torch.tensor(missing).expand(3, -1),
            torch.tensor(half).expand(3, -1),
        )  # fmt: skip
        with torch.no_grad():
            expected = net(torch.tensor(x), torch.tensor(time), several).numpy()
        assert flow.velocity(x, time, known, around, half) == pytest.approx(expected, abs=1e-5)
