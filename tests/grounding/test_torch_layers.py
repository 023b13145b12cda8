"""Layers in torch, and their arrays as numpy reads them."""

from __future__ import annotations

import torch

from grounding.torch_layers import arrays_of, dense_layers, run_layers


def test_layers_are_between_neighbouring_widths() -> None:
    layers = dense_layers([3, 5, 2])
    assert [(layer.in_features, layer.out_features) for layer in layers] == [(3, 5), (5, 2)]


def test_nothing_negative_goes_on_but_the_last_layer_may_be() -> None:
    """Twice (1, 1) to (2, -2) and bias: the hidden layer has 2 and 0, the output 1 - 2 = -1."""
    layers = dense_layers([2, 2, 1])
    with torch.no_grad():
        layers[0].weight.copy_(torch.tensor([[1.0, 1.0], [-1.0, -1.0]]))
        layers[0].bias.zero_()
        layers[1].weight.copy_(torch.tensor([[-1.0, 5.0]]))
        layers[1].bias.fill_(1.0)
        assert run_layers(layers, torch.ones(4, 3, 2)).tolist() == [[[-1.0]] * 3] * 4


def test_arrays_are_inputs_by_outputs_and_of_their_own() -> None:
    layers = dense_layers([3, 5])
    arrays = arrays_of(net=layers)
    assert {name: array.shape for name, array in arrays.items()} == {
        "net.0.weight": (3, 5),
        "net.0.bias": (5,),
    }
    kept = arrays["net.0.weight"].copy(), arrays["net.0.bias"].copy()
    with torch.no_grad():
        assert (kept[0] == layers[0].weight.T.numpy()).all()
        layers[0].weight.add_(1.0)
        layers[0].bias.add_(1.0)
    assert (arrays["net.0.weight"] == kept[0]).all() and (arrays["net.0.bias"] == kept[1]).all()
