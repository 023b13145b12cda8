"""The tree that a text of s-expressions is read into; every node knows where it stands."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Place


@dataclass(frozen=True, slots=True)
class Symbol:
    """A word. PDDL ignores case: `text` is in lower case, `written` as the user wrote it."""

    text: str
    written: str = field(compare=False)
    place: Place = field(compare=False)


@dataclass(frozen=True, slots=True)
class Group:
    """A parenthesised list; its place is that of its '('."""

    items: tuple[Node, ...]
    place: Place = field(compare=False)

    @property
    def head(self) -> str | None:
        """Return the text of its first item when that is a symbol."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Symbol) else None


Node = Symbol | Group


def error(
    where: Node | Place,
    message: str,
    *,
    found: str | None = None,
    choices: Iterable[str] = (),
    remedy: str = "",
) -> InputError:
    """Make an InputError at a node's place."""
    place = where if isinstance(where, Place) else where.place
    return InputError(
        message,
        file=place.file,
        line=place.line,
        column=place.column,
        found=found,
        choices=choices,
        remedy=remedy,
    )


def warning(where: Node | Place, message: str) -> str:
    """Word a warning at a node's place, for what is odd but no error."""
    return str(error(where, message))


def show(node: Node) -> str:
    """Show the node in a few characters, for messages."""
    if isinstance(node, Symbol):
        return f"'{node.written}'"
    first = node.items[0] if node.items else None
    if isinstance(first, Symbol):
        return f"'({first.written}{' ...' if len(node.items) > 1 else ''})'"
    return "'(...)'" if node.items else "'()'"


def as_symbol(node: Node, what: str) -> Symbol:
    """Return the node as a symbol; `what` says what was expected: "a type"."""
    if isinstance(node, Group):
        raise error(node, f"expected {what}, found {show(node)}")
    return node


def as_name(node: Node, what: str) -> Symbol:
    """Return the node as a symbol that names something: no variable, keyword or dash."""
    symbol = as_symbol(node, what)
    if symbol.text[0] in "?:" or symbol.text == "-":
        raise error(symbol, f"expected {what}, found '{symbol.written}'")
    return symbol


def as_variable(node: Node) -> Symbol:
    """Return the node as a variable, such as ?x."""
    symbol = as_symbol(node, "a variable such as ?x")
    if symbol.text[0] != "?" or len(symbol.text) == 1:
        raise error(symbol, f"expected a variable such as ?x, found '{symbol.written}'")
    return symbol


def as_group(node: Node, what: str) -> Group:
    """Return the node as a parenthesised list; `what` says what was expected: "a condition such
    as (on ?a ?b)".
    """
    if isinstance(node, Symbol):
        raise error(node, f"expected {what}, found '{node.written}'")
    return node
