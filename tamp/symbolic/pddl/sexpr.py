"""The reader of s-expressions: text in, nodes with their places out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from tamp.symbolic.pddl.nodes import Group, Node, Symbol, error
from tamp.symbolic.pddl.parentheses import Token, left_open, surplus
from tamp.symbolic.pddl.structs import Place

MAX_DEPTH = 100
"""Deeper nesting is refused, so that no later recursion over the tree can overflow."""

MAX_WORD = 1000
"""Characters; longer words are refused: none has a meaning, and numbers of thousands of digits take
their time.
"""

MAX_TOKENS = 1_000_000
"""Words and parentheses of a text; more would need gigabytes."""

MAX_SEARCHED_TOKENS = 200_000
"""Words from which on a text is not searched for its wrong parenthesis: the place where it was
noticed is named.
"""

_WORD = re.compile(r"[()]|\?[^\s()?;]*|[^\s()?;]+")
"""A variable begins a word of its own: Fast Downward reads `(aircraft?a)` as `(aircraft ?a)`."""

_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")


def read(
    text: str, file: str | Path | None = None, *, line_offset: int = 0, column_offset: int = 0
) -> tuple[Node, ...]:
    """Read all s-expressions of a text. `;` starts a comment that ends with its line.

    Args:
        text: The text; when it is a part of a file, the offsets say where it begins there.
        file: For messages only; nothing is opened.
        line_offset: Lines before the text's first line.
        column_offset: Columns before the text on its first line.

    Raises:
        InputError: At the parenthesis that was left open, or that closes nothing.
    """
    name = None if file is None else str(file)
    forms: list[Node] = []
    stack: list[tuple[Place, list[Node]]] = []
    lower: dict[str, str] = {}
    words = _words(text, name, line_offset, column_offset)

    for count, (word, line, column) in enumerate(words):
        items = stack[-1][1] if stack else forms
        if count >= MAX_TOKENS:
            raise error(
                Place(name, line, column), f"more than {MAX_TOKENS:,} words and parentheses"
            )
        if word == "(":
            if len(stack) >= MAX_DEPTH:
                raise error(
                    Place(name, line, column), f"nested more than {MAX_DEPTH} parentheses deep"
                )
            stack.append((Place(name, line, column), []))
        elif word == ")":
            if not stack:
                culprit = (
                    surplus(_tokens(text, name, line_offset, column_offset)).place
                    if count < MAX_SEARCHED_TOKENS
                    else None
                )
                where = culprit or Place(name, line, column)
                raise error(where, "this ')' closes nothing: there is one too many")
            place, inner = stack.pop()
            (stack[-1][1] if stack else forms).append(Group(tuple(inner), place))
        else:
            items.append(
                Symbol(lower.setdefault(word, word.lower()), word, Place(name, line, column))
            )

    if stack:
        tokens = _tokens(text, name, line_offset, column_offset)
        culprit = left_open(tokens).place if len(tokens) < MAX_SEARCHED_TOKENS else stack[-1][0]
        raise error(culprit, "this '(' is never closed: a ')' is missing")

    return tuple(forms)


def read_one(
    text: str,
    what: str,
    file: str | Path | None = None,
    *,
    line_offset: int = 0,
    column_offset: int = 0,
) -> Node:
    """Read a text that holds exactly one s-expression; `what` says which: "(define (domain NAME)
    ...)".
    """
    forms = read(text, file, line_offset=line_offset, column_offset=column_offset)
    if not forms:
        start = Place(None if file is None else str(file), 1 + line_offset, 1 + column_offset)
        raise error(start, f"empty: expected {what}")
    form, *others = forms
    if others:
        raise error(others[0], f"expected the end of the text after {what}, found more")
    return form


def _tokens(text: str, file: str | None, line_offset: int, column_offset: int) -> list[Token]:
    """Return the first MANY words with what their indentation says, for a text whose parentheses
    do not match.
    """
    tokens: list[Token] = []
    last, indent = 0, 0
    for word, line, column in islice(
        _words(text, file, line_offset, column_offset), MAX_SEARCHED_TOKENS
    ):
        first = line != last
        last, indent = line, column if first else indent
        tokens.append(Token(word, Place(file, line, column), indent, first))
    return tokens


def _words(
    text: str, file: str | None, line_offset: int, column_offset: int
) -> Iterator[tuple[str, int, int]]:
    """Generate each word and parenthesis with its line and column."""
    lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    interned: dict[str, str] = {}
    for number, line in enumerate(lines, start=1 + line_offset):
        shift = 1 + (column_offset if number == 1 + line_offset else 0)
        for match in _WORD.finditer(line.partition(";")[0]):
            word, column = match[0], match.start() + shift
            same = interned.get(word)  # one string for all of its places: a third of the memory
            if same is None:
                _check(word, Place(file, number, column))
                same = interned[word] = word
            yield same, number, column


def _check(word: str, place: Place) -> None:
    """Refuse what can be no word."""
    if len(word) > MAX_WORD:
        raise error(place, f"a word of {len(word):,} characters")
    if control := _CONTROL.search(word):
        raise error(place, f"a control character (U+{ord(control[0]):04X}) in a word")
