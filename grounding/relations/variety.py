"""Lack of variety in demonstrations, and what they say both ways, before anything is learned."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from grounding.relations.catalogue import measure
from grounding.relations.evidence import SAME_SIZE
from grounding.relations.measure_kernels import heading
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

SAME_HEIGHT = 0.03
"""Heights that differ by less count as one, metres."""

SAME_SPOT = 0.03
"""Places on furniture that differ by less count as one, metres."""

SAME_YAW = 0.25
"""Yaws whose spread is less count as one, radians: a hand keeps one to 8 degrees."""

FINE = 1e-4
"""Metres and radians in which two situations with both labels differ at most."""

GOOD = 10
"""Labels of each kind that are asked for."""


def contradiction(situations: Situations, holds: NDArray[np.bool_]) -> tuple[int, int] | None:
    """Return two situations that are the same with opposite labels; None where there are none."""
    values = np.round(measure(situations) / FINE)
    seen: dict[bytes, int] = {}
    for row in range(len(situations)):
        sizes = np.round(situations.half[situations.shape[row]] / FINE)
        key = values[row].tobytes() + sizes.tobytes()
        first = seen.setdefault(key, row)
        if holds[first] != holds[row]:
            return first, row
    return None


def unvaried(
    situations: Situations, holds: NDArray[np.bool_], names: Sequence[str]
) -> list[tuple[str, str]]:
    """Return what is the same wherever the relation holds: a key, and a sentence with its remedy.

    Args:
        situations: Of all demonstrations.
        holds: Their labels, (n,).
        names: Of the arguments, for messages.
    """
    shown = situations.rows(np.flatnonzero(holds))
    if len(shown) < 2:
        return []
    return [
        *_heights(shown), *_yaws(shown, names), *_sizes(shown, names), *_spots(shown, names)
    ]  # fmt: skip


def missing(holds: NDArray[np.bool_]) -> list[str]:
    """Return which labels are missing."""
    yes, no = int(holds.sum()), int((~holds).sum())
    found: list[str] = []
    if not no:
        found.append(f"nothing shows where it does not hold: show about {GOOD}, best near misses")
    elif no < GOOD // 2:
        found.append(f"only {no} show where it does not hold: show about {GOOD}, best near misses")
    if yes < GOOD // 2:
        found.append(f"only {yes} show where it holds: show about {GOOD}")
    return found


def _heights(shown: Situations) -> Iterator[tuple[str, str]]:
    height = shown.support[:, 0]
    if np.ptp(height) < SAME_HEIGHT:
        text = f"all surfaces were {np.median(height):.2g} m high: show one of another height"
        yield "height", text


def _yaws(shown: Situations, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    n, k = shown.shape.shape
    front = shown.support[:, 1]
    elsewhere = _spread(front) >= SAME_YAW
    if not elsewhere:
        yield "yaw", "all furniture was turned the same way: show it on one that faces elsewhere"
    for j in range(k):
        yaw = np.array([heading(shown.R[row, j]) for row in range(n)])
        if _spread(yaw) < SAME_YAW:
            yield f"yaw of {j}", f"{names[j]} was always turned the same way: turn it"
        elif elsewhere and 0 < j < shown.arguments and _spread(yaw - front) < SAME_YAW:
            # Then left of it and left on the furniture are the same.
            text = f"{names[j]} was always turned the same way on the furniture: turn it"
            yield f"yaw of {j} on it", text


def _sizes(shown: Situations, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    for j in range(shown.arguments):
        sizes = shown.half[shown.shape[:, j]]
        if (np.ptp(sizes, axis=0) < SAME_SIZE * sizes.mean(axis=0)).all():
            side = " x ".join(f"{200 * one:.3g}" for one in sizes[0])
            yield f"size of {j}", f"{names[j]} was always {side} cm large: show one of another size"


def _spots(shown: Situations, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    c, s = np.cos(shown.support[:, 1]), np.sin(shown.support[:, 1])
    for j in range(1, shown.arguments):
        x, y = (shown.p[:, j, :2] - shown.support[:, 2:4]).T
        spot = np.stack([c * x + s * y, c * y - s * x])
        if (np.ptp(spot, axis=1) < SAME_SPOT).all() and np.ptp(shown.support[:, 4]) > 0.0:
            text = f"{names[j]} was always in the same place of the furniture: show it elsewhere"
            yield f"place of {j}", text


def _spread(angles: Array) -> float:
    """Return the circular standard deviation, radians."""
    length = float(np.abs(np.exp(1j * angles).mean()))
    return float(np.sqrt(-2.0 * np.log(max(min(length, 1.0), 1e-12))))
