"""Facts and functions in the text of a streams file, before the domain they belong to is known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tamp.symbolic.pddl.formulas import RESERVED
from tamp.symbolic.pddl.nodes import Group, Node, Symbol
from tamp.symbolic.pddl.structs import Parameter, Predicate


def facts_of(nodes: Sequence[Node]) -> Iterator[tuple[str, int, Group]]:
    """Generate the facts in a streams file: (name, number of arguments, where). PDDLStream's
    domains leave some undeclared.
    """
    for node in nodes:
        if not isinstance(node, Group) or not node.items:
            continue

        head = node.head
        if head == "define":
            yield from facts_of(node.items[2:])
        elif head in (":stream", ":wild-stream", ":rule", ":predicate", ":function", ":optimizer"):
            items = list(node.items[1:])
            if head == ":function" and items and isinstance(items[0], Group):
                items = items[1:]
            after = [b for a, b in zip([None, *items], items, strict=False) if not _lists(a)]
            yield from facts_of(after)
        elif head in (":variables", ":constraint"):
            yield from facts_of(
                [b for a, b in zip(node.items, node.items[1:], strict=False) if not _lists(a)]
            )
        elif head == "and":
            yield from facts_of(node.items[1:])
        elif head is not None and head[0] not in "?:" and head not in RESERVED:
            yield head, len(node.items) - 1, node


def stream_functions(nodes: Sequence[Node]) -> Iterator[tuple[str, Predicate]]:
    """Generate the functions that a streams file computes, with as many arguments as it says."""
    for node in nodes:
        if not isinstance(node, Group):
            continue
        if node.head == "define":
            yield from stream_functions(node.items[2:])
        elif node.head == ":function" and len(node.items) > 1 and isinstance(node.items[1], Group):
            head = node.items[1]
            if head.head is not None:
                parameters = tuple(Parameter(f"?x{i}") for i in range(len(head.items) - 1))
                yield head.head, Predicate(head.head, parameters)


def _lists(before: Node | None) -> bool:
    """Check that what follows is a list of words, no condition."""
    return isinstance(before, Symbol) and before.text in (
        ":inputs",
        ":outputs",
        ":fluents",
        ":variables",
        ":objective",
    )
