"""Parents and children of processes on Linux: ending with the parent, adopting and ending orphans.

Imports nothing that the interpreter has not loaded anyway: commands need it before all else.
"""

from __future__ import annotations

import os
import signal
import sys
import time

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
"""Of linux/prctl.h."""


def seconds_waited(process: int) -> float:
    """Return the seconds for which a process was ready to run and others had the cores; 0 where the
    kernel does not say.
    """
    try:
        with open(f"/proc/{process}/schedstat", encoding="ascii") as file:
            return int(file.read().split()[1]) * 1e-9
    except (OSError, ValueError, IndexError):
        return 0.0


def end_orphans() -> None:
    """End what the one who worked has started and left behind in our session; a browser has one of
    its own.
    """
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        try:
            with open(f"/proc/self/task/{os.getpid()}/children", encoding="ascii") as file:
                left = [int(word) for word in file.read().split()]
        except OSError:
            return
        ours = [process for process in left if _session(process) == os.getsid(0)]
        if not ours:
            return
        for process in ours:
            os.kill(process, signal.SIGKILL)
        for process in ours:
            os.waitpid(process, 0)  # what it has started is ours now, too


def adopt_orphans() -> None:
    """Have the kernel hand this process what its children leave behind (a child subreaper)."""
    _prctl(PR_SET_CHILD_SUBREAPER, 1)


def die_with(parent: int) -> None:
    """Have the kernel end this process when its parent is gone."""
    _prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # it went before
        os._exit(1)


def _session(process: int) -> int:
    try:
        return os.getsid(process)
    except OSError:
        return -1


def _prctl(option: int, value: int) -> None:
    """Call prctl of linux/prctl.h; do nothing elsewhere."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)
