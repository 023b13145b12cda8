"""The results of a benchmark: JSON lines, one a run, to which a later call adds what is missing."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tamp.bench.case import Case, key
from tamp.errors import InputError


class Log:
    """A file of results.

    Args:
        path: JSON lines; made when the first run ends.

    Raises:
        InputError: It cannot be read, or holds something else. A last line that was cut off, as by a machine that went
            down, is no error: it is dropped, and its run done again.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines: list[dict[str, Any]] = []
        if not path.exists():
            return
        try:
            text = path.read_bytes().decode("utf-8", errors="replace")
        except OSError as error:
            raise InputError(f"the results cannot be read: {error.strerror}", file=path) from error
        whole, _, rest = text.rpartition("\n")
        for number, line in enumerate(whole.splitlines(), start=1):
            self.lines.append(self._parsed(line, number))
        if rest:
            with path.open("rb+") as stream:
                stream.truncate(len(whole.encode()) + (1 if whole else 0))

    def done(self, case: Case) -> bool:
        """Whether the run is among the results."""
        return key(case.config) in self._keys

    @property
    def _keys(self) -> set[tuple[Any, ...]]:
        return {key(line["config"]) for line in self.lines}

    def missing(self, cases: list[Case]) -> list[Case]:
        """The runs that are not among the results."""
        known = self._keys
        return [case for case in cases if key(case.config) not in known]

    def of(self, cases: list[Case]) -> list[dict[str, Any]]:
        """The results of these runs, in their order."""
        found = {key(line["config"]): line for line in self.lines}
        return [found[key(case.config)] for case in cases if key(case.config) in found]

    def add(self, line: Mapping[str, Any]) -> None:
        """Append a result, on the disk before this returns."""
        plain = _plain(dict(line))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(plain, allow_nan=False) + "\n")
            stream.flush()
            os.fsync(stream.fileno())
        self.lines.append(plain)

    def _parsed(self, line: str, number: int) -> dict[str, Any]:
        try:
            parsed = json.loads(line)
            key(parsed["config"])
        except (ValueError, KeyError, TypeError) as error:
            remedy = "Name another file with --out"
            raise InputError("no result of tamp-bench", file=self.path, line=number, remedy=remedy) from error
        return parsed


def _plain(value: Any) -> Any:
    """JSON knows no infinities."""
    if isinstance(value, dict):
        return {str(name): _plain(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
