"""What is wrong with an input, said once and clearly."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from pathlib import Path


class InputError(Exception):
    """Bad input from the user: where it stands, what was found, what would have been valid.

    The command line prints it as one message and exits with 2; no traceback, nothing written.

    Args:
        message: What is wrong, naming the culprit, as a sentence without its final full stop.
        file: The file in which it stands.
        line: 1-based line, or None when the file as a whole is meant.
        column: 1-based column.
        found: The offending word; with `choices` it makes the did-you-mean.
        choices: The valid words.
        remedy: What to do about it, when it is neither a typo nor obvious.
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | Path | None = None,
        line: int | None = None,
        column: int | None = None,
        found: str | None = None,
        choices: Iterable[str] = (),
        remedy: str = "",
    ) -> None:
        self.message = message
        self.file = None if file is None else str(file)
        self.line = line
        self.column = column
        self.choices = tuple(choices)
        self.suggestion = closest(found, self.choices) if found else None
        self.remedy = remedy
        super().__init__(self._text())

    def at(self, file: str | Path | None, line: int | None = None) -> InputError:
        """The same error with the place filled in where it was missing."""
        placed = InputError(
            self.message, file=self.file or file, line=self.line or line, column=self.column,
            choices=self.choices, remedy=self.remedy,
        )  # fmt: skip
        placed.suggestion = self.suggestion
        placed.args = (placed._text(),)
        return placed

    def _text(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
        text = f"{place}: {self.message}" if place else self.message
        if self.choices:
            text += f". Choices: {', '.join(self.choices)}"
        if self.suggestion:
            text += f". Did you mean '{self.suggestion}'?"
        if self.remedy:
            text += f"{'' if text.endswith('?') else '.'} {self.remedy}"
        return text


def closest(word: str, choices: Iterable[str]) -> str | None:
    """The choice that `word` was probably meant to be, or None when nothing is near."""
    matches = difflib.get_close_matches(word, list(choices), n=1, cutoff=0.6)
    return matches[0] if matches else None
