"""A clock for tests that others' load does not break."""

from __future__ import annotations

import os
import time
from pathlib import Path


def unhindered() -> float:
    """The monotonic clock, less the time for which this process was ready to run and others had the cores."""
    return time.monotonic() - waited(os.getpid())


def waited(process: int) -> float:
    """Seconds for which the main thread of a process has waited for a core."""
    try:
        return int(Path(f"/proc/{process}/schedstat").read_text(encoding="ascii").split()[1]) * 1e-9
    except (OSError, IndexError):
        return 0.0
