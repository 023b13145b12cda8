"""`transfer`: a demonstration with a body of a similar shape, moved to this scene; no generator has
to be trained.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.relational.coordinates import EncodedExample, RelationalCoordinates
from grounding.relational.measures import Measures, RegionFrame
from tamp.geometric.scene.pose import Array

SHARE_JITTER = 0.35
"""How far the horizontal share is moved, of 1."""

SIZE_LIKENESS = 4.0
"""How much a demonstration's weight falls with the squared difference of the bodies' sizes."""

FACE_LIKENESS = 8.0
"""The same for faces."""


@dataclass(frozen=True, eq=False)
class Transfer:
    """Demonstrations to draw from.

    Attributes:
        chart: Their coordinates.
        coordinates: Shape (n, 7).
        faces: Descriptors of the faces that were down, (n, 4).
        sizes: Logarithms of the bodies' extents, (n, 3).
    """

    chart: RelationalCoordinates
    coordinates: Array
    faces: Array
    sizes: Array

    def __post_init__(self) -> None:
        count = len(self.coordinates)
        shapes = (self.coordinates.shape, self.faces.shape, self.sizes.shape)
        if not count or shapes != ((count, 7), (count, 4), (count, 3)):
            raise ValueError(f"demonstrations of shapes {shapes}")

    @classmethod
    def of(cls, chart: RelationalCoordinates, demonstrations: list[EncodedExample]) -> Transfer:
        """Build the transfer from encoded demonstrations."""
        columns = zip(
            *((one.coordinates, one.face, one.size) for one in demonstrations), strict=True
        )
        return cls(chart, *(np.stack(column) for column in columns))

    def draw(self, view: RegionFrame, count: int, rng: Random) -> Measures:
        """Draw `count` poses, measured."""
        faces, coordinates = self.choose(view, count, rng)
        return self.chart.decode(view, faces, coordinates)

    def choose(self, view: RegionFrame, count: int, rng: Random) -> tuple[NDArray[np.intp], Array]:
        """Choose faces (n,) and coordinates (n, 7) from demonstrations."""
        weights = _weights(self, tuple(view.size.tolist()))
        chosen = np.searchsorted(weights, rng.random(count) * weights[-1], side="right")
        chosen = np.minimum(chosen, len(weights) - 1)
        steady = np.flatnonzero(
            view.steadiness >= min(self.chart.steadiness, view.steadiness.max())
        )
        apart = self.faces[chosen][:, None] - view.faces.descriptors[steady]  # (n, f, 4)
        likely = -FACE_LIKENESS * np.einsum("nfk,nfk->nf", apart, apart)
        faces = steady[np.argmax(likely + rng.gumbel(size=likely.shape), axis=1)]
        coordinates = self.coordinates[chosen]
        share = coordinates[:, :2] * rng.choice(
            [-1.0, 1.0], size=(count, 1)
        ) + SHARE_JITTER * rng.normal(size=(count, 2))
        coordinates[:, :2] = 1.0 - np.abs(np.mod(share - 1.0, 4.0) - 2.0)  # reflected into [-1, 1]
        yaw = np.arctan2(coordinates[:, 6], coordinates[:, 5]) + rng.normal(scale=0.5, size=count)
        coordinates[:, 5], coordinates[:, 6] = np.cos(yaw), np.sin(yaw)
        return faces, coordinates


@lru_cache(maxsize=256)
def _weights(transfer: Transfer, size: tuple[float, float, float]) -> Array:
    """Compute the demonstrations' weights for a body of these logarithms of extents, summed up,
    shape (n,).
    """
    apart = transfer.sizes - np.array(size)
    logits = -SIZE_LIKENESS * np.einsum("nk,nk->n", apart, apart)
    return np.cumsum(np.exp(logits - logits.max()))
