"""The results: JSON lines to which a later call adds what is missing."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

from benchmarks.common import record
from tamp.errors import InputError

Line = dict[str, Any]


class Case(Protocol):
    """One measurement; a frozen data class, so that it can be compared."""

    @property
    def seed(self) -> int:
        """Of its training."""
        ...

    @property
    def config(self) -> dict[str, Any]:
        """All that tells it from another one, for the record."""
        ...


C = TypeVar("C", bound=Case)


class Journal:
    """A file of measurements, one a line.

    Args:
        path: Made when the first one is added. A last line that was cut off is removed, and measured again.
        made: Makes a case of a line's config; it raises TypeError for one that is none.

    Raises:
        InputError: A line is no measurement of a grounding.
    """

    def __init__(self, path: Path, made: Callable[..., Case]) -> None:
        self._made = made
        self.path = path.resolve()
        self.lines: list[Line] = []
        if not path.is_file():
            return
        content = path.read_bytes()
        whole = content[: content.rfind(b"\n") + 1]
        self.lines = [self._parsed(text, row) for row, text in enumerate(whole.splitlines(), start=1)]
        if whole != content:
            path.write_bytes(whole)

    def missing(self, cases: Sequence[C]) -> list[C]:
        """Those that are not among the results, each once."""
        known = [line["config"] for line in self.lines]
        return [case for case in dict.fromkeys(cases) if case.config not in known]

    def found(self, cases: Sequence[Case]) -> list[Line]:
        """The results of these."""
        wanted = [case.config for case in cases]
        return [line for line in self.lines if line["config"] in wanted]

    def add(self, case: Case, **fields: Any) -> Line:
        """Append a result."""
        record(self.path, seed=case.seed, config=case.config, **fields)
        line = self._parsed(self.path.read_bytes().splitlines()[-1], len(self.lines) + 1)
        self.lines.append(line)
        return line

    def _parsed(self, text: bytes, row: int) -> Line:
        try:
            line = json.loads(text)
            self._made(**line["config"])
        except (ValueError, KeyError, TypeError):
            remedy = "Remove the line: it is measured again"
            raise InputError("no measurement of a grounding", file=self.path, line=row, remedy=remedy) from None
        return line
