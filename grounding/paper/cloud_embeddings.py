"""The features of a whole data set's point clouds, encoded in batches: what a body is turned like
is in its code.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from grounding.body_geometry import BodyGeometry
from grounding.dataset import Dataset
from grounding.paper.clouds import cloud
from grounding.paper.encoders import scaled
from grounding.paper.feature_table import FeatureTable, order
from grounding.paper.features import PC, UNTURNED
from grounding.paper.posed_clouds import centred
from grounding.paper.rotations import quaternions
from grounding.paper.runtime import NumpyEncoder
from grounding.relation_scene import Placed

BATCH = {"cpu": 16, "cuda": 512}
"""Clouds that are encoded at once."""


def embedding_table(
    data: Dataset,
    encoder: NumpyEncoder,
    progress: Callable[[str], None] = lambda _: None,
    device: str = "cpu",
    *,
    count: int | None = None,
    surroundings: bool = True,
    residual: bool = True,
    about_middle: bool = False,
) -> FeatureTable:
    """Compute the table of `table_of` with `CloudFeatures(encoder, residual, about_middle)` by
    torch; agrees to 1e-5.

    Args:
        data: The scenes.
        encoder: What codes the clouds.
        progress: Told how far it is.
        device: Where torch computes.
        count: Only so many scenes, the first of `order`.
        surroundings: Whether the other bodies are encoded as well; they are most of the work.
        residual, about_middle: See `CloudFeatures`.
    """
    indices = order(data.holds)[:count]
    scenes = [data[int(index)].situation for index in indices]
    around = [scene.others if surroundings else () for scene in scenes]
    placed = [
        item
        for scene, others in zip(scenes, around, strict=True)
        for item in (scene.support, scene.body, *others)
    ]
    numbers: dict[BodyGeometry, int] = {}
    template = np.array([numbers.setdefault(item.form.unit, len(numbers)) for item in placed])
    clouds = [centred(form) for form in numbers]
    centroids = np.stack([centroid for _, centroid in clouds])
    scale = np.array([item.form.scale for item in placed])
    matrices = np.stack([item.matrix for item in placed])
    rotations = matrices[:, :3, :3]
    features = np.empty((len(placed), PC), np.float32)
    middle = (rotations @ (centroids[template] * scale[:, None])[:, :, None])[:, :, 0] + matrices[
        :, :3, 3
    ]
    features[:, 3:7] = UNTURNED if residual else quaternions(rotations)
    if residual:
        middle = matrices[:, :3, 3] + np.stack([_extent_middle(item) for item in placed])
    unit = np.stack([points for points, _ in clouds])
    encode = _TorchEncoder(encoder, unit, device, about_middle)
    batch = BATCH.get(device, 512)
    for start in range(0, len(placed), batch):
        rows = slice(start, start + batch)
        features[rows, 7:] = encode(template[rows], scale[rows, None, None] * rotations[rows])
        if start // batch % 200 == 199:
            progress(f"codes of {start + batch} of {len(placed)} clouds")

    sizes = np.array([2 + len(others) for others in around])
    first = np.cumsum(sizes) - sizes
    features[:, :3] = middle - np.repeat(middle[first], sizes, axis=0)
    slots = np.arange(max(1, sizes.max() - 2))
    there = slots < sizes[:, None] - 2
    others = np.zeros((*there.shape, PC), np.float32)
    others[there] = features[np.setdiff1d(np.arange(len(placed)), [first, first + 1])]
    share = np.where(there, 1 / np.maximum(sizes[:, None] - 2, 1), 0).astype(np.float32)
    arguments = np.concatenate([features[first], features[first + 1]], axis=1)
    return FeatureTable(arguments, others, share, data.holds[indices])


def _extent_middle(item: Placed) -> NDArray[np.float64]:
    """Return the middle of the extent of a turned cloud, shape (3,), from the body's origin."""
    points = cloud(item.form) @ item.matrix[:3, :3].T
    return (points.min(axis=0) + points.max(axis=0)) / 2


class _TorchEncoder:
    """A `NumpyEncoder` and clouds of scale 1, shape (templates, points, 3), on a device."""

    def __init__(
        self,
        encoder: NumpyEncoder,
        unit: NDArray[np.float64],
        device: str,
        about_middle: bool = False,
    ) -> None:
        self._device, self._scale, self._points = device, encoder.scale, encoder.points
        self._about_middle = about_middle
        self._unit = self._tensor(unit)
        self._layers = [
            (self._tensor(weight), self._tensor(bias)) for weight, bias in encoder.layers
        ]

    @torch.no_grad()
    def __call__(
        self, template: NDArray[np.intp], turn: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        """Encode clouds of these templates turned and scaled by (n, 3, 3); codes of shape (n,
        CODE).
        """
        points = self._unit[torch.tensor(template, device=self._device)] @ self._tensor(
            turn
        ).transpose(1, 2)
        if self._about_middle:
            points -= (points.amin(dim=1, keepdim=True) + points.amax(dim=1, keepdim=True)) / 2
        x = scaled(points, self._scale)[:, : self._points]
        for weight, bias in self._layers[:-1]:
            x = torch.relu_(x @ weight + bias)
        weight, bias = self._layers[-1]
        return ((x @ weight).amax(dim=1) + bias).cpu().numpy()

    def _tensor(self, array: NDArray[Any]) -> Tensor:
        return torch.tensor(array, dtype=torch.float32, device=self._device)
