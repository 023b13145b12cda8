"""The reader of s-expressions: text in, nodes with their places out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from tamp.pddl.nodes import Group, Node, Symbol, error
from tamp.pddl.parentheses import Token, left_open, surplus
from tamp.pddl.structs import Place

MAX_DEPTH = 100
"""Deeper nesting is refused, so that no later recursion over the tree can overflow."""

_WORD = re.compile(r"[()]|[^\s();]+")


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
    tokens = list(_tokens(text, None if file is None else str(file), line_offset, column_offset))
    forms: list[Node] = []
    stack: list[tuple[Place, list[Node]]] = []
    for token in tokens:
        items = stack[-1][1] if stack else forms
        if token.text == "(":
            if len(stack) >= MAX_DEPTH:
                raise error(token.place, f"nested more than {MAX_DEPTH} parentheses deep")
            stack.append((token.place, []))
        elif token.text == ")":
            if not stack:
                raise error(surplus(tokens).place, "this ')' closes nothing: there is one too many")
            place, inner = stack.pop()
            (stack[-1][1] if stack else forms).append(Group(tuple(inner), place))
        else:
            items.append(Symbol(token.text.lower(), token.text, token.place))
    if stack:
        raise error(left_open(tokens).place, "this '(' is never closed: a ')' is missing")
    return tuple(forms)


def read_one(
    text: str, what: str, file: str | Path | None = None, *, line_offset: int = 0, column_offset: int = 0
) -> Node:
    """Read a text that holds exactly one s-expression; `what` says which: "(define (domain NAME) ...)"."""
    forms = read(text, file, line_offset=line_offset, column_offset=column_offset)
    if not forms:
        start = Place(None if file is None else str(file), 1 + line_offset, 1 + column_offset)
        raise error(start, f"empty: expected {what}")
    form, *others = forms
    if others:
        raise error(others[0], f"expected the end of the text after {what}, found more")
    return form


def _tokens(text: str, file: str | None, line_offset: int, column_offset: int) -> Iterator[Token]:
    lines = text.removeprefix("\ufeff").split("\n")
    for number, line in enumerate(lines):
        shift = column_offset if number == 0 else 0
        code = line.partition(";")[0]
        indent: int | None = None
        for match in _WORD.finditer(code):
            column = match.start() + 1 + shift
            first = indent is None
            indent = column if indent is None else indent
            yield Token(match[0], Place(file, number + 1 + line_offset, column), indent, first)
