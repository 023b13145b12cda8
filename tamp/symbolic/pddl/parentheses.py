"""The search for the wrong parenthesis in a text whose parentheses do not match.

Counting alone only finds that something is wrong at the end of the file, since every ')' closes the
innermost '('. What betrays the culprit comes earlier: a section such as `(:action` inside another
one, a keyword inside a condition, an indentation that returns to that of something still open.

It stays, although no other planner has the like: PDDL is written by hand, and without it the error
names the last line of the file, which is never the wrong one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tamp.symbolic.pddl.grammar import may_contain
from tamp.symbolic.pddl.structs import Place

MAX_TRIES = 50
"""Suspects that are examined before the first of them is named; bounds the time on long broken
files.
"""

MAX_LOOK = 20_000
"""Tokens that are looked at to see whether a ')' would mend it; a section of a sane file has fewer.
"""


@dataclass(frozen=True, slots=True)
class Token:
    """A parenthesis or a word; `indent` is the column of its line's first token, and `first` says
    if it is that one.
    """

    text: str
    place: Place
    indent: int
    first: bool


def left_open(tokens: Sequence[Token]) -> Token:
    """Find the '(' that was most probably left open, in a text in which at least one was."""
    open_: list[_Open] = []
    suspect: Token | None = None
    tries = 0
    for index in range(len(tokens)):
        if open_ and _suggests_missing(tokens, index, open_):
            culprit = tokens[open_[-1].index]
            if _repairs(tokens, index, len(open_) - 1):
                return culprit
            suspect = suspect or culprit
            tries += 1
            if tries == MAX_TRIES:
                break
        _step(tokens, index, open_)
    return suspect or tokens[open_[-1].index]


def surplus(tokens: Sequence[Token]) -> Token:
    """Find the ')' that was most probably one too many, in a text in which one closes nothing."""
    open_: list[_Open] = []
    for index, token in enumerate(tokens):
        before = tokens[index - 1]
        if token.text == ")":
            if not open_:
                return token
        elif index > 0 and before.text == ")":
            # What follows does not belong where it stands: the ')' before it closed one group too
            # many.
            if not open_ and not _starts_define(tokens, index):
                return before
            if open_ and not _fits_inside(tokens, index, open_[-1]):
                return before
        _step(tokens, index, open_)
    return tokens[-1]


@dataclass
class _Open:
    """An open group: the index of its '(', and how many groups it already holds."""

    index: int
    groups: int = 0


def _step(tokens: Sequence[Token], index: int, open_: list[_Open]) -> None:
    if tokens[index].text == "(":
        if open_:
            open_[-1].groups += 1
        open_.append(_Open(index))
    elif tokens[index].text == ")":
        open_.pop()


def _suggests_missing(tokens: Sequence[Token], index: int, open_: Sequence[_Open]) -> bool:
    """Check that the token could not stand where it does, had the innermost '(' been closed as
    it should.
    """
    token, inner = tokens[index], tokens[open_[-1].index]
    if token.text == ")":
        # A ')' that begins a line stands below the '(' that it closes, or below the beginning of
        # that one's line.
        column = token.place.column
        if not token.first or column in (inner.place.column, inner.indent):
            return False
        outer = (tokens[group.index] for group in open_[:-1])
        return any(column in (group.place.column, group.indent) for group in outer)
    if token.text == "(":
        return not _fits_inside(tokens, index, open_[-1]) or _aligned(token, tokens, open_)
    # Of other words only those after `(increase (total-cost` are sure to be misplaced.
    sure = token.text.startswith(":") or _word(tokens, open_[-1].index + 1) == "total-cost"
    return sure and not _fits_inside(tokens, index, open_[-1])


def _aligned(token: Token, tokens: Sequence[Token], open_: Sequence[_Open]) -> bool:
    """Check that the token begins a line at the column of a '(' still open: then it is its
    sibling, not its child.
    """
    if not token.first or token.place.column == 1:  # a file without indentation says nothing by it
        return False
    places = (tokens[group.index].place for group in open_[1:])
    return any(
        place.column == token.place.column and place.line < token.place.line for place in places
    )


def _repairs(tokens: Sequence[Token], start: int, depth: int) -> bool:
    """Check that a ')' before token `start` makes all well up to the next section, or the end of
    the text.
    """
    if len(tokens) - start > MAX_LOOK:
        tokens = tokens[: start + MAX_LOOK]
    for index in range(start, len(tokens)):
        if tokens[index].text == "(":
            if _starts_define(tokens, index):
                return depth == 0
            if _word(tokens, index + 1).startswith(":"):
                return depth == 1
            depth += 1
        elif tokens[index].text == ")":
            depth -= 1
            if depth < 0:
                return False
        elif tokens[index].text.startswith(":") and tokens[index - 1].text != "(" and depth < 2:
            return False
    return depth == 0


def _fits_inside(tokens: Sequence[Token], index: int, parent: _Open) -> bool:
    """Check that the item that begins at `index` may stand directly inside the group."""
    if index == parent.index + 1:
        return True  # its head
    head, previous = _word(tokens, parent.index + 1), _word(tokens, index - 1)
    return may_contain(
        head, parent.groups, _word(tokens, index), _word(tokens, index + 1), previous
    )


def _starts_define(tokens: Sequence[Token], index: int) -> bool:
    return tokens[index].text == "(" and _word(tokens, index + 1) == "define"


def _word(tokens: Sequence[Token], index: int) -> str:
    return tokens[index].text.lower() if 0 <= index < len(tokens) else ""
