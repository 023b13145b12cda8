"""A hard end: the deadline and Ctrl-C are heard even where something drops what is raised."""

from __future__ import annotations

import contextlib
import signal
import time
from collections.abc import Callable

import pytest

from tamp.system import interrupts as alarm
from tamp.system.deadline import STANDSTILL, Deadline, OutOfTime
from tamp.system.interrupts import Interrupter


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
    Interrupter(Deadline(15.0)).run(lambda: dropped(signal.SIGINT))


@pytest.mark.parametrize("limit", [20.0, float("inf")])
@pytest.mark.parametrize("work", [lambda: dropped(signal.SIGINT), finalised, nested])
def test_an_interrupt_that_was_dropped_comes_again(
    work: Callable[[], None], limit: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(alarm, "INTERRUPT_AGAIN", 0.05)
    with pytest.raises(KeyboardInterrupt):
        Interrupter(Deadline(limit)).run(work)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    compute(0.2)  # and not once more after the block


def test_a_handler_of_the_users_is_left_alone() -> None:
    calls: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: calls.append(number))
    try:
        Interrupter(Deadline(20.0)).run(lambda: signal.raise_signal(signal.SIGINT))
        assert calls == [signal.SIGINT]
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_deadline_rings_again_when_the_first_ring_was_dropped() -> None:
    with pytest.raises(OutOfTime):
        Interrupter(Deadline(0.0), grace=0.0, again=0.05).run(lambda: dropped(signal.SIGALRM))


def test_who_knows_of_the_end_may_say_what_was_found() -> None:
    deadline = Deadline(0.0)

    def work() -> str:
        with contextlib.suppress(OutOfTime):
            compute(10.0)
        deadline.ended = True
        compute(0.2)
        return "found"

    assert Interrupter(deadline, grace=0.0, again=0.02).run(work) == "found"
    with pytest.raises(KeyboardInterrupt):
        Interrupter(deadline).run(
            lambda: signal.raise_signal(signal.SIGINT)
        )  # but the user is always heard


def test_nothing_rings_on_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the computation leaves may take longer to free than the alarm waits before it rings again."""

    freed: list[int] = []
    inside = Interrupter._inside

    def slow_to_leave(self: Interrupter, work: Callable[[], object]) -> object:
        try:
            return inside(self, work)
        finally:
            compute(0.2)  # many rings
            freed.append(1)

    monkeypatch.setattr(Interrupter, "_inside", slow_to_leave)
    for _ in range(3):
        with pytest.raises(OutOfTime):
            Interrupter(Deadline(0.0), grace=0.0, again=0.001).run(lambda: compute(10.0))
    assert len(freed) == 3
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_a_signal_on_the_way_out_is_heard_when_all_is_in_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    inside = Interrupter._inside

    def asked_while_leaving(self: Interrupter, work: Callable[[], object]) -> object:
        result = inside(self, work)
        signal.raise_signal(signal.SIGINT)
        return result

    monkeypatch.setattr(Interrupter, "_inside", asked_while_leaving)
    with pytest.raises(KeyboardInterrupt):
        Interrupter(Deadline(60.0)).run(lambda: None)
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_the_alarm_waits_while_kernels_are_compiled() -> None:
    """Compiling happens once for an installation: no budget pays for it, and nobody is blamed."""
    deadline = Deadline(0.1)

    def work() -> float:
        STANDSTILL.begin()
        time.sleep(0.4)
        STANDSTILL.end()
        return deadline.elapsed()

    assert Interrupter(deadline, grace=0.0, again=0.02).run(work) < 0.1
