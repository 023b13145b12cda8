"""Progress of the runs, as lines of text."""

from __future__ import annotations

import sys
import time
import weakref
from collections.abc import Mapping
from typing import Any, TextIO

from tamp.benchmark.summary import succeeded
from tamp.benchmark.table import short
from tamp.system.progress import Progress

SELDOM = 5.0
"""Seconds between two lines where no terminal can rewrite one."""


class ProgressLine:
    """A line that is rewritten on a terminal, and printed now and then elsewhere.

    Args:
        total: Runs of the benchmark.
        stream: Where to, if not to the standard error.
        quiet: Say nothing.
    """

    def __init__(self, total: int, stream: TextIO | None = None, quiet: bool = False) -> None:
        self._total, self._stream, self._quiet = total, stream or sys.stderr, quiet
        self._started = time.monotonic()
        self._last = 0.0
        self._done = self._solved = 0
        self._meanwhile = Progress(quiet or stream is not None)
        self._meanwhile.begin(f"0/{total} runs ended")
        weakref.finalize(self, self._meanwhile.end)

    def ended(self, line: Mapping[str, Any], left: int) -> None:
        """Report that a run has ended, and how many are still to come."""
        self._done += 1
        self._solved += succeeded(line)
        self._meanwhile.begin(f"{self._total - left}/{self._total} runs ended")
        if not left:
            self._meanwhile.end()
        now = time.monotonic()
        terminal = self._stream.isatty()
        if self._quiet or (not terminal and left and now - self._last < SELDOM):
            return

        self._last = now
        minutes, seconds = divmod(round((now - self._started) / self._done * left), 60)
        config = line["config"]
        rejected = " REJECTED" if line["solved"] and not succeeded(line) else ""
        text = (
            f"{self._total - left}/{self._total} runs · {self._solved} of {self._done} solved · "
            f"{minutes}:{seconds:02d} left · {short(config['problem'])} "
            f"{config['sampler']} seed {config['seed']}: "
            f"{line['outcome']}{rejected} {line['planning_s']:.2f} s"
        )

        end = "" if terminal and left else "\n"
        print(f"\r{text}\x1b[K" if terminal else text, end=end, file=self._stream, flush=True)
