"""Who does the runs: processes side by side on this machine, or a Ray cluster."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import os
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, Protocol

from tamp.bench.case import Case

Work = Callable[[Case], dict[str, Any]]
"""Does a run and returns its line. It is sent to other processes: a function of a module, or a partial of one."""

GRACE = 120.0
"""Seconds beyond its budget after which a run is given up and its process ended: loading, verifying, a busy machine."""


class Crew(Protocol):
    """Workers, of which each does one run at a time."""

    size: int

    def start(self, case: Case) -> None:
        """Give a run to an idle worker; at most `size` are under way."""
        ...

    def finished(self) -> list[tuple[Case, dict[str, Any] | None]]:
        """Wait for a moment; runs that have ended, with their lines, or None when the worker was lost on the way."""
        ...

    def close(self) -> None:
        """End all workers."""
        ...


@dataclass
class _Worker:
    process: Any
    pipe: Connection
    case: Case | None = None
    since: float = 0.0


class Processes:
    """Processes of this machine, each with an interpreter of its own.

    Args:
        size: How many; more than the cores makes the times meaningless.
        work: What they do.
        prepare: Called once in each process before its first run.
    """

    def __init__(self, size: int, work: Work, prepare: Callable[[], None]) -> None:
        self.size = size
        self._job = (work, prepare)
        self._context = multiprocessing.get_context("spawn")
        self._workers = [self._hire() for _ in range(size)]

    def _hire(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(theirs, *self._job), daemon=True)
        process.start()
        theirs.close()
        return _Worker(process, ours)

    def start(self, case: Case) -> None:
        """Give a run to an idle worker."""
        worker = next(worker for worker in self._workers if worker.case is None)
        worker.case, worker.since = case, time.monotonic()
        try:
            worker.pipe.send(case)
        except OSError:
            pass  # it has died meanwhile, which `finished` sees

    def finished(self) -> list[tuple[Case, dict[str, Any] | None]]:
        """Runs that have ended since; waits a fifth of a second at most."""
        busy = [worker for worker in self._workers if worker.case is not None]
        ready = multiprocessing.connection.wait([worker.pipe for worker in busy], 0.2)
        ended: list[tuple[Case, dict[str, Any] | None]] = []
        for worker in busy:
            case = worker.case
            if case is None:
                continue
            late = time.monotonic() - worker.since > case.time + GRACE
            if worker.pipe not in ready and not late:
                continue
            line = None if late else _received(worker)
            ended.append((case, line))
            worker.case = None
            if line is None:
                self._end(worker)
                self._workers[self._workers.index(worker)] = self._hire()
        return ended

    def pids(self) -> list[int]:
        """The processes' numbers."""
        return [worker.process.pid for worker in self._workers]

    def close(self) -> None:
        """End all workers."""
        for worker in self._workers:
            self._end(worker)

    @staticmethod
    def _end(worker: _Worker) -> None:
        worker.pipe.close()
        worker.process.kill()
        worker.process.join()


def _received(worker: _Worker) -> dict[str, Any] | None:
    try:
        return worker.pipe.recv()
    except (EOFError, OSError):
        return None


def _serve(pipe: Connection, work: Work, prepare: Callable[[], None]) -> None:
    """What a worker's process does all day."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the one who leads, who ends us
    prepare()
    while True:
        try:
            case = pipe.recv()
        except EOFError:
            return
        pipe.send(work(case))


def single_threaded() -> None:
    """Have libraries use one thread in this process and those that it starts, so that runs side by side do not race."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"):
        os.environ.setdefault(name, "1")
