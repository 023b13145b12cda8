"""The line that says how far a benchmark is."""

from __future__ import annotations

import io

import pytest

from tamp.benchmark import progress
from tamp.benchmark.progress import SELDOM, ProgressLine
from tests.benchmark.toys import TIMEOUT, line, some


class Clock:
    now = 0.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(progress, "time", made)
    return made


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def ended(shown: ProgressLine, clock: Clock, after: float, total: int = 4) -> None:
    """Runs that end one after the other: solved, rejected, timed out, solved."""
    kinds = ({}, {"verified": False}, TIMEOUT, {})
    for done, (case, kind) in enumerate(zip(some(total), kinds, strict=True), start=1):
        clock.now += after
        shown.ended(line(case, 1.0 + done, **kind), total - done)


def test_a_terminals_line_is_rewritten_and_ends_at_the_end(clock: Clock) -> None:
    stream = Terminal()
    ended(ProgressLine(4, stream), clock, 10.0)
    assert stream.getvalue().count("\n") == 1 and stream.getvalue().endswith("\x1b[K\n")
    lines = [one.removesuffix("\x1b[K") for one in stream.getvalue().strip().split("\r") if one]
    assert lines[0] == "1/4 runs · 1 of 1 solved · 0:30 left · swap default seed 0: SOLVED 2.00 s"
    assert (
        lines[1]
        == "2/4 runs · 1 of 2 solved · 0:20 left · swap default seed 1: SOLVED REJECTED 3.00 s"
    )
    assert lines[2] == "3/4 runs · 1 of 3 solved · 0:10 left · swap default seed 2: TIMEOUT 4.00 s"
    assert lines[3].startswith("4/4 runs · 2 of 4 solved · 0:00 left")


def test_elsewhere_a_line_comes_seldom_and_the_last_one_always(clock: Clock) -> None:
    stream = io.StringIO()
    ended(ProgressLine(4, stream), clock, 0.4 * SELDOM)
    told = stream.getvalue().splitlines()
    assert [one.split(" ")[0] for one in told] == ["3/4", "4/4"]
    assert "\r" not in stream.getvalue()


def test_quiet_is_quiet(clock: Clock) -> None:
    stream = Terminal()
    ended(ProgressLine(4, stream, quiet=True), clock, 10.0)
    assert stream.getvalue() == ""


def test_minutes_are_told(clock: Clock) -> None:
    stream = io.StringIO()
    clock.now = 75.0
    shown = ProgressLine(11, stream)
    clock.now += 75.0
    shown.ended(line(some(1)[0]), 10)
    assert " · 12:30 left · " in stream.getvalue()
