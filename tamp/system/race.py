"""Portfolio of several runs of one problem at a time, each in a process of its own: the first
answer that ends it counts.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, Generic, TypeVar

from tamp.errors import InputError
from tamp.system import guard
from tamp.system.deadline import Deadline

Answer = TypeVar("Answer")
Tell = Callable[[Any], None]
"""What a run calls with news of itself."""

KILL_AFTER_S = 1.0
"""Seconds after the deadline at which a run that has not answered is killed."""

POLL_INTERVAL_S = 0.2
"""Seconds between two looks whether somebody wants it to end."""

NICENESS = 10
"""How much nicer the other runs are than the first one, so that it is not slowed down where cores
are scarce.
"""

SEED_STRIDE = 1000
"""From one run's seed to the next one's."""


@dataclass(frozen=True)
class RaceResult(Generic[Answer]):
    """The answer that counts, and which run gave it."""

    run: int
    answer: Answer


def member_seed(seed: int, number: int) -> int:
    """Return the seed of run `number`, the first being 0: that run alone repeats what it found."""
    moved = seed + SEED_STRIDE * number
    return moved if abs(moved) < 2**64 else seed - SEED_STRIDE * number


def race(
    runs: Sequence[Callable[[Tell], Answer]],
    ends: Callable[[int, Answer], bool],
    deadline: Deadline,
    news: Callable[[int, Any], None] | None = None,
) -> RaceResult[Answer] | None:
    """Start all runs, wait for the first answer that ends the race, and kill the others.

    The processes are forks: they know the problem already, and only answers travel. They leave with
    this process, however it ends. Of answers that come at one time, that of the first run counts.

    Args:
        runs: Each is given `tell` and returns its answer, which must be picklable.
        ends: Whether a run's answer ends the race.
        deadline: When the runs end by themselves; they are killed a second later.
        news: Called here with a run's number and what it told.

    Returns:
        Without an ending answer the one of the first run that gave any; None when none did in time.

    Raises:
        InputError: As raised in a run.
        ChildProcessError: All runs broke down.
    """
    context = multiprocessing.get_context("fork")
    lifeline, held = os.pipe()
    processes: list[Any] = []
    open_: dict[Connection, int] = {}
    answers: dict[int, Answer] = {}

    try:
        for number, run in enumerate(runs):
            ours, theirs = context.Pipe(duplex=False)
            process = context.Process(
                target=_member, args=(run, number, theirs, lifeline, held), daemon=True
            )
            with guard.HeldSignals():
                process.start()
            theirs.close()
            processes.append(process)
            open_[ours] = number

        while open_ and deadline.elapsed() < deadline.seconds + KILL_AFTER_S:
            if guard.asked():
                # what it raised was dropped, as in a fork or while an answer was read
                raise KeyboardInterrupt

            left = deadline.seconds + KILL_AFTER_S - deadline.elapsed()
            ready = set(wait(list(open_), min(left, POLL_INTERVAL_S)))
            for pipe, number in [item for item in open_.items() if item[0] in ready]:
                try:
                    kind, content = pipe.recv()
                except EOFError:  # it broke down, and has said so itself
                    del open_[pipe]
                    continue

                if kind == "news":
                    if news is not None:
                        news(number, content)
                    continue

                del open_[pipe]
                if kind == "wrong":
                    raise content
                if ends(number, content):
                    return RaceResult(number, content)
                answers[number] = content

    finally:
        with guard.HeldSignals():
            for process in processes:
                process.kill()
            for process in processes:
                process.join()
        os.close(lifeline)
        os.close(held)

    if answers:
        number = min(answers)
        return RaceResult(number, answers[number])
    if not open_:
        raise ChildProcessError(f"all {len(runs)} runs broke down; their messages stand above")
    return None


def _member(
    run: Callable[[Tell], Any], number: int, pipe: Connection, lifeline: int, held: int
) -> None:
    """Execute one run, in its process."""
    guard.obey_only_parent()
    os.close(held)
    threading.Thread(target=_leave_with, args=(lifeline,), daemon=True).start()
    if number:
        os.nice(NICENESS)

    def tell(content: Any) -> None:
        pipe.send(("news", content))

    with contextlib.suppress(BrokenPipeError):
        try:
            pipe.send(("answer", run(tell)))
        except InputError as error:
            pipe.send(("wrong", error))


def _leave_with(lifeline: int) -> None:
    """End this process once the one that started it is gone: then nobody holds the other end of the
    pipe.
    """
    os.read(lifeline, 1)
    os._exit(1)
