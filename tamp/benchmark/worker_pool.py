"""The interface of a pool of workers, of which each does one run at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

from tamp.benchmark.case import Case


class PoolRun(Protocol):
    """The run that a worker is given; hashable, and it can be sent to another process."""

    @property
    def time(self) -> float:
        """Return its budget, seconds."""
        ...


R = TypeVar("R", bound=PoolRun)

Work = Callable[[Case], dict[str, Any]]
"""Does a benchmark's run and returns its line. It is sent to other processes: a function of a
module, or a partial of one.
"""

Ended = tuple[Case, dict[str, Any] | None]
"""A run with its line, or None when its worker was lost on the way."""

GRACE = 120.0
"""Seconds beyond its budget after which a run is given up and its process ended: loading,
verifying, a busy machine.
"""


class WorkerPool(Protocol[R]):
    """Workers."""

    size: int

    def start(self, case: R) -> None:
        """Give a run to an idle worker; at most `size` are under way."""
        ...

    def finished(self) -> list[tuple[R, Any]]:
        """Return runs that have ended since, each with what came out, None when its worker was lost
        on the way; waits for a fifth of a second at most.
        """
        ...

    def close(self) -> None:
        """End all workers."""
        ...
