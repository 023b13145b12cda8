from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.errors import InputError
from tamp.symbolic.pddl.nodes import Group, Node, Symbol
from tamp.symbolic.pddl.sexpr import MAX_DEPTH, read, read_one
from tamp.symbolic.pddl.structs import Place

Nested = str | list["Nested"]

letters = st.characters(codec="utf-8", exclude_characters="();?", exclude_categories=["Z", "C"])
words = st.builds("{}{}".format, st.sampled_from(["", "?"]), st.text(letters, min_size=1))
trees = st.recursive(words, lambda inner: st.lists(inner, max_size=4), max_leaves=30)
blanks = st.sampled_from([" ", "\n", "\t", "\r\n", " ; a (comment\n", "\n\n  "])


def write(tree: Nested, blank: str) -> str:
    return (
        tree
        if isinstance(tree, str)
        else f"({blank}{blank.join(write(item, blank) for item in tree)}{blank})"
    )


def plain(node: Node) -> Nested:
    return node.written if isinstance(node, Symbol) else [plain(item) for item in node.items]


@given(st.lists(trees, max_size=5), blanks)
def test_reading_what_was_written_gives_it_back(forms: list[Nested], blank: str) -> None:
    text = blank.join(write(form, blank) for form in forms)
    assert [plain(node) for node in read(text)] == forms


@given(st.lists(trees, min_size=1, max_size=5), blanks)
def test_every_node_stands_where_it_says(forms: list[Nested], blank: str) -> None:
    text = blank.join(write(form, blank) for form in forms)
    lines = text.split("\n")
    waiting = list(read(text))
    count = 0
    while waiting:
        node = waiting.pop()
        word = "(" if isinstance(node, Group) else node.written
        assert lines[node.place.line - 1].startswith(word, node.place.column - 1)
        count += 1
        waiting += node.items if isinstance(node, Group) else ()
    assert count >= len(forms)


def test_case_is_ignored_but_remembered() -> None:
    (group,) = read("(On MUG Table)")
    assert group == read("(on mug table)")[0]
    assert isinstance(group, Group)
    assert [item.written for item in group.items if isinstance(item, Symbol)] == [
        "On",
        "MUG",
        "Table",
    ]
    assert group.head == "on"


def test_offsets_move_places() -> None:
    (group,) = read("(a\n b)", "p.yaml", line_offset=10, column_offset=6)
    assert isinstance(group, Group)
    assert group.place == Place("p.yaml", 11, 7)
    assert [item.place for item in group.items] == [Place("p.yaml", 11, 8), Place("p.yaml", 12, 2)]


@pytest.mark.parametrize("text", ["", "  \n", "; only a comment", "\ufeff"])
def test_empty(text: str) -> None:
    with pytest.raises(InputError, match=r"^f\.pddl:1:1: empty: expected \(define") as caught:
        read_one(text, "(define ...)", "f.pddl")
    assert (caught.value.line, caught.value.column) == (1, 1)


def test_more_than_one() -> None:
    with pytest.raises(InputError, match=r"^f\.pddl:2:2: expected the end"):
        read_one("(a)\n (b)", "(a)", "f.pddl")


def test_depth_is_bounded() -> None:
    assert read("(" * MAX_DEPTH + ")" * MAX_DEPTH)
    with pytest.raises(InputError, match=f":{MAX_DEPTH + 1}: nested more"):
        read("(" * (MAX_DEPTH + 1) + ")" * (MAX_DEPTH + 1))
    with pytest.raises(InputError, match="nested more"):
        read("(" * 5_000)
