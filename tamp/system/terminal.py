"""Standard streams of a command: harmless whatever names files hold, never lost in silence."""

from __future__ import annotations

import contextlib
import functools
import io
import os
import sys
from collections.abc import Callable
from typing import ParamSpec, TextIO

from tamp.errors import one_line, printable

UNPRINTED = 2
"""The exit status of a command whose output could not be printed, or which the machine could not
carry out.
"""

ERASE = "\x1b[K"
"""What a line of progress ends with: erase the rest of the line."""

P = ParamSpec("P")


class Shown(io.TextIOBase):
    """A standard stream that never fails: what could not be printed is known at the end, and the
    work is done.

    Args:
        stream: The true one; None when it was closed before the program began.
        kept: Control characters that are ours, beside the one that ends a line.
        plain: Whether nothing is to be escaped, as in a coloured help.
    """

    def __init__(self, stream: TextIO | None, kept: str = "\n\t", *, plain: bool = False) -> None:
        self._stream, self._kept, self._plain = stream, kept, plain
        self.broken = False
        self.failure: str | None = None
        if isinstance(stream, io.TextIOWrapper):
            with contextlib.suppress(OSError, ValueError):
                # a terminal without our letters is no reason to fail
                stream.reconfigure(errors="replace")

    @property
    def encoding(self) -> str:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Return the encoding of the stream."""
        return self._stream.encoding if self._stream is not None else "utf-8"

    def write(self, text: str) -> int:
        """Print, with what a terminal would obey escaped."""
        if self._stream is None:
            self.failure = "it is closed"
        if self.failure is not None or self._stream is None:
            return len(text)
        shown = (
            text
            if self._plain
            else ERASE.join(printable(part, self._kept) for part in text.split(ERASE))
        )
        try:
            self._stream.write(shown)
        except (OSError, ValueError) as error:
            self._fail(error)
        return len(text)

    def flush(self) -> None:
        """Pass on what is held back."""
        if self._stream is None or self.failure is not None:
            return
        try:
            self._stream.flush()
        except (OSError, ValueError) as error:
            self._fail(error)

    def isatty(self) -> bool:
        """Check whether the stream is a terminal."""
        return self._stream is not None and not self._stream.closed and self._stream.isatty()

    def writable(self) -> bool:
        """Return True: the stream can always be written."""
        return True

    def fileno(self) -> int:
        """Return the file descriptor of the stream."""
        if self._stream is None:
            raise OSError("the stream is closed")
        return self._stream.fileno()

    def _fail(self, error: Exception) -> None:
        self.failure = getattr(error, "strerror", None) or "it is closed"
        self.broken = isinstance(error, BrokenPipeError)
        with contextlib.suppress(OSError, ValueError):  # Python must not try the rest again at exit
            os.dup2(os.open(os.devnull, os.O_WRONLY), self.fileno())


def unheard() -> bool:
    """Check whether nobody can read what this command prints."""
    return isinstance(sys.stdout, Shown) and sys.stdout.failure is not None


def spoken(command: Callable[P, int | None]) -> Callable[P, int]:
    """Let a command print through streams of this kind, and end with 2 when something could not be
    printed.

    Args:
        command: Returns, or leaves by `sys.exit` with, its exit status.
    """

    @functools.wraps(command)
    def speaking(*args: P.args, **kwargs: P.kwargs) -> int:
        _fill()
        plain = any(word in ("-h", "--help") for word in (*sys.argv[1:], *_words(args)))
        out, err = Shown(sys.stdout, plain=plain), Shown(sys.stderr, "\n\t\r", plain=plain)

        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                code = command(*args, **kwargs) or 0
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else int(end.code is not None)
            except (OSError, MemoryError) as error:  # the machine's fault, wherever it comes
                place = (
                    f"{error.filename}: " if isinstance(error, OSError) and error.filename else ""
                )
                reason = (
                    isinstance(error, OSError) and error.strerror
                ) or "there is not enough memory"
                err.write(f"error: {one_line(f'{place}{reason}')}\n")
                code = UNPRINTED

            out.flush()
            # interrupted; a help that nobody reads to its end
            excused = code > 128 or (plain and out.broken)
            if out.failure is not None and not excused:
                err.write(f"error: the standard output cannot be written: {out.failure}\n")
                code = UNPRINTED
            err.flush()
        return code

    return speaking


def _words(arguments: tuple[object, ...]) -> list[str]:
    """List the command line's words, when they were passed in the place of those of the process."""
    return [str(word) for words in arguments if isinstance(words, list | tuple) for word in words]


def _fill() -> None:
    """Take the places of closed standard streams, so that no file that is opened later gets what is
    printed there.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest free number: this one
