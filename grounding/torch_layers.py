"""Fully connected networks in torch, whose weights `grounding.layers` reads."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn


def dense_layers(widths: Sequence[int]) -> nn.ModuleList:
    """Make dense layers between these widths."""
    return nn.ModuleList(nn.Linear(a, b) for a, b in pairwise(widths))


def run_layers(layers: nn.ModuleList, x: Tensor) -> Tensor:
    """Apply the layers, ReLU after every layer but the last; (..., in) to (..., out)."""
    for row, layer in enumerate(layers):
        x = layer(x)
        if row < len(layers) - 1:
            x = torch.relu(x)
    return x


def arrays_of(**networks: nn.ModuleList) -> dict[str, NDArray[np.float32]]:
    """Return weights (in, out) and biases by name, as `grounding.layers.layers_of` reads them."""
    found: dict[str, NDArray[np.float32]] = {}
    for name, layers in networks.items():
        for key, value in layers.named_parameters():
            array = value.detach().numpy()
            found[f"{name}.{key}"] = array.T.copy() if array.ndim == 2 else array.copy()
    return found
