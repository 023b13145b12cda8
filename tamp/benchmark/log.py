"""The results of a benchmark: JSON lines, one a run, to which a later call adds what is missing."""

from __future__ import annotations

import contextlib
import fcntl
import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from tamp.benchmark.case import Case, key
from tamp.benchmark.line import Line, read_line
from tamp.errors import InputError
from tamp.system.reading import read_bytes

ELSEWHERE = "Name another file with --out"

BEGINNING = b'{"config": '
"""Of each line."""

LONGEST_LINE = 10_000_000
"""Bytes."""

MOST_BYTES = 100_000_000
"""The largest file of results that is read: fifty thousand runs."""


def read_log(path: Path) -> list[Line]:
    """Read all results of a file, the oldest first. A last line that was cut off is left out.

    Raises:
        InputError: It cannot be read, a line of it is no result, or there are none, or some of
            several settings.
    """
    lines = _lines(path, _whole(path))
    if not lines:
        raise InputError("there are no results yet", file=path)
    _check(path, lines, *_settings(lines[0]))
    return lines


class RunLog:
    """A file of results that is added to, by one process at a time.

    Args:
        path: JSON lines; made if need be. A last line that was cut off, as by a machine that went
            down, is removed, and its run done again.

    Raises:
        InputError: It cannot be read or written, another process adds to it, or it holds something
            else.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._new = not os.path.lexists(path)
        if not self._new:
            _check_own(path)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._stream = path.open("ab", buffering=0)
        except OSError as error:
            raise InputError(
                f"the results cannot be written: {error.strerror}", file=path, remedy=ELSEWHERE
            ) from None

        try:
            self._lock()
            whole = _whole(path)
            self.lines = _lines(path, whole)
            _check_own(path)
            self._stream.truncate(len(whole))
        except BaseException:
            self._close()
            raise

        self._logged = {key(line["config"]) for line in self.lines}

    def __enter__(self) -> RunLog:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close()

    def check(self, time: float, algorithm: str) -> None:
        """Refuse to add runs of other settings, which no table could compare.

        Args:
            time: The budget of the runs to come, in seconds.
            algorithm: Theirs.

        Raises:
            InputError: The first line that has others.
        """
        _check(self.path, self.lines, time, algorithm, ELSEWHERE)

    def missing(self, cases: list[Case]) -> list[Case]:
        """Return the runs that are not among the results, each once."""
        wanted = {key(case.config): case for case in cases}
        return [case for identity, case in wanted.items() if identity not in self._logged]

    def add(self, line: Mapping[str, Any]) -> None:
        """Append a result, on the disk before this returns."""
        plain = _plain(dict(line))
        size = os.fstat(self._stream.fileno()).st_size
        try:
            remaining = json.dumps(plain, allow_nan=False).encode() + b"\n"
            while remaining:
                remaining = remaining[self._stream.write(remaining) :]
            os.fsync(self._stream.fileno())
        except OSError as error:
            with contextlib.suppress(OSError):  # no half a line
                self._stream.truncate(size)
            what = f"the results cannot be written: {error.strerror}"
            raise InputError(
                what, file=self.path, remedy="The same command goes on where this one was"
            ) from None
        self.lines.append(plain)
        self._logged.add(key(plain["config"]))

    def _close(self) -> None:
        if self._new and not os.fstat(self._stream.fileno()).st_size:  # nothing came of it
            self.path.unlink(missing_ok=True)
        self._stream.close()

    def _lock(self) -> None:
        try:
            fcntl.flock(self._stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            what = "another process is adding to these results"
            raise InputError(
                what, file=self.path, remedy=f"Wait for it, or n{ELSEWHERE[1:]}"
            ) from None


def _check(path: Path, lines: list[Line], time: float, algorithm: str, remedy: str = "") -> None:
    for number, line in enumerate(lines, start=1):
        if _settings(line) != (time, algorithm):
            other_time, other_algorithm = _settings(line)
            found = f"{other_time:g} s with '{other_algorithm}'"
            what = f"a run of {found} among those of {time:g} s with '{algorithm}'"
            raise InputError(what, file=path, line=number, remedy=remedy)


def _settings(line: Line) -> tuple[float, str]:
    return line["config"]["time"], line["config"]["algorithm"]


def _check_own(path: Path) -> None:
    """Refuse to add to, or to mend, what tamp-bench has not written; whole lines are looked at when
    they are read.

    Raises:
        InputError: It is no regular file, or its only line, which may have been cut off, begins as
            none of ours.
    """
    if not os.path.isfile(path):
        raise InputError(
            "the results cannot be written: it is no regular file", file=path, remedy=ELSEWHERE
        )
    with path.open("rb") as stream:
        head = stream.read(LONGEST_LINE)
    if b"\n" not in head and head[: len(BEGINNING)] != BEGINNING[: len(head)]:
        raise InputError("this is no file of results of tamp-bench", file=path, remedy=ELSEWHERE)


def _whole(path: Path) -> bytes:
    """Read the file up to the end of its last whole line."""
    content = read_bytes(path, MOST_BYTES, kind="file of results")
    return content[: content.rfind(b"\n") + 1]


def _lines(path: Path, whole: bytes) -> list[Line]:
    return [
        read_line(line, path, number)
        for number, line in enumerate(whole.split(b"\n")[:-1], start=1)
    ]


def _plain(value: Any) -> Any:
    """Replace infinities, which JSON does not know."""
    if isinstance(value, dict):
        return {str(name): _plain(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
