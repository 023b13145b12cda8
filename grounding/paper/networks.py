"""The paper's networks (section III-C), as ensembles: M models of one shape are trained at the
dispatch cost of one.

Every tensor has the model first: arguments (M, B, 2 f), others (M, B, K, f), share (M, B, K), the
weight of each of the others in the mean, 1/k or 0 for padding. Features are those of
`grounding.paper.features`, in float32.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from grounding.paper.features import BB, CODE
from grounding.paper.numpy_networks import NOISE
from grounding.paper.rotations import QUADRATIC

SCENE = 16
"""Numbers that the surroundings are pooled into."""

_QUADRATIC = torch.tensor(QUADRATIC, dtype=torch.float32)
_IDENTITY = torch.eye(3).flatten()


@dataclass(frozen=True)
class Batch:
    """M times B scenes; see the module."""

    arguments: Tensor
    others: Tensor
    share: Tensor


def classifier_shapes(
    features: int, scene: bool, attention: bool = False
) -> dict[str, tuple[int, int]]:
    """Return the classifier's layers by name, inputs and outputs: args -> 64-32-1, with the scene's
    embedding when there is one, the others in it weighted by `attention`.
    """
    return {
        **_scene(features, scene, attention),
        **_chain("main", (2 * features + SCENE * scene, 64, 32, 1)),
    }


def critic_shapes(features: int) -> dict[str, tuple[int, int]]:
    """Return the discriminator's layers: args -> 64-32-12-1; it never sees the surroundings."""
    return _chain("main", (2 * features, 64, 32, 12, 1))


def generator_shapes(
    features: int, scene: bool, attention: bool = False
) -> dict[str, tuple[int, int]]:
    """Return the generator's layers, from args (+ scene) + noise through 12-12 to position and
    quaternion.
    """
    return {
        **_scene(features, scene, attention),
        **_chain("main", (2 * features + SCENE * scene + NOISE, 12, 12, 7)),
    }


class Ensemble:
    """The weights of M networks, their gradients and the optimiser's state, each one flat vector.

    `weights` are views of it by name; `fixed` are the same for those who want no gradient for them.

    Args:
        shapes: Layers by name: inputs and outputs. The layer `scene.0` is given arguments and one
            of the others.
        randoms: One source of randomness a model, for its initial weights.
    """

    def __init__(
        self, shapes: Mapping[str, tuple[int, int]], randoms: Sequence[torch.Generator]
    ) -> None:
        count = len(randoms)
        size = count * sum((inputs + 1) * outputs for inputs, outputs in shapes.values())
        self.flat, self.gradient, self.square = (
            torch.zeros(size),
            torch.zeros(size),
            torch.zeros(size),
        )
        self.weights: dict[str, Tensor] = {}
        self._layout = [
            (count, rows, outputs) for inputs, outputs in shapes.values() for rows in (inputs, 1)
        ]  # a matrix and a bias each
        keys = [f"{name}.{key}" for name in shapes for key in ("weight", "bias")]

        for key, tensor, gradient in zip(
            keys, self.parts(self.flat), self.parts(self.gradient), strict=True
        ):
            if key.endswith("weight"):
                bound = (12 / sum(tensor.shape[1:])) ** 0.5  # Xavier's, with the gain of a ReLU
                for model, random in enumerate(randoms):
                    tensor[model].uniform_(-bound, bound, generator=random)
            self.weights[key] = tensor.detach().requires_grad_()
            self.weights[key].grad = gradient

        self.fixed = {name: tensor.detach() for name, tensor in self.weights.items()}

    def parts(self, flat: Tensor) -> list[Tensor]:
        """View a vector laid out like `flat` as matrices (M, inputs, outputs) and biases (M, 1,
        outputs) in turn.
        """
        pieces = flat.split([count * rows * outputs for count, rows, outputs in self._layout])
        return [piece.view(shape) for piece, shape in zip(pieces, self._layout, strict=True)]

    @torch.no_grad()
    def update(self, rate: float) -> None:
        """Take one step of RMSprop (torch's: smoothing 0.99, epsilon 1e-8); the gradient is zero
        afterwards.
        """
        self.square.mul_(0.99).addcmul_(self.gradient, self.gradient, value=0.01)
        self.flat.addcdiv_(self.gradient, self.square.sqrt().add_(1e-8), value=-rate)
        self.gradient.zero_()

    def model(self, index: int) -> dict[str, NDArray[np.float32]]:
        """Return the weights of one of the networks: matrices (inputs, outputs) and biases
        (outputs,).
        """
        return {
            name: (tensor.detach()[index] if name.endswith("weight") else tensor.detach()[index, 0])
            .numpy()
            .copy()
            for name, tensor in self.weights.items()
        }


def score(weights: Mapping[str, Tensor], batch: Batch) -> Tensor:
    """Compute the logits of a classifier, or scores of a critic, shape (M, B)."""
    inputs = batch.arguments
    if "scene.0.weight" in weights:
        inputs = torch.cat([inputs, embedding(weights, batch)], dim=-1)
    return _layers(weights, "main", inputs)[..., 0]


def generate(weights: Mapping[str, Tensor], batch: Batch, noise: Tensor) -> Tensor:
    """Generate the arguments' features with argument 1 where the generator puts it, shape (M, B, 2
    f).
    """
    inputs = [batch.arguments, noise]
    if "scene.0.weight" in weights:
        inputs.insert(1, embedding(weights, batch))
    pose = _layers(weights, "main", torch.cat(inputs, dim=-1))
    return completed(batch.arguments, pose[..., :3], pose[..., 3:])


def completed(arguments: Tensor, positions: Tensor, turns: Tensor) -> Tensor:
    """Complete features as `features.completed` does, for quaternions of any norm, shape (M, B, 2
    f).
    """
    turns = turns / (torch.linalg.vector_norm(turns, dim=-1, keepdim=True) + 1e-8)
    half = arguments.shape[-1] // 2
    if half != BB:
        return torch.cat([arguments[..., :half], positions, turns, arguments[..., -CODE:]], dim=-1)
    own = arguments[..., -6:]
    extents = (own[..., 3:] - own[..., :3]) * 0.5
    reach = (rotations(turns).abs().unflatten(-1, (3, 3)) * extents.unsqueeze(-2)).sum(-1)
    return torch.cat(
        [arguments[..., :BB], positions, positions - reach, positions + reach, turns, own], dim=-1
    )


def rotations(turns: Tensor) -> Tensor:
    """Convert unit quaternions xyzw, shape (..., 4), to rotation matrices row by row, shape (...,
    9).
    """
    products = (turns.unsqueeze(-1) * turns.unsqueeze(-2)).flatten(-2)
    return torch.matmul(products, _QUADRATIC) + _IDENTITY


def embedding(weights: Mapping[str, Tensor], batch: Batch) -> Tensor:
    """Compute the scene's embedding, the mean over the others of (args, other) -> 64-32-16, shape
    (M, B, 16), or with layers `attend` a mean weighted by the softmax of 32-1.

    The first layer's matrix is split, so that the arguments are multiplied once a scene; the last
    layer is linear, so that it may as well follow the mean. A scene without others has the last
    layer's bias.
    """
    models, scenes, others, size = batch.others.shape
    first, bias = weights["scene.0.weight"], weights["scene.0.bias"]
    arguments = torch.baddbmm(bias, batch.arguments, first[:, : 2 * size])
    each = torch.bmm(batch.others.view(models, scenes * others, size), first[:, 2 * size :])
    hidden = (each.view(models, scenes, others, -1) + arguments.unsqueeze(2)).relu_().flatten(1, 2)
    hidden = torch.baddbmm(weights["scene.1.bias"], hidden, weights["scene.1.weight"]).relu_()
    share = batch.share
    if "attend.0.weight" in weights:
        logits = torch.baddbmm(weights["attend.0.bias"], hidden, weights["attend.0.weight"])
        there = share > 0
        masked = logits.view(share.shape).masked_fill(~there, -1e9)
        share = masked.softmax(dim=-1) * there
    pooled = torch.bmm(share.reshape(-1, 1, others), hidden.view(models * scenes, others, -1))
    return torch.baddbmm(
        weights["scene.2.bias"], pooled.view(models, scenes, -1), weights["scene.2.weight"]
    )


def _layers(weights: Mapping[str, Tensor], name: str, x: Tensor) -> Tensor:
    last = sum(key.startswith(name) for key in weights) // 2 - 1
    for number in range(last + 1):
        x = torch.baddbmm(weights[f"{name}.{number}.bias"], x, weights[f"{name}.{number}.weight"])
        if number < last:
            x = x.relu_()
    return x


def _scene(features: int, scene: bool, attention: bool) -> dict[str, tuple[int, int]]:
    if not scene:
        return {}
    attend = _chain("attend", (32, 1)) if attention else {}
    return {**_chain("scene", (3 * features, 64, 32, SCENE)), **attend}


def _chain(name: str, sizes: Sequence[int]) -> dict[str, tuple[int, int]]:
    return {f"{name}.{number}": pair for number, pair in enumerate(pairwise(sizes))}
