"""Lack of variety in a data set of demonstrations: what is the same in all of them, and what they
say both ways.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from grounding.dataset import Dataset

SAME_LENGTH = 0.002
"""Metres by which heights and sizes may differ and still be one."""

SAME_ANGLE = 0.02
"""Radians, of yaws."""

FINE = 1e-5
"""Metres, and entries of rotations, up to which two situations are one and the same."""

EVERY = 20_000
"""At most so many scenes are looked at."""

Numbers = NDArray[np.float64]


def monotony(data: Dataset, count: int | None = None) -> list[str]:
    """Return warnings of what is the same in all scenes in which the relation holds, and of one
    label alone.

    Args:
        data: Labelled scenes.
        count: Only so many of the first ones are trained on.
    """
    used = min(count or len(data), len(data), EVERY)
    holds = data.holds[:used]
    rows = np.flatnonzero(holds)
    if not len(rows):
        return [
            f"'{data.relation}' holds in none of the {used:,} scenes: "
            f"there is nothing to learn from"
        ]

    found: list[str] = []
    if holds.all():
        found.append(
            f"'{data.relation}' holds in every scene ({used:,}): "
            f"what it is not cannot be learned from them. "
            f"Say it in some: goal: (not ({data.relation} BODY PLACE))"
        )
    if len(rows) == 1:
        return [
            *found,
            f"'{data.relation}' holds in one scene only (row {rows[0]}): nothing varies in it",
        ]
    for name, measure in _MEASURES.items():
        values = measure(data, rows)
        if values is not None:
            shown = ", ".join(f"{value + 0.0:.3g}" for value in np.round(np.atleast_1d(values), 3))
            found.append(
                f"in all {len(rows):,} scenes in which '{data.relation}' holds "
                f"{name} is the same ({shown}): "
                "whether it matters cannot be learned from them. Vary it"
            )
    return found


def contradictions(data: Dataset) -> Iterator[tuple[int, int]]:
    """Yield pairs of rows that are the same situation with opposite labels, the first of each
    situation.
    """
    seen: dict[bytes, tuple[int, bool]] = {}
    for row, holds in enumerate(data.holds.tolist()):
        key = _key(data, row)
        first, label = seen.setdefault(key, (row, holds))
        if label != holds:
            yield first, row


def _key(data: Dataset, row: int) -> bytes:
    """Return a key of all that a scene shows of its situation; the others in any order."""
    a = data.arrays
    names = tuple(data.templates)
    there = np.flatnonzero(a["body"][row] >= 0)
    bodies = [
        f"{names[a['body'][row, index]]} {_rounded(a['scale'][row, index])} "
        f"{_rounded(a['pose'][row, index])}"
        for index in there
    ]
    place = [
        bool(a["hollow"][row]),
        *(_rounded(a[name][row]) for name in ("region", "size", "box")),
    ]
    return repr((bodies[:2], sorted(bodies[2:]), place)).encode()


def _rounded(values: Numbers) -> str:
    array = np.atleast_1d(np.asarray(values, dtype=float))
    whole = np.where(np.isfinite(array), np.round(array / FINE), -1.0) + 0.0
    return " ".join(f"{value:.0f}" for value in whole.ravel())


def _height(data: Dataset, rows: NDArray[np.intp]) -> Numbers | None:
    """Return the height of the place's middle above the ground, metres."""
    places = data.arrays["pose"][rows, 0] @ data.arrays["region"][rows]
    return _constant(places[:, 2, 3], SAME_LENGTH)


def _yaw(data: Dataset, rows: NDArray[np.intp]) -> Numbers | None:
    """Return the yaw of the body's first axis that lies, about the place's upright one, radians."""
    regions = data.arrays["pose"][rows, 0] @ data.arrays["region"][rows]
    turned = np.linalg.inv(regions) @ data.arrays["pose"][rows, 1]
    axis = int(np.argmax(np.abs(turned[0, :2, :3]).max(axis=0)))
    yaws = np.arctan2(turned[:, 1, axis], turned[:, 0, axis])
    return (
        yaws[:1]
        if float(np.abs(np.angle(np.exp(1j * (yaws - yaws[0])))).max()) < SAME_ANGLE
        else None
    )


def _size(data: Dataset, rows: NDArray[np.intp]) -> Numbers | None:
    """Return the sides of the body's box along its own axes, metres, the shortest side first."""
    sizes: list[Numbers] = []
    for row in rows:
        corners = data.form(row, 1).corners
        sizes.append(np.sort(corners[1] - corners[0]))
        if len(sizes) > 1 and np.abs(sizes[-1] - sizes[0]).max() > SAME_LENGTH:
            return None
    return sizes[0]


def _room(data: Dataset, rows: NDArray[np.intp]) -> Numbers | None:
    """Return the lengths of the place's two sides, metres."""
    return _constant(data.arrays["size"][rows, :2], SAME_LENGTH)


def _constant(values: Numbers, within: float) -> Numbers | None:
    return np.atleast_1d(values[0]) if float(np.ptp(values, axis=0).max()) <= within else None


_MEASURES: Mapping[str, Callable[[Dataset, NDArray[np.intp]], Numbers | None]] = {
    "the height of the place (m)": _height,
    "the size of the place (m)": _room,
    "the yaw of the body on it (rad)": _yaw,
    "the size of the body (m)": _size,
}
