"""Input errors: the place, the offending word and the valid choices, in one line."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable
from pathlib import Path

LONGEST = 2_000
"""Characters of a message: a name may be a megabyte."""

MOST_CHOICES = 40
"""Choices that a message names."""

LONGEST_WORD = 100
"""Characters of a word that may be a typing error."""

HIDDEN = frozenset(("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"))
"""Unicode's categories of what a terminal obeys or hides: controls, bidirectional marks, halves of
characters.
"""


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
        """Return the same error with the place filled in where it was missing."""
        return self._placed(self.file or file, self.line or line, self.column)

    def about(self, file: str | Path) -> InputError:
        """Return the same error about a whole file, which the one that it names was made from."""
        return self._placed(file, None, None)

    def _placed(self, file: str | Path | None, line: int | None, column: int | None) -> InputError:
        placed = InputError(
            self.message, file=file, line=line, column=column, choices=self.choices,
            remedy=self.remedy,
        )  # fmt: skip
        placed.suggestion = self.suggestion
        placed.args = (placed._text(),)
        return placed

    def _text(self) -> str:
        place = ":".join(
            str(part) for part in (self.file, self.line, self.column) if part is not None
        )
        text = f"{place}: {self.message}" if place else self.message
        if self.choices:
            more = (
                f" and {len(self.choices) - MOST_CHOICES:,} more"
                if len(self.choices) > MOST_CHOICES
                else ""
            )
            text += f". Choices: {', '.join(self.choices[:MOST_CHOICES])}{more}"
        if self.suggestion:
            text += f". Did you mean '{self.suggestion}'?"
        if self.remedy:
            text += f"{'' if text.endswith('?') else '.'} {self.remedy}"
        return one_line(text)


def one_line(text: str) -> str:
    """Sanitize a message: one line of bounded length, harmless wherever it is shown."""
    shown = printable(re.sub(r"[\r\n]+", " ", text))
    return shown if len(shown) <= LONGEST else f"{shown[:LONGEST]} ..."


def printable(text: str, kept: str = "") -> str:
    """Escape what a terminal would obey or hide, as Python writes it, in backslashes.

    Args:
        text: Anything, names out of files among it.
        kept: Control characters that stay: line breaks and tabulators where a text has several
            lines.
    """
    if text.isprintable():
        return text
    hidden = {one for one in set(text) if one not in kept and unicodedata.category(one) in HIDDEN}
    return (
        text.translate({ord(one): one.encode("unicode_escape").decode() for one in hidden})
        if hidden
        else text
    )


def closest(word: str, choices: Iterable[str]) -> str | None:
    """Return the closest match of a word among the choices, or None when nothing is near."""
    if len(word) > LONGEST_WORD:
        return None
    matches = difflib.get_close_matches(word, list(choices), n=1, cutoff=0.6)
    return matches[0] if matches else None
