"""`flow`: coordinates from a learned flow that looks, at every step, at what is around where it is;
numpy only.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.layers import dense, layers_of
from grounding.relational.coordinates import FLAT, LEVEL, RelationalCoordinates
from grounding.relational.measures import Measures, RegionFrame
from tamp.geometric.scene.pose import Array

STEPS = 4
"""Of Euler's method from noise to coordinates."""

COORDINATES, CONDITION, AROUND, PAIR, POOLED = 7, 14, 6, 10, 32
"""Numbers of a pose, of a body over a region, of something around, of it and a sample, and of all
that is around.
"""


class Flow:
    """A rectified flow (Liu et al. 2023) in a chart's coordinates, and which face is down.

    Args:
        chart: The coordinates.
        arrays: Networks `face`, `pair`, `velocity`, and `scale`, the size of each coordinate, shape
            (7,).

    Raises:
        KeyError: There is no scale.
        ValueError: The scale is not that of the coordinates.
        ValueError: A network has other numbers of inputs or outputs.
    """

    def __init__(self, chart: RelationalCoordinates, arrays: Mapping[str, NDArray[Any]]) -> None:
        self.chart, self._scale = chart, arrays["scale"]
        if self._scale.shape != (COORDINATES,) or not (self._scale > 0.0).all():
            raise ValueError(
                f"the scale has shape {self._scale.shape}, or no size, "
                f"not one of {COORDINATES} coordinates"
            )
        self._face = layers_of(arrays, "face", CONDITION, 1)
        self._pair = layers_of(arrays, "pair", PAIR, POOLED)
        self._velocity = layers_of(
            arrays, "velocity", COORDINATES + 1 + CONDITION + POOLED, COORDINATES
        )

    def draw(self, view: RegionFrame, count: int, rng: Random) -> Measures:
        """Draw `count` poses, measured."""
        conditions = condition(view)
        logits = dense(self._face, conditions)[:, 0].astype(float)
        logits = np.where(
            view.steadiness >= min(self.chart.steadiness, view.steadiness.max()), logits, -1e3
        )
        face = np.argmax(logits + rng.gumbel(size=(count, len(logits))), axis=1)
        chosen, around = conditions[face], surroundings(view)
        half = (view.region.size[:2] / 2).astype(np.float32) * self._scale[:2]
        x: NDArray[np.float32] = rng.standard_normal((count, COORDINATES), dtype=np.float32)
        for step in range(STEPS):
            time = np.full((count, 1), step / STEPS, np.float32)
            x += self.velocity(x, time, chosen, around, half) / STEPS
        return self.chart.decode(view, face, levelled(x.astype(float) * self._scale))

    def velocity(
        self,
        x: NDArray[np.float32],
        time: NDArray[np.float32],
        conditions: NDArray[np.float32],
        around: NDArray[np.float32],
        half: NDArray[np.float32],
    ) -> NDArray[np.float32]:
        """Compute the flow's velocity of samples (n, 7) at times (n, 1), shape (n, 7).

        Args:
            x: Coordinates in their scale.
            time: From 0, noise, to 1.
            conditions: Of the faces that are down, see `condition`, shape (n, CONDITION).
            around: Shape (m, AROUND).
            half: What takes the first two coordinates to metres, shape (2,).
        """
        pooled = np.zeros((len(x), POOLED), np.float32)
        if len(around):
            pairs = pair_features(x[:, :2] * half, conditions, around)
            pooled = dense(self._pair, np.concatenate(pairs, axis=2)).max(axis=1)
        return dense(self._velocity, np.concatenate([x, time, conditions, pooled], axis=1))


def levelled(coordinates: Array) -> Array:
    """Round heights and tilts that are within what physics leaves to none, as demonstrations have
    them.
    """
    coordinates[:, 2] = np.where(np.abs(coordinates[:, 2]) < LEVEL, 0.0, coordinates[:, 2])
    tilted = np.hypot(coordinates[:, 3], coordinates[:, 4]) >= FLAT
    coordinates[:, 3:5] *= tilted[:, None]
    return coordinates


def condition(view: RegionFrame) -> NDArray[np.float32]:
    """Compute the condition, what is known before a pose is, for each face that may be down, shape
    (f, CONDITION).
    """
    turned = (view.form.vertices @ view.rotations.reshape(-1, 3).T).reshape(-1, len(view.faces), 3)
    extents = np.ptp(turned, axis=0)  # (f, 3)
    region = np.array([view.region.hollow, *np.minimum(view.region.size, 1.5)])
    constant = np.broadcast_to(np.concatenate([view.size / 3 + 1, region]), (len(view.faces), 7))
    return np.concatenate([view.faces.descriptors, 4 * extents, constant], axis=1, dtype=np.float32)


def surroundings(view: RegionFrame) -> NDArray[np.float32]:
    """Describe the surroundings: centre x, y, half extents x, y, bottom and top of what is around,
    metres, shape (m, AROUND).
    """
    around = view.obstacles
    if not around.count:
        return np.zeros((0, AROUND), np.float32)
    middle, half = (around.low + around.high)[:, :2] / 2, (around.high - around.low)[:, :2] / 2
    heights = np.clip(np.stack([around.low[:, 2], around.high[:, 2]], axis=1), -1.0, 1.0)
    return np.concatenate([middle, half, heights], axis=1, dtype=np.float32)


def pair_features(places: Any, conditions: Any, around: Any) -> tuple[Any, ...]:
    """Compute the features of n samples and m things around, parts of shape (n, m, 2) or (n, m, 4),
    PAIR in all; numpy's arrays or torch's.

    Args:
        places: Where the samples are, x and y in the region's frame, shape (n, 2), metres.
        conditions: Of their faces, see `condition`, shape (n, CONDITION).
        around: Shape (m, AROUND), or (n, m, AROUND).
    """
    apart = around[..., :2] - places[:, None]  # (n, m, 2)
    half = conditions[:, None, 4:6] / 8 + 0 * apart  # half the body's extents
    gap = abs(apart) - around[..., 2:4] - half
    return 4 * apart, 8 * gap, 8 * half, 8 * (around[..., 2:] + 0 * apart[..., :1])
