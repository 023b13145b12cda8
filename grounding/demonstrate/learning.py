"""Learning what was demonstrated, by the command that the page names, in a process of its own."""

from __future__ import annotations

import contextlib
import os
import shlex
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Self

MOST = 60_000
"""Characters of what the command says that are kept."""

PATIENCE = 3.0
"""Seconds that it may take to end when it is asked to."""


def learning_words(relation: str, folder: Path) -> list[str]:
    """Return the arguments of tamp-learn that learn a relation from a folder."""
    return ["new", relation, "--demos", str(folder)]


def learning_command(relation: str, folder: Path) -> str:
    """Return the command that learns a relation from a folder, as a user types it."""
    return shlex.join(["tamp-learn", *learning_words(relation, folder)])


@dataclass(frozen=True)
class Learned:
    """The state of the learning.

    Attributes:
        running: Whether the command runs.
        code: Its exit status; None while it runs, or when none was started.
        text: What it has said so far.
    """

    running: bool
    code: int | None
    text: str


class Learning:
    """Runs one learning command at a time. Use it as a context manager: leaving ends it."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._text = bytearray()
        self._reader: threading.Thread | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()

    def start(self, words: list[str]) -> bool:
        """Start tamp-learn with these arguments; False where one runs already."""
        if self._process is not None and self._process.poll() is None:
            return False
        self._text = bytearray()
        program = "from grounding.cli import main; main()"
        self._process = subprocess.Popen(
            [sys.executable, "-c", program, *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        self._reader = threading.Thread(
            target=self._read, args=(self._process, self._text), daemon=True
        )
        self._reader.start()
        return True

    def state(self) -> Learned:
        """Return how far it is."""
        text = self._text.decode("utf-8", "replace").replace("\r", "\n")
        if self._process is None:
            return Learned(False, None, "")
        running = self._reader is not None and self._reader.is_alive()
        return Learned(running, None if running else self._process.wait(), text)

    def stop(self) -> None:
        """End the command, if it runs."""
        if self._process is None or self._process.poll() is not None:
            return
        self._process.terminate()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(PATIENCE)

    @staticmethod
    def _read(process: subprocess.Popen[bytes], into: bytearray) -> None:
        """Keep what a process says, its last part when that is much."""
        if process.stdout is None:
            return
        while some := os.read(process.stdout.fileno(), 4096):
            into += some
            del into[: max(0, len(into) - MOST)]
