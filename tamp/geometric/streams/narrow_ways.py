"""Random grasps in a narrow place: mostly those on whose way in the hand is free.

Advice only: some grasps of other kinds always come through, for the body may be grasped elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

LOOKED_AT = 60
"""Random tool poses after which it is known how narrow the place is."""

NARROW_SHARE = 0.25
"""The share of them on whose way the hand is free, up to which the place is narrow."""

SAME_APPROACH_COSINE = math.cos(math.radians(30.0))
"""Cosine of the angle between approaches up to which one that is free speaks for another."""

KEEP_EVERY = 10
"""Of what is not promising every tenth comes through."""


def promising(
    proposals: Iterator[Float[Array, "4 4"] | None], free: Callable[[Float[Array, "4 4"]], bool]
) -> Iterator[Float[Array, "4 4"] | None]:
    """Pass proposals on, T_body_tool (4, 4) or None for a draw without; in a narrow place mostly
    those whose approach is free.

    Args:
        proposals: Random ones, without end.
        free: Whether the open hand meets nothing fixed on its way to the tool pose, the body being
            where it stands at the start.
    """
    looked = dropped = 0
    approaches: list[Array] = []
    for proposal in proposals:
        if proposal is None:
            yield None
            continue

        if looked < LOOKED_AT:
            looked += 1
            if free(proposal):
                approaches.append(proposal[:3, 2])
            yield proposal
            continue

        if len(approaches) > NARROW_SHARE * LOOKED_AT and looked == LOOKED_AT:
            yield proposal
            yield from proposals
            return

        looked += 1
        alike = not approaches or max(np.array(approaches) @ proposal[:3, 2]) > SAME_APPROACH_COSINE
        if alike and free(proposal):
            if len(approaches) < LOOKED_AT:
                approaches.append(proposal[:3, 2])
            yield proposal
            continue

        dropped += 1
        if dropped % KEEP_EVERY == 0:
            yield proposal
