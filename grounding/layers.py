"""Fully connected networks in numpy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Layers = Sequence[tuple[Floats, Floats]]
"""Weight (in, out) and bias (out,) of each layer."""


def layers_of(
    arrays: Mapping[str, NDArray[Any]],
    name: str,
    inputs: int | None = None,
    outputs: int | None = None,
) -> Layers:
    """Read the layers that are kept as `NAME.0.weight`, `NAME.0.bias`, `NAME.1.weight`, ...

    Raises:
        ValueError: They do not fit each other, or have other numbers of inputs or outputs.
    """
    layers: list[tuple[Floats, Floats]] = []
    while f"{name}.{len(layers)}.weight" in arrays:
        row = len(layers)
        weight, bias = arrays[f"{name}.{row}.weight"], arrays.get(f"{name}.{row}.bias")
        wanted = layers[-1][0].shape[1] if layers else inputs
        if (
            weight.ndim != 2
            or bias is None
            or bias.shape != weight.shape[1:]
            or wanted not in (None, len(weight))
        ):
            raise ValueError(f"layer '{name}.{row}' does not fit")
        layers.append((weight, bias))
    if not layers or outputs not in (None, layers[-1][0].shape[1]):
        raise ValueError(f"network '{name}' is missing, or has not {outputs} outputs")
    return layers


def dense(layers: Layers, x: NDArray[Any]) -> Floats:
    """Apply dense layers, ReLU after every layer but the last; (..., in) to (..., out)."""
    for row, (weight, bias) in enumerate(layers):
        x = x @ weight + bias
        if row < len(layers) - 1:
            x = np.maximum(x, 0.0)
    return x


def sigmoid(x: NDArray[Any]) -> NDArray[Any]:
    """Compute the logistic sigmoid, stable for large arguments."""
    return np.where(
        x >= 0, 1.0 / (1.0 + np.exp(-np.abs(x))), np.exp(-np.abs(x)) / (1.0 + np.exp(-np.abs(x)))
    )
