"""Clouds that an encoder is trained on: of a data set's bodies, or of varied shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from grounding.body_geometry import BodyGeometry
from grounding.dataset import Dataset
from grounding.paper.clouds import POINTS, cloud
from grounding.paper.rotations import rotations
from grounding.paper.varied_shapes import varied_shapes, varied_supports

VARIED_CLOUDS = 20_000
"""Posed clouds of varied shapes, half of them of furniture."""

FURNITURE_SCALE, BODY_SCALE = (0.6, 1.4), (0.4, 1.8)
"""Factors of varied shapes, drawn uniformly."""


@dataclass(frozen=True, eq=False)
class PosedClouds:
    """The bodies of a data set's scenes: clouds of scale 1 about their centroids, and each one's
    scale and rotation.

    Attributes:
        unit: Shape (templates, points, 3).
        template: Shape (n,).
        turn: Scale times rotation, shape (n, 3, 3).
    """

    unit: Tensor
    template: Tensor
    turn: Tensor

    @classmethod
    def of(cls, data: Dataset, device: str, points: int = POINTS) -> PosedClouds:
        """Collect the clouds of all bodies of all scenes."""
        unit = np.stack(
            [centred(BodyGeometry(parts))[0][:points] for parts in data.templates.values()]
        )
        there = data.arrays["body"] >= 0
        turn = data.arrays["scale"][there][:, None, None] * data.arrays["pose"][there][:, :3, :3]
        return cls(
            torch.tensor(unit, dtype=torch.float32, device=device),
            torch.tensor(data.arrays["body"][there].astype(np.int64), device=device),
            torch.tensor(turn, dtype=torch.float32, device=device),
        )

    @classmethod
    def varied(cls, seed: int, device: str, points: int = POINTS) -> PosedClouds:
        """Draw VARIED_CLOUDS clouds: furniture turned by any yaw, bodies by that or anyhow."""
        rng = np.random.default_rng(seed)
        shapes = varied_shapes(seed)
        pieces = len(varied_supports(seed=seed))  # the first ones
        unit = np.stack([centred(BodyGeometry(parts))[0][:points] for parts in shapes.values()])
        count = VARIED_CLOUDS // 2
        template = np.concatenate(
            [rng.integers(pieces, size=count), rng.integers(pieces, len(shapes), size=count)]
        )
        scale = np.concatenate(
            [rng.uniform(*FURNITURE_SCALE, count), rng.uniform(*BODY_SCALE, count)]
        )
        turns = rng.standard_normal((2 * count, 4))
        turns[: count + count // 2, :2] = 0.0  # about the vertical axis
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        mixed = rng.permutation(2 * count)
        turn = scale[:, None, None] * rotations(turns)
        return cls(
            torch.tensor(unit, dtype=torch.float32, device=device),
            torch.tensor(template[mixed], device=device),
            torch.tensor(turn[mixed], dtype=torch.float32, device=device),
        )

    def __len__(self) -> int:
        return len(self.template)

    @property
    def radius(self) -> float:
        """Return the radius of the ball that contains every cloud, metres."""
        largest = self.unit.norm(dim=2).amax(dim=1)[self.template]
        return float((largest * self.turn[:, 0].norm(dim=1)).max())

    def take(self, rows: Tensor) -> Tensor:
        """Select posed clouds, shape (rows, points, 3), metres."""
        rows = rows.to(self.template.device)
        return self.unit[self.template[rows]] @ self.turn[rows].transpose(1, 2)


def centred(form: BodyGeometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centre a form's cloud about its centroid; return both."""
    points = cloud(form)
    centroid = points.mean(axis=0)
    return points - centroid, centroid
