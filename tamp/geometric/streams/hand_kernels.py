"""Closing a parallel hand on a body in compiled code: parts of hand and fingers against the body's.

All is in the body's frame. Poses are rows of nine numbers of a rotation and three of a translation.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numba import types

from tamp.geometric.collision.edge_check import sources_digest
from tamp.geometric.collision.gjk import APART, INLINE, JIT, centre, separation
from tamp.geometric.collision.tables import RADIUS
from tamp.system.compilation import njit

TOUCH_DISTANCE_M = 1e-6
"""Metres that count as touching."""

CLOSING_STEP_M = 0.005
"""Steps of a closing finger, metres: a thin wall must not be jumped over."""

CLOSING_END_M = -0.02
"""How far beyond the middle a finger closes, metres."""

CONTACT_PRECISION_M = 1e-4
"""To how many metres a contact is found."""


@njit(**INLINE)
def _place(parts_poses, k, tool, along, shift, placed):
    """Set row k of `placed` to the part's pose, after a tool's pose and a shift along an axis."""
    for r in range(3):
        x, y, z = tool[3 * r], tool[3 * r + 1], tool[3 * r + 2]
        for c in range(3):
            placed[k, 3 * r + c] = (
                x * parts_poses[k, c] + y * parts_poses[k, 3 + c] + z * parts_poses[k, 6 + c]
            )
        a = parts_poses[k, 9] + shift * along[k, 0]
        b = parts_poses[k, 10] + shift * along[k, 1]
        c = parts_poses[k, 11] + shift * along[k, 2]
        placed[k, 9 + r] = x * a + y * b + z * c + tool[9 + r]


@njit(**JIT)
def touches(
    begin, end, tool, shift, parts, poses, along, body, body_poses, vertices, placed, guess, s,
    weights,
):  # fmt: skip
    """Check whether one of the parts begin..end-1, shifted along its axis, touches the body."""
    for k in range(begin, end):
        _place(poses, k, tool, along, shift, placed)
        x, y, z = centre(parts, k, placed)
        for j in range(len(body)):
            bx, by, bz = centre(body, j, body_poses)
            dx, dy, dz = x - bx, y - by, z - bz
            limit = parts[k, RADIUS] + body[j, RADIUS] + TOUCH_DISTANCE_M
            if dx * dx + dy * dy + dz * dz > limit * limit:
                continue
            guess[0], guess[1], guess[2] = dx, dy, dz
            answer = separation(
                parts, k, placed, body, j, body_poses, vertices, TOUCH_DISTANCE_M,
                TOUCH_DISTANCE_M, guess, s, weights,
            )  # fmt: skip
            if answer != APART:
                return True
    return False


def _compiled(sources: int) -> Callable[..., tuple[bool, float, float]]:
    """Compile the kernel, or load it. `sources` makes the cached one stale when any of its files
    has changed.
    """
    vector, matrix = (types.Array(types.float64, n, "C") for n in (1, 2))
    integers, number = types.Array(types.int64, 1, "C"), types.float64
    found = types.Tuple((types.boolean, number, number))

    @njit(
        found(vector, number, number, number, integers, *(matrix,) * 6), cache=True,
        error_model="numpy", no_cfunc_wrapper=True,
    )  # fmt: skip
    def closed(tool, opening, back, step, groups, parts, poses, along, body, body_poses, vertices):
        placed, s = np.empty((len(parts), 12)), np.empty((4, 3))
        guess, weights, contacts = np.empty(3), np.empty(4), np.empty(2)
        if sources < 0:  # never: so that the number is a part of what is compiled
            return False, 0.0, 0.0

        moved = tool.copy()
        for k in range(1 + int(back / step + 0.5)):
            for r in range(3):
                moved[9 + r] = tool[9 + r] - k * step * tool[3 * r + 2]
            if touches(
                np.int64(0), groups[3], moved, opening / 2, parts, poses, along, body, body_poses,
                vertices, placed, guess, s, weights,
            ):  # fmt: skip
                return False, 0.0, 0.0
        if back > 0.0:
            return True, 0.0, 0.0

        for finger in range(2):
            free, blocked, met = opening / 2, CLOSING_END_M, False
            while not met and free - CLOSING_STEP_M > CLOSING_END_M:
                met = touches(
                    groups[finger], groups[finger + 1], tool, free - CLOSING_STEP_M, parts, poses,
                    along, body, body_poses, vertices, placed, guess, s, weights,
                )  # fmt: skip
                if met:
                    blocked = free - CLOSING_STEP_M
                else:
                    free -= CLOSING_STEP_M
            if not met:
                return False, 0.0, 0.0

            while free - blocked > CONTACT_PRECISION_M:
                middle = (free + blocked) / 2
                if touches(
                    groups[finger], groups[finger + 1], tool, middle, parts, poses, along, body,
                    body_poses, vertices, placed, guess, s, weights,
                ):  # fmt: skip
                    blocked = middle
                else:
                    free = middle
            contacts[finger] = free
        return True, contacts[0], contacts[1]

    return closed  # pyright: ignore[reportReturnType]  # a numba dispatcher


closed = _compiled(zlib.crc32(Path(__file__).read_bytes(), sources_digest()))
"""closed(tool, opening, back, step, groups, parts, poses, along, body, body_poses, vertices) ->
whether, left, right.

With `back` 0: whether the hand, open by `opening` metres, is free of the body at the pose `tool`
(12,), and both fingers meet it when they close; and how far from the middle each does. With `back`
more: whether the open hand is free at the pose and in steps of `step` metres back along its axis.

`groups` (4,): rows of `parts` at which the left finger, the right one and the hand begin, and their
number; `poses` (n, 12) in the tool's frame, the fingers' at the middle; `along` (n, 3), where each
slides; `body`, `body_poses` and `vertices` as in `Tables`.
"""
