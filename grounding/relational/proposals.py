"""`transfer`: a demonstration with a body of a similar shape, moved to this scene; no generator has to be trained."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.relational.chart import Chart, Demonstration
from grounding.relational.measures import View, face_descriptors
from tamp.world.pose import Array

JITTER = 0.35
"""How far the horizontal share is moved, of 1."""

SIMILAR = 4.0
"""How much a demonstration's weight falls with the squared difference of the bodies' sizes."""

ALIKE = 8.0
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

    chart: Chart
    coordinates: Array
    faces: Array
    sizes: Array

    @classmethod
    def of(cls, chart: Chart, demonstrations: list[Demonstration]) -> Transfer:
        """From encoded demonstrations."""
        columns = zip(*((one.coordinates, one.face, one.size) for one in demonstrations), strict=True)
        return cls(chart, *(np.stack(column) for column in columns))

    def draw(self, view: View, count: int, rng: Random) -> Array:
        """`count` poses T_region_body, shape (n, 4, 4)."""
        faces, coordinates = self.choose(view, count, rng)
        return self.chart.decode(view, faces, coordinates)

    def choose(self, view: View, count: int, rng: Random) -> tuple[NDArray[np.intp], Array]:
        """Faces (n,) and coordinates (n, 7) taken from demonstrations."""
        size = np.sort(np.log(np.ptp(view.form.corners, axis=0)))
        chosen = _draw(-SIMILAR * ((self.sizes - size) ** 2).sum(axis=1), count, rng)
        descriptors = face_descriptors(view.form)
        apart = ((self.faces[chosen][:, None] - descriptors) ** 2).sum(axis=2)  # (n, f)
        scores = np.where(view.steadiness >= min(self.chart.steadiness, view.steadiness.max()), -ALIKE * apart, -1e3)
        faces = np.argmax(scores + rng.gumbel(size=scores.shape), axis=1)
        coordinates = self.coordinates[chosen].copy()
        share = coordinates[:, :2] * rng.choice([-1.0, 1.0], size=(count, 1)) + JITTER * rng.normal(size=(count, 2))
        coordinates[:, :2] = 1.0 - np.abs(np.mod(share - 1.0, 4.0) - 2.0)  # reflected into [-1, 1]
        yaw = np.arctan2(coordinates[:, 6], coordinates[:, 5]) + rng.normal(scale=0.5, size=count)
        coordinates[:, 5], coordinates[:, 6] = np.cos(yaw), np.sin(yaw)
        return faces, coordinates


def _draw(logits: Array, count: int, rng: Random) -> NDArray[np.intp]:
    weights = np.exp(logits - logits.max())
    return rng.choice(len(logits), size=count, p=weights / weights.sum())
