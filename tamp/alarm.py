"""A hard end for computations that do not look at the clock."""

from __future__ import annotations

import gc
import signal
import sys
import threading
import time
from functools import partial
from types import FrameType, TracebackType
from typing import Any

from tamp.clock import Deadline, OutOfTime

GRACE = 0.1
"""Seconds after the deadline at which whatever still runs is interrupted."""

SOONEST = 1e-4
"""The least that a timer is set to, seconds: none at all would never ring."""

AGAIN = 0.25
"""Seconds until the next interruption, should the first one have been swallowed."""


SOON = 0.005
"""Seconds until the next try, when the first one met a frame in which nothing can be raised."""

INTERRUPT_AGAIN = 1.0
"""Seconds of computing between a Ctrl-C and the same again, should it have been swallowed: numba drops what is raised
while a kernel's arrays are wrapped, and so does an `except:` in a user's function."""

CALLER = "algorithms/stream.py"
"""What calls the functions that may never return; frames above it are not to be interrupted again."""


def _swallows(frame: FrameType | None) -> bool:
    """Whether Python drops what is raised here: in a finaliser, or in what the garbage collector calls."""
    collecting = {getattr(callback, "__code__", None) for callback in gc.callbacks}
    while frame is not None:
        if frame.f_code in collecting or frame.f_code.co_name == "__del__":
            return True
        frame = frame.f_back
    return False


def _look_away(frame: FrameType, event: str, argument: object) -> None:
    """Trace no new frames."""


class Alarm:
    """Raises OutOfTime in a block shortly after the deadline, even inside a function that never returns; not
    when it is known already (`Deadline.ended`).

    A Ctrl-C, too, is raised again until it is heard. Works in the main thread of systems with SIGALRM; elsewhere the
    deadline is only kept by those who look at it. One alarm may run inside another: the outer one's time goes on.

    Args:
        deadline: When to ring, but for the grace.
        grace: Seconds after the deadline.
        again: Seconds between one ring and the next, should the first one have been swallowed.
        caller: The end of the file name of what calls the functions that may never return.
    """

    def __init__(self, deadline: Deadline, grace: float = GRACE, again: float = AGAIN, caller: str = CALLER) -> None:
        self._deadline = deadline
        self._grace, self._again, self._caller = grace, again, caller
        self._armed = False
        self._swallowed = False
        self._began = 0.0
        self._before: tuple[Any, tuple[float, float]] | None = None
        self._listens = False

    def __enter__(self) -> Alarm:
        usable = sys.platform != "win32" and threading.current_thread() is threading.main_thread()
        if usable and self._deadline.seconds < threading.TIMEOUT_MAX:
            timer = signal.setitimer(signal.ITIMER_REAL, 0.0)  # first, so that an outer alarm never rings in here
            self._before = signal.signal(signal.SIGALRM, self._ring), timer
            self._began = time.monotonic()
            self._armed = True
            signal.setitimer(signal.ITIMER_REAL, self._deadline.left() + max(self._grace, SOONEST), self._again)
        if usable and signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # no outer alarm, nor the user
            self._armed = self._listens = True
            signal.signal(signal.SIGVTALRM, self._ring)
            signal.signal(signal.SIGINT, self._interrupt)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.disarm()

    def disarm(self) -> None:
        """Never ring again; may be called twice, since a ring may come on the way out of the block."""
        self._armed = False
        if self._swallowed:
            sys.settrace(None)
        if self._listens:
            self._listens = False
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
            signal.signal(signal.SIGINT, signal.default_int_handler)
        if self._before is not None:
            handler, (left, interval) = self._before
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, handler)
            self._before = None
            if left > 0.0:
                left -= time.monotonic() - self._began
                signal.setitimer(signal.ITIMER_REAL, max(left, SOONEST), interval)
                if left <= SOONEST:  # the next alarm may begin before the timer rings
                    signal.raise_signal(signal.SIGALRM)

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if not self._armed or self._deadline.ended:  # on the way out of the block
            raise KeyboardInterrupt
        signal.setitimer(signal.ITIMER_VIRTUAL, INTERRUPT_AGAIN, INTERRUPT_AGAIN)
        self._ring(signal.SIGVTALRM, frame)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        if not self._armed or self._deadline.ended:
            return
        timed = number == signal.SIGALRM
        if _swallows(frame):
            again = self._again if timed else INTERRUPT_AGAIN
            signal.setitimer(signal.ITIMER_REAL if timed else signal.ITIMER_VIRTUAL, SOON, again)
            return
        error = OutOfTime if timed else KeyboardInterrupt
        if self._swallowed:
            called = self._called(frame)
            if called:
                sys.settrace(_look_away)
            for inner in called:
                inner.f_trace = partial(self._insist, error)
        self._swallowed = True
        raise error

    def _called(self, frame: FrameType | None) -> list[FrameType]:
        """The frames of the function that may never return; none when it is not in one that the ring comes."""
        inner: list[FrameType] = []
        while frame is not None:
            if frame.f_code.co_filename.endswith(self._caller):
                return inner
            inner.append(frame)
            frame = frame.f_back
        return []

    def _insist(self, error: type[BaseException], frame: FrameType, event: str, argument: object) -> Any:
        """Raise in the handler, too, that catches everything; Python then forgets this trace function by itself."""
        if event == "line" and self._armed:
            raise error
        return partial(self._insist, error)
