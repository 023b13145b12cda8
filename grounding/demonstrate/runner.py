"""The commands that the page names, run in processes of their own while the page goes on."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

MOST = 60_000
"""Characters of what a command says that are kept."""

END_TIMEOUT_S = 0.5
"""Seconds that it may take to end when it is asked to."""

PROGRAMS: Mapping[str, str] = {
    "tamp-learn": "from tamp.commands.entry_points import learn; learn()",
    "tamp-solve": "from tamp.commands.entry_points import solve; solve()",
}
"""The commands, as this interpreter runs them."""


@dataclass(frozen=True)
class CommandState:
    """The state of a command.

    Attributes:
        command: Which one of PROGRAMS; empty when none was started.
        running: Whether it runs.
        code: Its exit status; None while it runs.
        text: What it has said so far.
    """

    command: str = ""
    running: bool = False
    code: int | None = None
    text: str = ""


class Runner:
    """Runs one command at a time. Use it as a context manager: leaving ends the command."""

    def __init__(self) -> None:
        self._command = ""
        self._process: subprocess.Popen[bytes] | None = None
        self._text = bytearray()
        self._reader: threading.Thread | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()

    def start(self, command: str, words: Sequence[str]) -> bool:
        """Start one of PROGRAMS with these arguments; False where one runs already."""
        if self.state().running:
            return False
        self._command, self._text = command, bytearray()
        self._process = subprocess.Popen(
            [sys.executable, "-c", PROGRAMS[command], *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        self._reader = threading.Thread(
            target=self._read, args=(self._process, self._text), daemon=True
        )
        self._reader.start()
        return True

    def state(self) -> CommandState:
        """Return how far the command is."""
        if self._process is None or self._reader is None:
            return CommandState()
        running = self._reader.is_alive()
        text = bytes(self._text).decode("utf-8", "replace").replace("\r", "\n")
        return CommandState(self._command, running, None if running else self._process.wait(), text)

    def stop(self) -> None:
        """End the command, if it runs."""
        if self._process is None or self._process.poll() is not None:
            return
        self._process.terminate()
        try:
            self._process.wait(END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(END_TIMEOUT_S)

    @staticmethod
    def _read(process: subprocess.Popen[bytes], into: bytearray) -> None:
        """Keep what a process says, its last part when that is much."""
        if process.stdout is None:
            return
        with process.stdout as stream:
            while some := os.read(stream.fileno(), 4096):
                into += some
                del into[: max(0, len(into) - MOST)]
