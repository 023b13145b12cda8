"""The layers of the paper's networks in numpy: read from arrays, checked, applied."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.weights import REMEDY
from tamp.errors import InputError

Floats = NDArray[np.float32]
Arrays = Mapping[str, NDArray[Any]]

NOISE = 4
"""Gaussian numbers that the generator is given."""


class Network:
    """Matrices and biases of a classifier or a generator.

    Args:
        arrays: Among them `NAME.main.0.weight`, `NAME.main.0.bias`, ..., and perhaps
            `NAME.scene.0.weight`, ...
        name: Which network.

    Raises:
        InputError: There is no such network, or its layers do not fit each other.
    """

    def __init__(self, arrays: Arrays, name: str) -> None:
        self.main, self.scene = (
            read_layers(arrays, f"{name}.main"),
            read_layers(arrays, f"{name}.scene"),
        )
        self.attend = read_layers(arrays, f"{name}.attend")
        if not self.main:
            raise InputError(f"the weights have no {name}", remedy=REMEDY)

    def context(self, arguments: Floats, others: Floats) -> Floats:
        """Compute the embedding of the surroundings, shape (n, 16), or (n, 0) of a network that
        does not look at them.

        Args:
            arguments: Shape (n, 2 f).
            others: Shape (k, f), or of each situation its own (n, k, f).
        """
        if not self.scene:
            return arguments[:, :0]
        (first, bias), (second, bias_2), (third, bias_3) = self.scene
        if not others.shape[-2]:
            return np.broadcast_to(bias_3, (len(arguments), len(bias_3)))
        width = arguments.shape[1]
        hidden = (arguments @ first[:width] + bias)[:, None] + others @ first[width:]
        hidden = np.maximum(np.maximum(hidden, 0, out=hidden) @ second + bias_2, 0)
        pooled = self._weighted(hidden) if self.attend else hidden.mean(axis=1)
        return pooled @ third + bias_3

    def _weighted(self, hidden: Floats) -> Floats:
        """Compute the mean of (n, k, 32) over k, weighted by the softmax of what attends to it."""
        ((weight, bias),) = self.attend
        logits = (hidden @ weight + bias)[:, :, 0]
        shares = np.exp(logits - logits.max(axis=1, keepdims=True))
        shares /= shares.sum(axis=1, keepdims=True)
        return np.einsum("nk,nkh->nh", shares, hidden)

    def __call__(self, inputs: Floats) -> Floats:
        """Apply the layers `main`, shape (n, outputs)."""
        x = inputs
        for weight, bias in self.main[:-1]:
            x = x @ weight
            x += bias
            np.maximum(x, 0, out=x)
        weight, bias = self.main[-1]
        return x @ weight + bias


def check_scene(network: Network, size: int) -> None:
    """Check that the layers for the surroundings are for bodies of `size` features.

    Raises:
        InputError: They are not.
    """
    inputs = network.scene[0][0].shape[0] if network.scene else 3 * size
    if len(network.scene) not in (0, 3) or inputs != 3 * size:
        what = f"the surroundings go through {len(network.scene)} layers, {inputs} numbers a body"
        raise InputError(f"{what}; it should be 3 and {3 * size}", remedy=REMEDY)
    if network.attend and (
        not network.scene or [w.shape for w, _ in network.attend] != [(len(network.scene[1][1]), 1)]
    ):
        raise InputError("what attends to the surroundings does not fit them", remedy=REMEDY)


def check_generator(network: Network, size: int) -> None:
    """Check that a network generates poses of bodies of `size` features.

    Raises:
        InputError: It does not.
    """
    check_scene(network, size)
    inputs, outputs = network.main[0][0].shape[0], network.main[-1][1].shape[0]
    wanted = 2 * size + NOISE + (network.scene[-1][1].shape[0] if network.scene else 0)
    if (inputs, outputs) != (wanted, 7):
        raise InputError(
            f"the generator is given {inputs} numbers and returns {outputs}; "
            f"it should be {wanted} and 7",
            remedy=REMEDY,
        )


def read_layers(arrays: Arrays, prefix: str) -> list[tuple[Floats, Floats]]:
    """Read the layers PREFIX.0, PREFIX.1, ...: matrix (inputs, outputs) and bias (outputs,)."""
    dot = f"{prefix}." if prefix else ""
    layers: list[tuple[Floats, Floats]] = []
    while f"{dot}{len(layers)}.weight" in arrays and f"{dot}{len(layers)}.bias" in arrays:
        weight, bias = (
            np.asarray(arrays[f"{dot}{len(layers)}.{key}"], np.float32)
            for key in ("weight", "bias")
        )
        fits = not layers or layers[-1][0].shape[1] == weight.shape[0]
        if weight.ndim != 2 or bias.shape != weight.shape[1:] or not fits:
            raise InputError(
                f"layer '{dot}{len(layers)}' does not fit: "
                f"matrix {weight.shape}, bias {bias.shape}",
                remedy=REMEDY,
            )
        layers.append((weight, bias))
    return layers
