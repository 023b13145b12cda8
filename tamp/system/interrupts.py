"""Hard timeouts: a timer's signal interrupts computations that do not look at the deadline.

Not by a worker process that is killed: values of streams, users' functions and what a run has
learned would have to be pickled, and the best plan so far would be lost with the process.
"""

from __future__ import annotations

import gc
import signal
import sys
import threading
from collections.abc import Callable, Collection
from functools import partial
from types import CodeType, FrameType
from typing import Any, TypeVar

from tamp.system import guard
from tamp.system.deadline import STANDSTILL, Deadline, OutOfTime, counted

Result = TypeVar("Result")

GRACE_S = 0.1
"""Seconds after the deadline at which whatever still runs is interrupted."""

SHORTEST_TIMER_S = 1e-4
"""The least that a timer is set to, seconds: none at all would never ring."""

REPEAT_S = 0.25
"""Seconds until the next interruption, should the first one have been swallowed."""

RETRY_S = 0.005
"""Seconds until the next try, when the first one met a frame in which nothing can be raised."""

INTERRUPT_AGAIN = 0.1
"""Seconds of computing between a Ctrl-C and the same again, should it have been swallowed: numba
drops what is raised while a kernel's arrays are wrapped, and so does an `except:` in a user's
function.
"""


def _swallows(frame: FrameType | None) -> bool:
    """Check whether Python drops what is raised here: in a finaliser, or in what the garbage
    collector calls.
    """
    collecting = {getattr(callback, "__code__", None) for callback in gc.callbacks}
    while frame is not None:
        if frame.f_code in collecting or frame.f_code.co_name == "__del__":
            return True
        frame = frame.f_back
    return False


def _look_away(frame: FrameType, event: str, argument: object) -> None:
    """Trace no new frames."""


class Interrupter:
    """Raises OutOfTime in a computation shortly after the deadline, even inside a function that
    never returns; not when it is known already (`Deadline.ended`).

    Ctrl-C, too, is raised again until it is heard, and SIGTERM in a guarded command. Works in the
    main thread of systems with SIGALRM; elsewhere the deadline is only kept by those who look at
    it. One alarm may run inside another: the outer one's time goes on.

    Args:
        deadline: When to ring, but for the grace.
        grace: Seconds after the deadline.
        again: Seconds between one ring and the next, should the first one have been swallowed.
        strangers: The code of those of our functions that call what may never return. A function
            that they call and that has swallowed a ring meets it again at each of its lines; they
            themselves and what is above do not.
    """

    def __init__(
        self,
        deadline: Deadline,
        grace: float = GRACE_S,
        again: float = REPEAT_S,
        strangers: Collection[CodeType] = (),
    ) -> None:
        self._deadline = deadline
        self._grace, self._again, self._strangers = grace, again, frozenset(strangers)
        self._swallowed = False
        self._inner: FrameType | None = None
        self._late = False

    def run(self, work: Callable[[], Result]) -> Result:
        """Call a function, in which alone interruptions are raised; when this returns or
        raises, all is as it was.

        Raises:
            OutOfTime: As the function has let it out.
            KeyboardInterrupt: The same.
        """
        if sys.platform == "win32" or threading.current_thread() is not threading.main_thread():
            return work()

        timed = self._deadline.seconds < threading.TIMEOUT_MAX
        ends = [
            number
            for number in guard.ENDING_SIGNALS
            if signal.getsignal(number) is guard.hear
            or (number == signal.SIGINT and signal.getsignal(number) is signal.default_int_handler)
        ]  # not those that an outer alarm hears, nor those of the user

        began = counted()
        left, interval = signal.setitimer(signal.ITIMER_REAL, 0.0) if timed else (0.0, 0.0)
        mine = [*([signal.SIGALRM] if timed else []), *([signal.SIGVTALRM, *ends] if ends else [])]
        before: dict[int, Any] = {}

        try:
            for number in mine:
                before[number] = signal.signal(
                    number, self._end if number in ends else self._raise_in_main_thread
                )
            if timed:
                self._set()
            return self._inside(work)
        finally:
            if ends:
                signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
            if timed:
                signal.setitimer(signal.ITIMER_REAL, 0.0)
            for number, handler in before.items():
                signal.signal(number, handler)

            if self._swallowed:
                sys.settrace(None)
            if left > 0.0:
                left -= counted() - began
                signal.setitimer(signal.ITIMER_REAL, max(left, SHORTEST_TIMER_S), interval)
                if left <= SHORTEST_TIMER_S:  # the next alarm may begin before the timer rings
                    signal.raise_signal(signal.SIGALRM)
            if self._late:  # a signal came between the lines of this function
                self._late = False
                raise KeyboardInterrupt

    def _inside(self, work: Callable[[], Result]) -> Result:
        """Return the frame under which interruptions are raised: on the way out of it nothing
        can be raised any more.
        """
        self._inner = sys._getframe()
        try:
            return work()
        finally:
            self._inner = None

    def _set(self) -> None:
        """Set the timer of the interruption."""
        signal.setitimer(
            signal.ITIMER_REAL,
            self._deadline.left() + max(self._grace, SHORTEST_TIMER_S),
            self._again,
        )

    def _is_inside(self, frame: FrameType | None) -> bool:
        """Check whether a frame is one of the computation's."""
        while frame is not None and frame is not self._inner:
            frame = frame.f_back
        return frame is not None and self._inner is not None

    def _end(self, number: int, frame: FrameType | None) -> None:
        """Hear Ctrl-C or SIGTERM."""
        if guard.asked():  # it is being raised already
            return
        guard.note(number)
        if not self._is_inside(frame):
            self._late = True
            return
        if self._deadline.ended:
            raise KeyboardInterrupt
        signal.setitimer(signal.ITIMER_VIRTUAL, INTERRUPT_AGAIN, INTERRUPT_AGAIN)
        self._raise_in_main_thread(signal.SIGVTALRM, frame)

    def _raise_in_main_thread(self, number: int, frame: FrameType | None) -> None:
        """Handle the timer's signal: raise, if this is a place for it."""
        if self._deadline.ended or not self._is_inside(frame):
            return

        timed = number == signal.SIGALRM
        # kernels were compiled, or still are
        if timed and (STANDSTILL.depth or self._deadline.left() > 0.0):
            self._set()
            return

        if _swallows(frame):
            again = self._again if timed else INTERRUPT_AGAIN
            signal.setitimer(signal.ITIMER_REAL if timed else signal.ITIMER_VIRTUAL, RETRY_S, again)
            return

        error = OutOfTime if timed else KeyboardInterrupt
        if self._swallowed:
            called = self._called(frame)
            if called:
                sys.settrace(_look_away)
            for inner in called:
                inner.f_trace = partial(self._raise_again, error)
        self._swallowed = True
        raise error

    def _called(self, frame: FrameType | None) -> list[FrameType]:
        """List the frames of the function that may never return; none when it is not in one that
        the ring comes.
        """
        inner: list[FrameType] = []
        while frame is not None:
            if frame.f_code in self._strangers:
                return inner
            inner.append(frame)
            frame = frame.f_back
        return []

    def _raise_again(
        self, error: type[BaseException], frame: FrameType, event: str, argument: object
    ) -> Any:
        """Raise in the handler, too, that catches everything; Python then forgets this trace
        function by itself.
        """
        if event == "line" and self._inner is not None:
            raise error
        return partial(self._raise_again, error)
