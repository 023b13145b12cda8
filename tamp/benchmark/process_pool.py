"""Runs side by side in processes of this machine.

Our own and not joblib's, which does not end a run that hangs.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import multiprocessing.connection
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from typing import Any

from tamp.benchmark.case import Case
from tamp.benchmark.worker_pool import GRACE, Ended, Work
from tamp.errors import InputError
from tamp.system import guard

READY = "ready"
"""What a process says when it has prepared itself."""

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS")
"""What libraries read, so that runs side by side do not race for the cores."""


@dataclass
class _Worker:
    process: Any
    pipe: Connection
    ready: bool = False
    case: Case | None = None
    since: float = 0.0


class ProcessPool:
    """Processes, each with an interpreter of its own and libraries that use one thread.

    Args:
        size: How many; more than the cores makes the times meaningless.
        work: What they do.
        prepare: Called once in each process before its first run.
    """

    def __init__(self, size: int, work: Work, prepare: Callable[[], None]) -> None:
        self.size = size
        self._job = (work, prepare)
        self._context = multiprocessing.get_context("spawn")
        for name in THREADS:
            os.environ.setdefault(name, "1")
        resource_tracker.ensure_running()  # which would let signals through while it starts
        self._workers: list[_Worker] = []
        for _ in range(size):
            self._workers.append(self._hire())

    def start(self, case: Case) -> None:
        """Give a run to an idle worker."""
        worker = next(worker for worker in self._workers if worker.case is None)
        worker.case, worker.since = case, time.monotonic()
        with contextlib.suppress(OSError):  # it has died meanwhile, which `finished` sees
            worker.pipe.send(case)

    def finished(self) -> list[Ended]:
        """Return runs that have ended since; waits for a fifth of a second at most.

        Raises:
            InputError: A process ended before it was ready: the next one would, too.
        """
        busy = [(worker, worker.case) for worker in self._workers if worker.case is not None]
        if guard.asked():  # what it raised was dropped
            raise KeyboardInterrupt
        heard = multiprocessing.connection.wait([worker.pipe for worker, _ in busy], 0.2)
        ended: list[Ended] = []
        for worker, case in busy:
            late = worker.ready and time.monotonic() - worker.since > case.time + GRACE
            if worker.pipe not in heard and not late:
                continue
            said = None if late else _received(worker)
            if said == READY:
                worker.ready, worker.since = True, time.monotonic()
                continue
            if not isinstance(said, dict):
                self._replace(worker)
                said = None
            ended.append((case, said))
            worker.case = None
        return ended

    def close(self) -> None:
        """End all workers."""
        with guard.HeldSignals():
            for worker in self._workers:
                worker.process.kill()
            for worker in self._workers:
                _end(worker)

    def _hire(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(theirs, *self._job), daemon=True)
        with guard.HeldSignals():
            process.start()
        theirs.close()
        return _Worker(process, ours)

    def _replace(self, worker: _Worker) -> None:
        _end(worker)
        if not worker.ready:
            raise InputError(
                "a worker's process ended before its first run", remedy="What it said is above"
            )
        self._workers[self._workers.index(worker)] = self._hire()


def _end(worker: _Worker) -> None:
    worker.pipe.close()
    worker.process.kill()
    worker.process.join()


def _received(worker: _Worker) -> Any:
    try:
        return worker.pipe.recv()
    except (EOFError, OSError):
        return None


def _serve(pipe: Connection, work: Work, prepare: Callable[[], None]) -> None:
    """Serve runs in a worker's process, all day."""
    guard.obey_only_parent()
    prepare()
    try:
        pipe.send(READY)
        while True:
            pipe.send(work(pipe.recv()))
    except (EOFError, BrokenPipeError):  # the one who leads is gone
        return
