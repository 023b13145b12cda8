"""Queues of the landmark-cut heuristic for tests."""

from __future__ import annotations

from tamp.symbolic.search.heuristics.loops.landmark_queue import Buckets


def empty(room: int) -> Buckets:
    """A queue with one bucket, of cost 0."""
    return Buckets(
        [0.0] * room, [-1] * room, [-1] * room, [0] * room, [0] * room, [0.0] * room, [0] * room,
        [1, 0, 0],
    )  # fmt: skip
