"""What a command says while it works and when it is done."""

from __future__ import annotations

import os
import sys
import time
from dataclasses import dataclass, field
from typing import Any


def say(text: str) -> None:
    """Print a line, whether anybody reads on or not."""
    try:
        print(text, flush=True)
    except BrokenPipeError:  # nobody reads on: the plan is wanted all the same
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@dataclass
class Progress:
    """A line on a terminal that is rewritten while planning goes on."""

    quiet: bool
    _started: float = field(default_factory=time.monotonic)
    _last: float = 0.0
    _shown: bool = False

    def line(self, text: str) -> None:
        """Print to stay."""
        if not self.quiet:
            say(text)

    def update(self, effort: Any) -> None:
        """Rewrite the progress line ten times a second; elsewhere than on a terminal, print one every five seconds."""
        now = time.monotonic()
        terminal = sys.stderr.isatty()
        if self.quiet or now - self._last < (0.1 if terminal else 5.0) or (not terminal and now - self._started < 2.0):
            return
        self._last = now
        text = f"  searching   {effort.skeletons} skeletons · {effort.draws:,} samples · {now - self._started:.1f} s"
        print(f"\r{text}\x1b[K" if terminal else text, end="" if terminal else "\n", file=sys.stderr, flush=True)
        self._shown = terminal

    def compiling(self, count: int) -> None:
        """Say that kernels are being compiled, of which so many are done: on a terminal in a line that is rewritten."""
        terminal = sys.stderr.isatty()
        if self.quiet or (count and not terminal):
            return
        text = "  compiling kernels, once for this installation"
        print(
            f"\r{text}: {count}\x1b[K" if terminal else text, end="" if terminal else "\n", file=sys.stderr, flush=True
        )
        self._shown = terminal

    def clear(self) -> None:
        """Remove the progress line."""
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
            self._shown = False
