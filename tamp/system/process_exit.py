"""Exit of a command's process."""

from __future__ import annotations

import atexit
import contextlib
import os
import sys
from typing import NoReturn


def exit_now(code: int) -> NoReturn:
    """End the process now, with what was printed and what others asked to be done at exit.

    Python would first take its objects and libraries to pieces one by one: 0.4 s after a plan of
    four objects, of the two that the command takes (benchmarks/cold_start.py).
    """
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        # nobody reads on, it is full or it is closed
        with contextlib.suppress(OSError, ValueError):
            if stream is not None:
                stream.flush()
    os._exit(code)
