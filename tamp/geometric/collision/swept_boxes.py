"""Swept volumes as boxes: what keeps out of them cannot be hit, and need not be looked at.

A broad phase for tests of one motion against many bodies, one at a time. Boxes are along the
world's axes, one for each convex part that moves.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.collision.tables import CENTRE, FRAME, SIZE, SLIDES_COLUMN
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

ROUNDED_M = 1e-6
"""What boxes are grown by, metres, so that rounding never makes one too small."""


@dataclass(frozen=True, eq=False)
class SweptBoxes:
    """The boxes around all that some parts sweep.

    Attributes:
        low, high: Their corners (n, 3), metres.
    """

    low: Array
    high: Array

    @classmethod
    def union(cls, several: Iterable[SweptBoxes]) -> SweptBoxes:
        """Collect the boxes of several motions."""
        boxes = list(several)
        return cls(
            np.concatenate([one.low for one in boxes]), np.concatenate([one.high for one in boxes])
        )

    def meet(self, low: Float[Array, " 3"], high: Float[Array, " 3"], padding: float) -> bool:
        """Check whether any of them is within `padding` metres, along each axis, of a box with
        corners (3,).
        """
        reach = padding + ROUNDED_M
        within = (self.low <= high + reach) & (self.high >= low - reach)
        return bool(within.all(axis=1).any())


def swept_balls(
    frames: Float[Array, "m 4 4"], centres: Float[Array, "n 3"], radii: Float[Array, " n"]
) -> SweptBoxes:
    """Box balls that move with a frame: centres (n, 3) in it, radii (n,), its poses (m, 4, 4)."""
    at = centres @ frames[:, :3, :3].transpose(0, 2, 1) + frames[:, None, :3, 3]
    return SweptBoxes(at.min(axis=0) - radii[:, None], at.max(axis=0) + radii[:, None])


def swept_by_robot(
    arrangements: Sequence[Arrangement], paths: Sequence[Float[Array, "m conf"]]
) -> SweptBoxes:
    """Box all that a robot sweeps on paths, polylines (m, 3 + n) of configurations, whatever it
    holds in the arrangements.

    Between two configurations no point is farther from where it is in one of them than half of
    the bound on its way.
    """
    grown: list[Array] = []
    for path in paths:
        half = np.max([one.motion_bound(path[:-1], path[1:]) for one in arrangements], axis=0) / 2
        grown.append(np.maximum(np.append(half, 0.0), np.insert(half, 0, 0.0)))
    by = np.concatenate(grown)[:, None, None]

    joints = arrangements[0].tables.joints
    parts = np.concatenate([one.tables.parts for one in arrangements])
    poses = np.concatenate([one.tables.part_poses for one in arrangements])
    low, high = part_boxes(joints, parts, poses, np.concatenate(paths))
    return SweptBoxes((low - by).min(axis=0).T, (high + by).max(axis=0).T)


def part_boxes(
    joints: Float[Array, "j 13"], parts: Float[Array, "n width"], poses: Float[Array, "n 12"],
    confs: Float[Array, "m conf"],
) -> tuple[Float[Array, "m 3 n"], Float[Array, "m 3 n"]]:  # fmt: skip
    """Compute low and high corners (m, 3, n) of the boxes around a robot's n parts at
    configurations (m, 3 + j), from its rows in `Tables`; the parts in the order of their frames.
    """
    order = np.argsort(parts[:, FRAME], kind="stable")
    parts, poses = parts[order], poses[order]
    ends = np.searchsorted(parts[:, FRAME], np.arange(len(joints) + 2)).tolist()
    local, offset = poses[:, :9].reshape(-1, 3, 3), poses[:, 9:]
    centres = ((local @ parts[:, CENTRE : CENTRE + 3, None])[..., 0] + offset).T
    # Columns of a frame's parts side by side: half an extent of each along its own axes.
    spans = (local * parts[:, None, SIZE : SIZE + 3]).transpose(1, 0, 2)

    middle, half = (np.empty((len(confs), 3, len(parts))) for _ in range(2))
    for frame, (turn, place) in enumerate(_frames(joints, confs)):
        first, last = ends[frame], ends[frame + 1]
        if first == last:
            continue
        middle[:, :, first:last] = turn @ centres[:, first:last] + place[:, :, None]
        turned = np.abs(turn @ spans[:, first:last].reshape(3, -1))
        half[:, :, first:last] = turned.reshape(len(confs), 3, last - first, 3).sum(axis=3)
    return middle - half, middle + half


def _frames(joints: Array, confs: Array) -> Iterator[tuple[Array, Array]]:
    """Yield rotations (m, 3, 3) and origins (m, 3) of the base, then of each joint: forward
    kinematics.
    """
    turns = _about_z(confs[:, 2:])
    turn, place = turns[:, 0], np.zeros((len(confs), 3))
    place[:, :2] = confs[:, :2]
    yield turn, place

    for j, origin in enumerate(joints, 1):
        place = turn @ origin[9:12] + place
        turn = turn @ origin[:9].reshape(3, 3)
        if origin[SLIDES_COLUMN] > 0.0:
            place = place + confs[:, 2 + j, None] * turn[:, :, 2]
        else:
            turn = turn @ turns[:, j]
        yield turn, place


def _about_z(angles: Array) -> Array:
    """Compute rotations (..., 3, 3) about z by angles (...)."""
    turns = np.zeros((*angles.shape, 3, 3))
    turns[..., 0, 0] = turns[..., 1, 1] = np.cos(angles)
    turns[..., 1, 0] = np.sin(angles)
    turns[..., 0, 1], turns[..., 2, 2] = -turns[..., 1, 0], 1.0
    return turns
