"""Progress reports of a command: while it works and when it is done."""

from __future__ import annotations

import os
import sys
import threading
import time
from dataclasses import dataclass, field
from typing import Any

SILENCE_S = 2.0
"""Seconds after which a line says what is being done, where no terminal can rewrite one."""

REWRITE_INTERVAL_S = 0.1
"""Seconds between two rewritings of a terminal's line while there is news,"""

WITHOUT_NEWS = 0.5
"""and while there is none."""

# held over a fork, so that no child begins with the other thread's half line
_PRINTING = threading.RLock()
os.register_at_fork(
    before=_PRINTING.acquire, after_in_parent=_PRINTING.release, after_in_child=_PRINTING.release
)


def say(text: str) -> None:
    """Print a line, whether anybody reads on or not."""
    try:
        print(text, flush=True)
    except BrokenPipeError:  # nobody reads on: the plan is wanted all the same
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@dataclass
class Progress:
    """A line that says what a command does: rewritten on a terminal, elsewhere printed after two
    silent seconds.

    Counters and clock only ever grow: what is done in another try comes on top of what was shown.
    While it is begun, a thread speaks for a main thread that is busy in a long search.
    """

    quiet: bool
    phase: str = "searching"
    _started: float = field(default_factory=time.monotonic)
    _last: float = field(default_factory=time.monotonic)
    _shown: bool = False
    _before: tuple[int, int] = (0, 0)
    _now: tuple[int, int] = (0, 0)
    _stop: threading.Event | None = None

    def begin(self, phase: str) -> None:
        """Say from now on that this is being done, should it take long."""
        self.clear()
        self.phase = phase
        self._before = self._counted
        self._now = (0, 0)
        if self._stop is None and not self.quiet:
            self._started = self._last = time.monotonic()
            self._stop = threading.Event()
            threading.Thread(target=self._speak, args=(self._stop,), daemon=True).start()

    def news(self, phase: str) -> None:
        """Say from now on that the work has come so far."""
        if self._stop is None:
            self.begin(phase)
        self.phase = phase
        self._tell(REWRITE_INTERVAL_S)

    def end(self) -> None:
        """Say nothing more by itself."""
        if self._stop is not None:
            self._stop.set()
            self._stop = None
        self.clear()

    def line(self, text: str) -> None:
        """Print to stay."""
        if not self.quiet:
            with _PRINTING:
                self.clear()
                say(text)
                self._last = time.monotonic()

    def update(self, effort: Any) -> None:
        """Note what was done so far, and rewrite the line where there is time for it."""
        self._now = max(self._now[0], effort.skeletons), max(self._now[1], effort.draws)
        self._tell(REWRITE_INTERVAL_S)

    def compiling(self, count: int) -> None:
        """Say that kernels are being compiled, of which so many are done: on a terminal in a line
        that is rewritten.
        """
        terminal = sys.stderr.isatty()
        if self.quiet or (count and not terminal):
            return
        text = "  compiling kernels, once for this installation"
        print(
            f"\r{text}: {count}\x1b[K" if terminal else text,
            end="" if terminal else "\n",
            file=sys.stderr,
            flush=True,
        )
        self._shown = terminal

    def clear(self) -> None:
        """Remove the progress line."""
        with _PRINTING:
            if self._shown:
                print("\r\x1b[K", end="", file=sys.stderr, flush=True)
                self._shown = False

    @property
    def _counted(self) -> tuple[int, int]:
        return self._before[0] + self._now[0], self._before[1] + self._now[1]

    def _tell(self, often: float) -> None:
        now = time.monotonic()
        with _PRINTING:
            try:
                terminal = sys.stderr.isatty()
                if self.quiet or now - self._last < (often if terminal else SILENCE_S):
                    return
                self._last = now

                skeletons, draws = self._counted
                counts = (
                    f"{skeletons} skeletons · {draws:,} samples · " if skeletons or draws else ""
                )
                text = f"  {self.phase:<11} {counts}{now - self._started:.1f} s"

                print(
                    f"\r{text}\x1b[K" if terminal else text,
                    end="" if terminal else "\n",
                    file=sys.stderr,
                    flush=True,
                )
                self._shown = terminal
            except (OSError, ValueError):  # nobody listens any more
                self.quiet = True

    def _speak(self, stop: threading.Event) -> None:
        # the terminal's clock runs on while there is no news
        while not stop.wait(WITHOUT_NEWS / 2):
            self._tell(WITHOUT_NEWS)
