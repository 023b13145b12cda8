"""Frequency of the garbage collection: how often Python looks for reference cycles."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

SELDOM = 50_000
"""New containers between two looks; Python's own 700 cost planning a tenth of its time and more."""


@contextmanager
def infrequent_collection() -> Iterator[None]:
    """Collect garbage seldom inside: planning makes many lists that last, and hardly a cycle
    (tests/test_memory.py).
    """
    before = gc.get_threshold()
    if before[0]:
        gc.set_threshold(max(before[0], SELDOM), *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)
