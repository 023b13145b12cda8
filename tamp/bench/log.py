"""The results of a benchmark: JSON lines, one a run, to which a later call adds what is missing."""

from __future__ import annotations

import fcntl
import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from tamp.bench.case import Case, key
from tamp.errors import InputError

ELSEWHERE = "Name another file with --out"

Line = dict[str, Any]


def read_log(path: Path) -> list[Line]:
    """All results of a file, the oldest first. A last line that was cut off is left out.

    Raises:
        InputError: It cannot be read, a line of it is no result, or there are none, or some of several settings.
    """
    lines = _lines(path, _whole(path))
    if not lines:
        raise InputError("there are no results yet", file=path)
    _check(path, lines, *_settings(lines[0]))
    return lines


class Log:
    """A file of results that is added to, by one process at a time.

    Args:
        path: JSON lines; made if need be. A last line that was cut off, as by a machine that went down, is removed, and
            its run done again.

    Raises:
        InputError: It cannot be read or written, another process adds to it, or it holds something else.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._stream = path.open("ab")
        except OSError as error:
            raise InputError(f"the results cannot be written: {error.strerror}", file=path, remedy=ELSEWHERE) from None
        try:
            self._lock()
            whole = _whole(path)
            self.lines = _lines(path, whole)
            self._stream.truncate(len(whole))
        except BaseException:
            self._stream.close()
            raise
        self._known = {key(line["config"]) for line in self.lines}

    def __enter__(self) -> Log:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stream.close()

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
        """The runs that are not among the results, each once."""
        wanted = {key(case.config): case for case in cases}
        return [case for identity, case in wanted.items() if identity not in self._known]

    def add(self, line: Mapping[str, Any]) -> None:
        """Append a result, on the disk before this returns."""
        plain = _plain(dict(line))
        self._stream.write(json.dumps(plain, allow_nan=False).encode() + b"\n")
        self._stream.flush()
        os.fsync(self._stream.fileno())
        self.lines.append(plain)
        self._known.add(key(plain["config"]))

    def _lock(self) -> None:
        try:
            fcntl.flock(self._stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            what = "another process is adding to these results"
            raise InputError(what, file=self.path, remedy=f"Wait for it, or n{ELSEWHERE[1:]}") from None


def _check(path: Path, lines: list[Line], time: float, algorithm: str, remedy: str = "") -> None:
    for number, line in enumerate(lines, start=1):
        if _settings(line) != (time, algorithm):
            other_time, other_algorithm = _settings(line)
            found = f"{other_time:g} s with '{other_algorithm}'"
            what = f"a run of {found} among those of {time:g} s with '{algorithm}'"
            raise InputError(what, file=path, line=number, remedy=remedy)


def _settings(line: Line) -> tuple[float, str]:
    return line["config"]["time"], line["config"]["algorithm"]


def _whole(path: Path) -> bytes:
    """The file up to the end of its last whole line."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"the results cannot be read: {error.strerror}", file=path) from None
    return content[: content.rfind(b"\n") + 1]


def _lines(path: Path, whole: bytes) -> list[Line]:
    return [_parsed(path, line, number) for number, line in enumerate(whole.split(b"\n")[:-1], start=1)]


def _parsed(path: Path, text: bytes, number: int) -> Line:
    try:
        line = json.loads(text)
        hash(key(line["config"]))
        sound = (
            isinstance(line["solved"], bool)
            and isinstance(line["outcome"], str)
            and math.isfinite(line["planning_s"])
            and math.isfinite(line["config"]["time"])
            and line["verified"] in (True, False, None)
        )
    except (ValueError, KeyError, TypeError):
        sound = False
    if not sound:
        raise InputError("no result of tamp-bench", file=path, line=number, remedy="Remove the line: its run is redone")
    return line


def _plain(value: Any) -> Any:
    """JSON knows no infinities."""
    if isinstance(value, dict):
        return {str(name): _plain(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
