"""The frame of every PDDL file: `(define (domain NAME) (:section ...) ...)`, and `:keyword value`
pairs inside.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tamp.symbolic.pddl.features import FEATURES, unsupported
from tamp.symbolic.pddl.nodes import Group, Node, Symbol, as_group, as_name, as_symbol, error, show
from tamp.symbolic.pddl.sexpr import read_one


@dataclass(frozen=True, slots=True)
class Section:
    """`(:keyword item ...)`; `group` is the whole of it."""

    keyword: Symbol
    items: tuple[Node, ...]
    group: Group


def read_sections(
    text: str, kind: str, keywords: Sequence[str], file: str | Path | None
) -> tuple[Symbol, list[Section]]:
    """Read `(define (KIND NAME) section ...)`: the name and the sections, their keywords
    checked.
    """
    frame = f"(define ({kind} NAME) ...)"
    form = as_group(read_one(text, frame, file), frame)
    if form.head != "define":
        raise error(form.items[0] if form.items else form, f"expected {frame}, found {show(form)}")
    if len(form.items) < 2:
        raise error(form, f"expected {frame}, found nothing after 'define'")
    title = as_group(form.items[1], f"({kind} NAME)")
    if title.head != kind:
        raise error(title, f"expected ({kind} NAME), found {show(title)}")
    if len(title.items) != 2:
        raise error(
            title, f"expected ({kind} NAME) with one name, found {len(title.items) - 1} names"
        )
    return as_name(title.items[1], "a name"), [
        _section(item, kind, keywords) for item in form.items[2:]
    ]


def single(sections: Sequence[Section], keyword: str) -> Section | None:
    """Return the only section of that keyword, or None."""
    found = [section for section in sections if section.keyword.text == keyword]
    if len(found) > 1:
        first = found[0].keyword.place.line
        raise error(found[1].keyword, f"section '{keyword}' stands twice; first in line {first}")
    return found[0] if found else None


def items_of(sections: Sequence[Section], keyword: str) -> tuple[Node, ...]:
    """Return what stands in the only section of that keyword; nothing without one."""
    section = single(sections, keyword)
    return section.items if section else ()


def keyword_values(nodes: Sequence[Node], owner: str, keywords: Sequence[str]) -> dict[str, Node]:
    """Read `:keyword value :keyword value`; `owner` says whose they are: "action 'pick'"."""
    values: dict[str, Node] = {}
    position = 0

    while position < len(nodes):
        keyword = as_symbol(nodes[position], f"a keyword of {owner}: {', '.join(keywords)}")
        if keyword.text not in keywords and keyword.text in FEATURES:
            raise error(keyword, unsupported(keyword.text, keyword.written))
        if keyword.text not in keywords:
            raise error(
                keyword,
                f"unknown keyword '{keyword.written}' of {owner}",
                found=keyword.text,
                choices=keywords,
            )
        if keyword.text in values:
            raise error(keyword, f"keyword '{keyword.text}' of {owner} stands twice")
        value = nodes[position + 1] if position + 1 < len(nodes) else None
        if value is None or (isinstance(value, Symbol) and value.text.startswith(":")):
            raise error(keyword, f"'{keyword.text}' of {owner} has no value")
        values[keyword.text] = value
        position += 2

    return values


def _section(node: Node, kind: str, keywords: Sequence[str]) -> Section:
    group = as_group(node, f"a section of the {kind} such as ({keywords[0]} ...)")
    if not group.items:
        raise error(group, f"expected a section of the {kind}, found '()'", choices=keywords)
    keyword = as_symbol(group.items[0], f"a section's keyword, one of {', '.join(keywords)}")
    if keyword.text not in keywords and keyword.text in FEATURES:
        raise error(keyword, unsupported(keyword.text, keyword.written))
    if keyword.text not in keywords:
        message = f"unknown section '{keyword.written}' of the {kind}"
        raise error(keyword, message, found=keyword.text, choices=keywords)
    return Section(keyword, group.items[1:], group)
