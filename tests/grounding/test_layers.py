"""Layers are read where they fit, and applied as torch applies them."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from grounding.layers import dense, layers_of, sigmoid
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


def test_nothing_negative_goes_on_but_the_last_layer_may_be() -> None:
    """2 and -2 become 2 and 0; the output is 1 - 2."""
    layers = [
        (np.array([[1.0, -1.0], [1.0, -1.0]]), np.zeros(2)),
        (np.array([[-1.0], [5.0]]), np.ones(1)),
    ]
    assert dense(layers, np.ones((3, 2))).tolist() == [[-1.0]] * 3


def test_a_network_that_is_missing_or_without_a_bias() -> None:
    with pytest.raises(ValueError, match="network 'net' is missing"):
        layers_of({"other.0.weight": np.zeros((2, 2))}, "net")
    with pytest.raises(ValueError, match=r"layer 'net\.0' does not fit"):
        layers_of({"net.0.weight": np.zeros((2, 2))}, "net")


def test_the_sigmoid_is_right_where_exponentials_overflow() -> None:
    found = sigmoid(np.array([-1e4, -np.log(3.0), 0.0, np.log(1.5), np.log(3.0), 1e4]))
    assert found == pytest.approx([0.0, 0.25, 0.5, 0.6, 0.75, 1.0])
