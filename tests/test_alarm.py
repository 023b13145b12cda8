"""A hard end: the deadline and Ctrl-C are heard even where something drops what is raised."""

from __future__ import annotations

import contextlib
import signal
import time
from collections.abc import Callable

import pytest

from tamp import alarm
from tamp.alarm import Alarm
from tamp.clock import Deadline, OutOfTime


def compute(seconds: float) -> None:
    """Use the processor for so long."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def dropped(number: int) -> None:
    """A signal of which is dropped what it raises, as numba does while it wraps an array; then more work."""
    with contextlib.suppress(KeyboardInterrupt, OutOfTime):
        signal.raise_signal(number)
    compute(10.0)


def finalised() -> None:
    """A signal in a finaliser, where Python drops what is raised; then more work."""

    class Slow:
        def __del__(self) -> None:
            signal.raise_signal(signal.SIGINT)

    Slow()
    compute(10.0)


def nested() -> None:
    """A signal that is dropped under an inner alarm."""
    with Alarm(Deadline(15.0)):
        dropped(signal.SIGINT)


@pytest.mark.parametrize("limit", [20.0, float("inf")])
@pytest.mark.parametrize("work", [lambda: dropped(signal.SIGINT), finalised, nested])
def test_an_interrupt_that_was_dropped_comes_again(
    work: Callable[[], None], limit: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(alarm, "INTERRUPT_AGAIN", 0.05)
    with pytest.raises(KeyboardInterrupt), Alarm(Deadline(limit)):
        work()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    compute(0.2)  # and not once more after the block


def test_a_handler_of_the_users_is_left_alone() -> None:
    calls: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: calls.append(number))
    try:
        with Alarm(Deadline(20.0)):
            signal.raise_signal(signal.SIGINT)
        assert calls == [signal.SIGINT]
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_deadline_rings_again_when_the_first_ring_was_dropped() -> None:
    with pytest.raises(OutOfTime), Alarm(Deadline(0.0), grace=0.0, again=0.05):
        dropped(signal.SIGALRM)


def test_who_knows_of_the_end_may_say_what_was_found() -> None:
    deadline = Deadline(0.0)
    with Alarm(deadline, grace=0.0, again=0.02):
        with contextlib.suppress(OutOfTime):
            compute(10.0)
        deadline.ended = True
        compute(0.2)
    with pytest.raises(KeyboardInterrupt), Alarm(deadline):
        signal.raise_signal(signal.SIGINT)  # but the user is always heard
