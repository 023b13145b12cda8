"""Layers are read where they fit, and applied as torch applies them."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from grounding.layers import dense, layers_of
from grounding.torch_layers import arrays_of


def test_dense_layers_are_checked() -> None:
    net = torch.nn.ModuleList([torch.nn.Linear(3, 4), torch.nn.Linear(4, 2)])
    arrays = arrays_of(net=net)
    x = np.random.default_rng(0).normal(size=(5, 3)).astype(np.float32)
    with torch.no_grad():
        expected = net[1](torch.relu(net[0](torch.tensor(x)))).numpy()
    assert dense(layers_of(arrays, "net", 3, 2), x) == pytest.approx(expected, abs=1e-6)
    for wrong in ({"inputs": 2}, {"outputs": 3}):
        with pytest.raises(ValueError, match="net"):
            layers_of(arrays, "net", **wrong)
    with pytest.raises(ValueError, match=r"net\.1"):
        layers_of({**arrays, "net.1.weight": arrays["net.0.weight"]}, "net")
