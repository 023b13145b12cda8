"""Frequency of the garbage collection: how often Python looks for reference cycles."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

SELDOM_CONTAINERS = 50_000
"""New containers between two looks; Python's own 700 cost planning a tenth of its time and more."""

HARDLY_EVER_CONTAINERS = 200_000
"""The same for a command: more than it makes until it plans."""


@contextmanager
def infrequent_collection() -> Iterator[None]:
    """Collect garbage seldom inside: planning makes many lists that last, and hardly a cycle
    (tests/test_memory.py).
    """
    before = gc.get_threshold()
    _raise_threshold(SELDOM_CONTAINERS)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def collect_hardly_ever() -> None:
    """Collect garbage hardly ever from now on, for a process that is a command's own: a look goes
    through all that was imported since the one before, a tenth of the time to a first plan.
    """
    _raise_threshold(HARDLY_EVER_CONTAINERS)


def _raise_threshold(containers: int) -> None:
    before = gc.get_threshold()
    if before[0]:  # 0: somebody wants none at all
        gc.set_threshold(max(before[0], containers), *before[1:])
