"""Charts: in what coordinates the place of a demonstration is carried over to another situation."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from grounding.relations.carrying import coordinates_of
from grounding.relations.catalogue import frame_names
from grounding.relations.measure_kernels import heading
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

FREE = -1
"""In the place of a frame: any angle."""

MODES = (
    "middle",
    "edge",
    "share",
    "room",
    "gap",
    "line",
    "anywhere",
    "left",
    "right",
    "front",
    "rear",
)
"""The ways in which a position is carried over: the offset of the middles, of the edges, as a
share of the other body's half width, of the room inside it, as the gap in a direction, along a
line; and on furniture anywhere, or so far from one of its edges.
"""

FURNITURE_MODES = MODES[6:]

PERIODS, DEARER = (2 * np.pi, np.pi, np.pi / 2), (0.0, 0.5, 1.0)
"""Angles in which a yaw may be the same again, radians, and nats against them."""

MOST_AGREED = 2.0
"""Nats of agreement that count, at most, of each coordinate."""

UNNATURAL = 1.0
"""Nats against the world's axes."""

RESOLUTION = 0.012
"""What a hand cannot place better than, metres."""

HAND = 0.14
"""The same of a yaw, radians."""


@dataclass(frozen=True)
class Chart:
    """Coordinates of argument 0.

    Attributes:
        origin: The argument that it is measured from; 0 for the furniture.
        frame: Index of the horizontal frame, or FREE.
        mode: Index of MODES.
        turn: What its yaw is measured from: index of a frame, the number of frames + j - 1 for
            the direction to argument j, or FREE.
    """

    origin: int
    frame: int
    mode: int
    turn: int


def charts(k: int) -> list[Chart]:
    """List the charts of situations of k arguments."""
    frames = len(frame_names(k))
    turns = [FREE, 1, 0, *range(2, frames + k - 1)]
    listed = [
        Chart(0, 1, MODES.index(mode), turn)
        for mode in (FURNITURE_MODES if k == 1 else FURNITURE_MODES[:1])
        for turn in turns
    ]
    places = list(itertools.product(range(1, k), (1, 0, FREE, *range(2, 1 + k)), range(5)))
    if k > 2:
        places.append((1, frames - 1, MODES.index("line")))
    listed += [Chart(*place, turn) for place in places for turn in turns]
    return listed


@dataclass(frozen=True, eq=False)
class Carried:
    """Demonstrations in the coordinates of charts: c charts, d demonstrations.

    Attributes:
        codes: Of the charts, (c, 4).
        place: Coordinates, (c, d, 2).
        outside: Side of the other body on which it is, by axis, 0 for none, (c, d, 2).
        yaw: Angle of what the yaw is measured from, (c, d).
        R: Rotations of argument 0, (d, 3, 3).
    """

    codes: NDArray[np.int64]
    place: Array
    outside: Array
    yaw: Array
    R: Array

    def chosen(self, rows: NDArray[np.intp]) -> Carried:
        """Return some of the charts."""
        return Carried(
            self.codes[rows], self.place[rows], self.outside[rows], self.yaw[rows], self.R
        )


def agreement(shown: Carried, base: Carried) -> Array:
    """Return by how many nats demonstrations agree more in each chart's coordinates, and in the yaw
    that it keeps, than chance does, (c,).
    """
    yaw = np.stack([_concentration(_yaws(shown), period) for period in PERIODS])
    yaw = np.clip(yaw - np.array(DEARER)[:, None], 0.0, MOST_AGREED).max(axis=0)
    yaw = np.where(shown.codes[:, 3] == FREE, 0.0, yaw)
    yaw -= UNNATURAL * (shown.codes[:, 3] == 0)

    ratio = base.place.std(axis=1) / (shown.place.std(axis=1) + RESOLUTION)
    place = np.clip(np.log(np.maximum(ratio, 1e-9)), 0.0, MOST_AGREED)
    place[:, 1] = np.where(shown.codes[:, 1] == FREE, 0.0, place[:, 1])
    place = place.sum(axis=1) - UNNATURAL * (shown.codes[:, 1] == 0)
    return yaw + np.where(shown.codes[:, 0] == 0, 0.0, place)


def _yaws(shown: Carried) -> Array:
    """Return the yaw of argument 0 against what each chart keeps it from, (c, d)."""
    own = np.array([heading(R) for R in shown.R])
    return own - shown.yaw


def _concentration(angles: Array, period: float) -> Array:
    """Return how much less angles (c, d) spread than any angles of a period would, nats, (c,)."""
    length = np.abs(np.exp(2j * np.pi * angles / period).mean(axis=1))
    spread = np.sqrt(-2.0 * np.log(np.clip(length, 1e-9, 1.0))) * period / (2 * np.pi)
    return np.log(period / np.sqrt(12.0) / np.maximum(spread, HAND))


def carried(shown: Situations, listed: list[Chart]) -> Carried:
    """Express demonstrations in charts."""
    codes = np.array([(one.origin, one.frame, one.mode, one.turn) for one in listed])
    place = np.zeros((len(listed), len(shown), 2))
    outside, yaw = np.zeros_like(place), np.zeros(place.shape[:2])
    s = shown
    coordinates_of(
        s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, codes, place, outside, yaw
    )
    return Carried(codes, place, outside, yaw, s.R[:, 0].copy())
