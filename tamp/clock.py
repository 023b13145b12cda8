"""The time that a computation may still take, passed down as an argument."""

from __future__ import annotations

import math
import time


class OutOfTime(BaseException):
    """Raised inside a computation that ran past its deadline; like KeyboardInterrupt no `except Exception` stops it."""


class Deadline:
    """A moment on the monotonic clock.

    Args:
        seconds: From now; infinite by default.

    Attributes:
        ended: Whether the computation knows that it has to end, and only says what it found: let it finish that.
    """

    def __init__(self, seconds: float = math.inf) -> None:
        self.started = time.monotonic()
        self.seconds = seconds
        self.ended = False

    def left(self) -> float:
        """Seconds until the deadline, never negative."""
        return max(0.0, self.seconds - self.elapsed())

    def elapsed(self) -> float:
        """Seconds since the deadline was set."""
        return time.monotonic() - self.started

    @property
    def passed(self) -> bool:
        """Whether the time is up."""
        return self.elapsed() >= self.seconds
