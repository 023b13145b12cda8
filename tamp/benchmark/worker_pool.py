"""The interface of a pool of workers, of which each does one run at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from tamp.benchmark.case import Case

Work = Callable[[Case], dict[str, Any]]
"""Does a run and returns its line. It is sent to other processes: a function of a module, or a
partial of one.
"""

Ended = tuple[Case, dict[str, Any] | None]
"""A run with its line, or None when its worker was lost on the way."""

GRACE = 120.0
"""Seconds beyond its budget after which a run is given up and its process ended: loading,
verifying, a busy machine.
"""


class WorkerPool(Protocol):
    """Workers."""

    size: int

    def start(self, case: Case) -> None:
        """Give a run to an idle worker; at most `size` are under way."""
        ...

    def finished(self) -> list[Ended]:
        """Return runs that have ended since; waits for a fifth of a second at most."""
        ...

    def close(self) -> None:
        """End all workers."""
        ...
