"""Deadlines (timeouts): the time that a computation may still take, passed down as an argument."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass
class Standstill:
    """Time that counts for nobody: while kernels are compiled, which happens once for all that come
    after.

    Attributes:
        depth: How many of those who stopped the clock have not let it go on.
        total: Seconds for which it stood still before `since`.
        told: Called with the number of functions compiled so far, whenever another one begins; only
            one is told.
    """

    depth: int = 0
    total: float = 0.0
    since: float = 0.0
    told: Callable[[int], None] | None = None

    def begin(self) -> None:
        """Stop the clock, or keep it stopped."""
        if self.depth == 0:
            self.since = time.monotonic()
        self.depth += 1

    def end(self) -> None:
        """Let it go on, once for each time that it was stopped."""
        self.depth -= 1
        if self.depth == 0:
            self.total += time.monotonic() - self.since


STANDSTILL = Standstill()
"""Of this process."""


def counted() -> float:
    """Read the monotonic clock, less the time for which it stood still; seconds."""
    now = time.monotonic()
    return now - STANDSTILL.total if STANDSTILL.depth == 0 else STANDSTILL.since - STANDSTILL.total


class OutOfTime(BaseException):
    """Raised inside a computation that ran past its deadline; like KeyboardInterrupt it is not
    stopped by `except Exception`.
    """


class Deadline:
    """A moment on the monotonic clock, which stands still while kernels are compiled.

    Args:
        seconds: From now; infinite by default.

    Attributes:
        ended: Whether the computation knows that it has to end, and only says what it found: let it
            finish that.
    """

    def __init__(self, seconds: float = math.inf) -> None:
        self.started = counted()
        self.seconds = seconds
        self.ended = False

    def left(self) -> float:
        """Compute the seconds until the deadline, never negative."""
        return max(0.0, self.seconds - self.elapsed())

    def elapsed(self) -> float:
        """Compute the seconds since the deadline was set."""
        return counted() - self.started

    @property
    def passed(self) -> bool:
        """Check whether the time is up."""
        return self.elapsed() >= self.seconds
