"""Runs in processes of their own: who wins, and that nobody stays behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.system.deadline import Deadline
from tamp.system.race import SEED_STRIDE, RaceResult, Tell, member_seed, race

Run = Callable[[Tell], Any]


def answering(answer: Any) -> Run:
    def run(tell: Tell) -> Any:
        tell(os.getpid())
        return answer

    return run


def endless(tell: Tell) -> Any:
    tell(os.getpid())
    while True:
        time.sleep(1.0)


def broken(tell: Tell) -> Any:
    os._exit(7)


def always(number: int, answer: Any) -> bool:
    return True


def gone(pid: int, within: float = 5.0) -> bool:
    """Whether a process ends in time; one that nobody waited for has ended, too."""
    end = time.monotonic() + within
    while time.monotonic() < end:
        try:
            state = (
                Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[0]
            )
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


def test_the_first_answer_that_ends_it_counts_and_the_others_leave() -> None:
    told: dict[int, int] = {}
    runs = [endless, answering("no"), answering("yes")]
    found = race(runs, lambda n, answer: answer == "yes", Deadline(60), told.__setitem__)
    assert found == RaceResult(2, "yes")
    assert told and all(gone(pid) for pid in told.values())


def test_without_an_ending_answer_the_first_runs_counts() -> None:
    runs = [answering("a"), answering("b")]
    assert race(runs, lambda n, answer: False, Deadline(60)) == RaceResult(0, "a")


def test_a_run_that_never_ends_is_killed_when_the_time_is_up() -> None:
    pids: list[int] = []
    assert race([endless, endless], always, Deadline(0.3), lambda n, pid: pids.append(pid)) is None
    assert len(pids) == 2 and all(map(gone, pids))


def test_a_broken_run_does_not_matter_unless_all_are() -> None:
    assert race([broken, answering(1)], always, Deadline(60)) == RaceResult(1, 1)
    with pytest.raises(ChildProcessError):
        race([broken, broken], always, Deadline(60))


def test_bad_input_found_in_a_run_is_raised_here() -> None:
    def refuse(tell: Tell) -> Any:
        raise InputError("no such thing", file="x.pddl", line=3, remedy="Look again")

    with pytest.raises(InputError, match=r"x\.pddl:3: no such thing\. Look again"):
        race([refuse, endless], always, Deadline(60))


def test_an_interruption_leaves_nobody_behind() -> None:
    pids: list[int] = []

    def news(number: int, pid: int) -> None:
        pids.append(pid)
        if len(pids) == 2:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        race([endless, endless], always, Deadline(60), news)
    assert len(pids) == 2 and all(map(gone, pids))


KILLED = """
import os, signal, sys, time
from tamp.system.deadline import Deadline
from tamp.system.race import race

def endless(tell):
    tell(os.getpid())
    time.sleep(600)

def news(number, pid):
    print(pid, flush=True)
    pids.append(pid)
    if len(pids) == 3:
        os.kill(os.getpid(), signal.SIGKILL)

pids = []
race([endless] * 3, lambda number, answer: True, Deadline(600), news)
"""


def test_the_runs_leave_even_when_the_one_who_started_them_is_killed() -> None:
    done = subprocess.run(
        [sys.executable, "-c", KILLED], capture_output=True, text=True, timeout=60, check=False
    )
    pids = [int(word) for word in done.stdout.split()]
    assert len(pids) == 3 and done.returncode == -signal.SIGKILL
    assert all(map(gone, pids))


def test_seeds_stay_in_range() -> None:
    assert member_seed(2**64 - 1, 3) == 2**64 - 1 - 3 * SEED_STRIDE
    assert member_seed(7, 0) == 7
