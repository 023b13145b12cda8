"""Processes that end with their parent, and what they leave behind when they go."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tamp.system.process_family import seconds_waited
from tests.system.test_race import gone

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="asks the kernel of Linux")

ORPHANS = """
import subprocess
from tamp.system.process_family import adopt_orphans, end_orphans

{adopts}
sleep = "exec sleep 60 >/dev/null 2>&1"
family = f"({sleep}) & echo ours $!; echo ours $$; {sleep}"
shell = f"({sleep}) & echo ours $!; setsid sh -c 'echo other $$; {sleep}' & sh -c '{family}' & read x"
with subprocess.Popen(["sh", "-c", shell], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as one:
    for _ in range(4):
        print(one.stdout.readline().decode(), end="", flush=True)
    one.communicate(b"go on")
end_orphans()
"""
"""A child starts a process, one of another session, and one that has a child itself, and leaves."""

CHILD = """
import os, sys, time
from tamp.system.process_family import die_with

die_with(int(sys.argv[1]))
print("alive", flush=True)
time.sleep(600)
"""

PARENT = f"""
import os, subprocess, sys

subprocess.Popen([sys.executable, "-c", {CHILD!r}, str(os.getpid())]).wait()
"""


def run(code: str, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code, *words],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.fixture
def ended() -> Iterator[list[int]]:
    """Processes that are no more after the test, whatever it finds."""
    pids: list[int] = []
    yield pids
    for pid in pids:
        if alive(pid):
            os.kill(pid, signal.SIGKILL)


def orphans(adopts: str, ended: list[int]) -> list[str]:
    """Of whose session the orphans are that are left."""
    done = run(ORPHANS.replace("{adopts}", adopts))
    owners = {int(pid): whose for whose, pid in map(str.split, done.stdout.splitlines())}
    ended[:] = owners
    assert len(owners) == 4 and done.returncode == 0, done.stderr
    return sorted(whose for pid, whose in owners.items() if alive(pid))


def alive(pid: int) -> bool:
    return not gone(pid, within=0.1)


def test_orphans_of_our_session_are_ended_and_those_of_others_are_not(ended: list[int]) -> None:
    assert orphans("adopt_orphans()", ended) == ["other"]


def test_who_adopts_nobody_ends_nobody(ended: list[int]) -> None:
    assert orphans("", ended) == ["other", "ours", "ours", "ours"]


def test_a_process_ends_with_its_parent() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None and parent.stdout.readline() == "alive\n"
    (child,) = Path(f"/proc/{parent.pid}/task/{parent.pid}/children").read_text().split()
    parent.kill()
    parent.communicate(timeout=30)
    assert gone(int(child))


def test_a_process_whose_parent_has_gone_before_ends_at_once() -> None:
    done = run(CHILD, str(os.getpid() + 1))
    assert done.returncode == 1 and done.stdout == ""


def test_seconds_of_waiting_are_those_that_the_kernel_counts() -> None:
    """Field 2 of schedstat, nanoseconds (Documentation/scheduler/sched-stats.rst)."""

    def counted() -> float:
        return int(Path(f"/proc/{os.getpid()}/schedstat").read_text().split()[1]) / 1e9

    before, said, after = counted(), seconds_waited(os.getpid()), counted()
    assert before <= said * (1 + 1e-12) and said <= after * (1 + 1e-12)
    assert seconds_waited(0) == 0.0  # no process has this number
