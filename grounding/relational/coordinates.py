"""Relational coordinates, learned from a few demonstrations: what they have in common is a residual
near zero.

Height is measured between that level of the body and that level of the region whose distance varies
least over the demonstrations; the horizontal position is a share of the room that is left; rotation
is which face is down, a small tilt and a yaw. What all demonstrations keep (room at the sides,
above, around) bounds what is proposed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.relational.kernels import constraint_violations
from grounding.relational.measures import Measures, RegionFrame, turns, upright
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import CONTACT_GAP

CONTAINED = 0.95
"""The share of demonstrations within the rectangle from which on all are thought to be."""

BOUND_SLACK_M = 0.002
"""Metres by which a bound may be missed."""

LEVEL, FLAT = 0.003, 0.05
"""Metres and sine: what physics leaves of a height or a tilt is noise up to these."""

STEADY_LEVEL = 1e-4
"""Metres by which the spreads of two distances may differ and still be alike."""

LEVELS, ANCHORS = 3, 4
"""How many levels of a body and anchors of a region there are."""

WIDEST = 0.12
"""Sine of the largest tilt that is proposed."""


@dataclass(frozen=True, eq=False)
class EncodedExample:
    """One positive example in relational coordinates.

    Attributes:
        coordinates: Horizontal shares x, y, height residual (m), tilt x, y (sines), cosine and sine
            of yaw: (7,).
        face: Descriptor of the face that is down, (4,).
        size: Logarithms of the body's extents, sorted, (3,).
    """

    coordinates: Array
    face: Array
    size: Array


@dataclass(frozen=True)
class RelationalCoordinates:
    """The coordinates of one relation.

    Attributes:
        level: Of the body: 0 its lowest point, 1 its middle, 2 its highest one.
        anchor: Of the region: 0 its plane, 1 its ceiling, 2 the foot of the argument's box, 3 the
            box's middle.
        offset: The usual distance between the two, metres.
        contained: Whether the whole body stays above the rectangle; else its centre of mass. sides,
        balance, ceiling, apart, steadiness: What no demonstration falls below (metres, radians).
    """

    level: int
    anchor: int
    offset: float
    contained: bool
    sides: float
    balance: float
    ceiling: float
    apart: float
    steadiness: float

    @classmethod
    def fit(cls, measured: Sequence[Measures]) -> RelationalCoordinates:
        """Fit the coordinates to positive examples, each of one pose."""
        heights = np.array(
            [_levels(one)[0][:, None] - _anchors(one.view)[None] for one in measured]
        )  # (n, 3, 4)
        finite = np.isfinite(heights).all(axis=0)
        middle = np.median(np.where(finite, heights, 0.0), axis=0)
        spread = np.where(finite, np.median(np.abs(heights - middle), axis=0), np.inf)
        # Where several keep their distance, as on tables of one height all do, the lowest point
        # above the plane counts.
        level, anchor = (int(v) for v in np.argwhere(spread <= spread.min() + STEADY_LEVEL)[0])
        offset = float(middle[level, anchor])
        sides = np.array([one.sides.min() for one in measured])
        low = min(int(0.01 * len(measured)), len(measured) - 1)

        def least(values: Array) -> float:
            return float(np.sort(values)[low])

        return cls(
            level,
            anchor,
            max(offset, CONTACT_GAP) if abs(offset) < LEVEL else offset,
            bool((sides > -BOUND_SLACK_M).mean() >= CONTAINED),
            least(sides),
            least(np.array([one.balance.min() for one in measured])),
            least(np.array([one.ceiling[0] for one in measured])),
            min(least(np.array([one.nearest[0] for one in measured])), BOUND_SLACK_M),
            least(np.array([one.view.steadiness[one.face[0]] for one in measured])),
        )

    @classmethod
    def from_card(cls, card: Mapping[str, Any]) -> RelationalCoordinates:
        """Rebuild the coordinates from a card, the inverse of `card`.

        Raises:
            TypeError: An entry is missing, unknown, or no number or truth value as it should be.
            ValueError: A level or an anchor that there is not.
        """
        numbers = dict(card)
        if numbers.get("ceiling", 0) is None:
            numbers["ceiling"] = math.inf
        chart = cls(**numbers)
        for name, value in numbers.items():
            wanted = {"level": int, "anchor": int, "contained": bool}.get(name, float)
            given = type(value)
            if given is not wanted and not (wanted is float and given is int):
                raise TypeError(f"'{name}' of the chart is {value!r:.40}, not a {wanted.__name__}")
        if chart.level not in range(LEVELS) or chart.anchor not in range(ANCHORS):
            raise ValueError(f"the chart has level {chart.level} and anchor {chart.anchor}")
        return chart

    @property
    def card(self) -> dict[str, Any]:
        """Return the card's entries as JSON knows them, which has no infinite ceiling: None."""
        entries = asdict(self)
        return {**entries, "ceiling": self.ceiling if math.isfinite(self.ceiling) else None}

    def encode(self, measured: Measures) -> EncodedExample:
        """Encode one pose in these coordinates."""
        height = (
            float(_levels(measured)[0, self.level] - _anchors(measured.view)[self.anchor])
            - self.offset
        )
        share = self._share(measured)[0]
        yaw, tilt = float(measured.yaw[0]), measured.tilt[0]
        height = 0.0 if abs(height) < LEVEL else height
        tilt = np.zeros(2) if np.linalg.norm(tilt) < FLAT else tilt
        coordinates = np.array([*share, height, *tilt, np.cos(yaw), np.sin(yaw)])
        view = measured.view
        return EncodedExample(coordinates, view.faces.descriptors[measured.face[0]], view.size)

    def decode(self, view: RegionFrame, face: NDArray[np.intp], coordinates: Array) -> Measures:
        """Decode faces (n,) and coordinates (n, 7) to poses, measured."""
        cosine, sine = coordinates[:, 5], coordinates[:, 6]
        length = np.maximum(np.hypot(cosine, sine), 1e-9)
        rotations = turns(cosine / length, sine / length)
        tilt = np.minimum(np.maximum(coordinates[:, 3:5], -WIDEST), WIDEST)
        if tilt.any():
            rotations = rotations @ upright(tilt)
        poses = np.zeros((len(face), 4, 4))
        poses[:, :3, :3] = rotations @ view.rotations[face]
        poses[:, 3, 3] = 1.0
        still = view.measure(poses)
        still.__dict__["face"] = face
        if self.contained:
            middle = (still.low + still.high)[:, :2] / 2
            room = view.region.size[:2] / 2 - (still.high - still.low)[:, :2] / 2
        else:
            middle, room = (
                still.centre[:, :2],
                np.broadcast_to(view.region.size[:2] / 2, (len(face), 2)),
            )

        positions = np.empty((len(face), 3))
        positions[:, :2] = (
            np.minimum(np.maximum(coordinates[:, :2], -1.0), 1.0) * np.maximum(room, 0.0) - middle
        )
        positions[:, 2] = (
            _anchors(view)[self.anchor]
            + self.offset
            + coordinates[:, 2]
            - _levels(still)[:, self.level]
        )
        return still.moved(positions)

    def constraint_violation(self, measured: Measures) -> Array:
        """Compute the constraint violation: by how much each pose misses what all demonstrations
        keep, metres, 0 for none; shape (n,).
        """
        missing = np.empty(len(measured.poses))
        bounds = (self.sides, self.balance, self.ceiling, self.apart)
        sizes = (
            measured.low,
            measured.high,
            measured.centre,
            measured.nearest,
            measured.view.region.size,
        )
        constraint_violations(*sizes, bounds, BOUND_SLACK_M, missing)
        return missing

    def _share(self, measured: Measures) -> Array:
        half = measured.view.region.size[:2] / 2
        if not self.contained:
            return np.clip(measured.centre[:, :2] / half, -1.0, 1.0)
        room = np.maximum(half - (measured.high - measured.low)[:, :2] / 2, 1e-3)
        return np.clip((measured.low + measured.high)[:, :2] / 2 / room, -1.0, 1.0)


def _levels(measured: Measures) -> Array:
    """Return the body's lowest, middle and highest heights, shape (n, 3)."""
    low, high = measured.low[:, 2], measured.high[:, 2]
    return np.stack([low, (low + high) / 2, high], axis=1)


def _anchors(view: RegionFrame) -> Array:
    """Return the region's plane and ceiling, the foot and the middle of the argument's box, in the
    region's frame, (4,).
    """
    region = view.region
    bottom, top = region.box[0, 2] - region.matrix[2, 3], region.box[1, 2] - region.matrix[2, 3]
    return np.array([0.0, region.size[2], bottom, (bottom + top) / 2])
