"""Deadlines on a clock that stands still while kernels are compiled; the clock here is a number."""

from __future__ import annotations

import math

import pytest

from tamp.system import deadline
from tamp.system.deadline import Deadline, OutOfTime, Standstill, counted


class Clock:
    """A monotonic clock that is set by hand."""

    now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(deadline, "time", made)
    monkeypatch.setattr(deadline, "STANDSTILL", Standstill())
    return made


def test_time_is_up_when_the_seconds_have_passed(clock: Clock) -> None:
    limit = Deadline(5.0)
    clock.now += 4.0
    assert (limit.elapsed(), limit.left(), limit.passed) == (4.0, 1.0, False)
    clock.now += 1.0
    assert (limit.left(), limit.passed) == (0.0, True)
    clock.now += 10.0
    assert limit.left() == 0.0  # never negative


def test_without_a_limit_it_never_is(clock: Clock) -> None:
    limit = Deadline()
    clock.now += 1e9
    assert not limit.passed and limit.left() == math.inf and limit.elapsed() == 1e9


def test_no_time_at_all_is_up_at_once(clock: Clock) -> None:
    assert Deadline(0.0).passed and Deadline(-1.0).passed


def test_a_standstill_counts_for_nobody(clock: Clock) -> None:
    limit = Deadline(5.0)
    clock.now += 1.0
    deadline.STANDSTILL.begin()
    clock.now += 60.0
    assert limit.elapsed() == 1.0 and not limit.passed  # while it lasts
    deadline.STANDSTILL.end()
    assert limit.elapsed() == 1.0
    clock.now += 3.0
    assert limit.elapsed() == 4.0


def test_standstills_within_one_another_are_one(clock: Clock) -> None:
    still = deadline.STANDSTILL
    before = counted()
    still.begin()
    clock.now += 2.0
    still.begin()
    clock.now += 3.0
    still.end()
    clock.now += 4.0
    assert counted() == before
    still.end()
    assert (still.depth, still.total) == (0, 9.0)
    clock.now += 1.0
    assert counted() == before + 1.0


def test_a_deadline_set_in_a_standstill_begins_with_its_end(clock: Clock) -> None:
    deadline.STANDSTILL.begin()
    limit = Deadline(5.0)
    clock.now += 100.0
    deadline.STANDSTILL.end()
    clock.now += 4.0
    assert limit.elapsed() == 4.0


def test_out_of_time_is_not_stopped_by_except_exception() -> None:
    assert issubclass(OutOfTime, BaseException) and not issubclass(OutOfTime, Exception)
