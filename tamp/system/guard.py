"""Signal handling of commands: Ctrl-C and SIGTERM are heard from the first moment, and obeyed
within a second.

A command is two processes. The one that was started only watches: it hands on what it is asked, and
when the other has not ended in time, because it is inside a library that does not come back or
something dropped what was raised, it ends it. The other one works; it leaves with the first.
Nothing here imports more than the interpreter has anyway.
"""

from __future__ import annotations

import importlib
import os
import signal
import sys
import time
from types import FrameType
from typing import Any, NoReturn

from tamp.system.garbage import collect_hardly_ever
from tamp.system.process_exit import exit_now
from tamp.system.process_family import adopt_orphans, die_with, end_orphans, seconds_waited

ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM)
"""What ends a command, with 128 and the signal's number as its exit code."""

WATCHED_SIGNALS = (*ENDING_SIGNALS, signal.SIGCHLD)
"""What who watches waits for."""

END_TIMEOUT_S = 0.7
"""Seconds that the one who works may take to end by itself, those not counted in which it waited
for a core.
"""

MAX_PATIENCE_S = 8.0
"""The same, counted by the wall's clock: more than that no load excuses."""


class _Asked:
    """The signals that this process was sent.

    Attributes:
        number: The first signal of ENDING_SIGNALS that came; 0 for none.
        at_once: Whether there is nothing to put in order: the process leaves inside the handler.
        guarded: Whether `hear` is installed.
    """

    number = 0
    at_once = False
    guarded = False


_ASKED = _Asked()


def is_guarded() -> bool:
    """Check whether this process is the one who works in a guarded command."""
    return _ASKED.guarded


def asked() -> bool:
    """Check whether somebody wants this command to end; also when what was raised was dropped on
    the way.
    """
    return _ASKED.number != 0


def note(number: int) -> None:
    """Remember the first signal, in a guarded command: elsewhere it is the caller who goes on or
    not.
    """
    if _ASKED.guarded:
        _ASKED.number = _ASKED.number or number


def hear(number: int, frame: FrameType | None = None) -> None:
    """Raise KeyboardInterrupt for the first signal; a terminal's Ctrl-C comes twice, from it and
    from who watches.
    """
    if _ASKED.at_once or _is_importing(frame):
        _say_interrupted()
        os._exit(128 + number)

    first = _ASKED.number == 0
    note(number)
    if first:
        raise KeyboardInterrupt


def _is_importing(frame: FrameType | None) -> bool:
    """Check whether a module is being imported: what is raised inside the start of one in C++ ends
    the process with a traceback, and nothing has been found yet that could be lost.
    """
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def listen() -> None:
    """Have `hear` called in this process, if it is one of a guarded command; again after a library
    took the signals.
    """
    if _ASKED.guarded:
        for number in ENDING_SIGNALS:
            signal.signal(number, hear)


def obey_only_parent() -> None:
    """Set the signals of a worker's process (of multiprocessing): Ctrl-C is for who leads, SIGTERM
    ends it without a word, and it goes when its leader does, however that ends.
    """
    import multiprocessing

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING_SIGNALS)
    _ASKED.guarded = False
    leader = multiprocessing.parent_process()
    if leader is not None and leader.pid is not None:
        die_with(leader.pid)


class HeldSignals:
    """Hold signals back while a process is started: what is raised in a fork is dropped, and the
    new process is not ready to be asked. Use it as a context manager.
    """

    def __enter__(self) -> None:
        self._before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING_SIGNALS)

    def __exit__(self, *error: object) -> None:
        signal.pthread_sigmask(signal.SIG_SETMASK, self._before)


def guarded(module: str, function: str = "main") -> NoReturn:
    """Run a function of a module, which is imported here, as a command of its own; leave with what
    it returns.

    The exit code is the function's, that of its SystemExit, or 130 or 143 where a signal ended it.
    """
    signal.pthread_sigmask(signal.SIG_BLOCK, WATCHED_SIGNALS)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    parent = os.getpid()
    # before there is anybody who may end first and leave somebody behind
    adopt_orphans()

    try:
        child = os.fork()
    except OSError:  # no room for another process: it goes without
        child = 0
    if child:
        _watch(child)

    _ASKED.guarded = _ASKED.at_once = True
    listen()
    signal.pthread_sigmask(signal.SIG_UNBLOCK, WATCHED_SIGNALS)
    sys.unraisablehook = _unraisable

    if os.getpid() != parent:
        die_with(parent)
    collect_hardly_ever()
    command = getattr(importlib.import_module(module), function)
    _ASKED.at_once = False
    leave_as(_code(command))


def leave_as(code: int) -> NoReturn:
    """End the process with a code, or with that of the signal which came meanwhile."""
    _ASKED.at_once = True
    if _ASKED.number == signal.SIGTERM or (_ASKED.number and code):
        code = 128 + _ASKED.number
    exit_now(code)


def _code(command: Any) -> int:
    """Return the exit code that a command's function ends with."""
    try:
        code = command()
    except SystemExit as end:
        code = end.code
    except KeyboardInterrupt:
        _say_interrupted()
        return 128 + (_ASKED.number or signal.SIGINT)
    except BaseException as error:
        # what is left of an interruption, after a library has turned it into something else
        if _ASKED.number:
            _say_interrupted()
            return 128 + _ASKED.number
        sys.excepthook(type(error), error, error.__traceback__)
        return 1
    if isinstance(code, str):
        sys.stderr.write(f"{code}\n")
        return 1
    return code or 0


def _say_interrupted() -> None:
    os.write(2, b"interrupted\n")


def _unraisable(unraisable: Any) -> None:
    """Say nothing of interruptions that came where nothing can be raised: they are remembered."""
    if not (_ASKED.number or isinstance(unraisable.exc_value, KeyboardInterrupt)):
        sys.__unraisablehook__(unraisable)


def _watch(child: int) -> NoReturn:
    """Wait for the one who works, forward signals, end it when its time is over, and leave as it
    did.
    """
    number, since, waited, killed = 0, 0.0, 0.0, False

    while True:
        found, status = os.waitpid(child, os.WNOHANG)
        if found:
            break

        came = signal.sigtimedwait(WATCHED_SIGNALS, 0.05 if number else 3600.0)
        if came is not None and came.si_signo in ENDING_SIGNALS and not number:
            number, since, waited = came.si_signo, time.monotonic(), seconds_waited(child)
            os.kill(child, number)

        if number and not killed:
            passed = time.monotonic() - since
            if passed > MAX_PATIENCE_S or passed - (seconds_waited(child) - waited) > END_TIMEOUT_S:
                os.kill(child, signal.SIGKILL)
                killed = True
                _say_interrupted()

    # a terminal asks both at once, and the one who works may have left before this one looked
    if not number:
        came = signal.sigtimedwait(ENDING_SIGNALS, 0.0)
        number = came.si_signo if came is not None else 0

    if number:
        end_orphans()

    if os.WIFEXITED(status):
        code = os.WEXITSTATUS(status)
        os._exit(128 + number if number and code else code)
    if number:
        os._exit(128 + number)

    deadly = os.WTERMSIG(status)
    if deadly != signal.SIGKILL:
        signal.signal(deadly, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, signal.valid_signals())
    os.kill(os.getpid(), deadly)
    os._exit(128 + deadly)
