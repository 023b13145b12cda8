"""What a node of a text must be for its reader, and the error at its place where it is something else."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.nodes import (
    Group,
    Node,
    as_group,
    as_name,
    as_symbol,
    as_variable,
    error,
    show,
    warning,
)
from tamp.symbolic.pddl.sexpr import read
from tamp.symbolic.pddl.structs import Place


def node(text: str) -> Node:
    (only,) = read(text, "f.pddl")
    return only


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("Mug", "'Mug'"),
        ("()", "'()'"),
        ("(On)", "'(On)'"),
        ("(On mug)", "'(On ...)'"),
        ("((on) mug)", "'(...)'"),
    ],
)
def test_a_node_is_shown_in_a_few_characters(text: str, shown: str) -> None:
    assert show(node(text)) == shown


def test_the_head_is_the_first_word_and_no_list() -> None:
    heads = [group.head for group in read("(On a) ((on) a) ()") if isinstance(group, Group)]
    assert heads == ["on", None, None]


def test_words_and_lists_are_told_apart() -> None:
    assert as_symbol(node("Mug"), "a type").text == "mug"
    with pytest.raises(InputError, match=r"^f.pddl:1:2: expected a type, found '\(a ...\)'"):
        as_symbol(node(" (a b)"), "a type")
    assert as_group(node("(a)"), "a condition").head == "a"
    with pytest.raises(InputError, match=r"^f.pddl:2:1: expected a condition, found 'A'"):
        as_group(node("\nA"), "a condition")


@pytest.mark.parametrize("text", ["?x", ":types", "-", "(a)"])
def test_variables_keywords_and_dashes_name_nothing(text: str) -> None:
    with pytest.raises(InputError, match="expected a name, found"):
        as_name(node(text), "a name")


def test_a_name_may_contain_what_it_may_not_be() -> None:
    assert [as_name(node(text), "a name").text for text in ("a-b", "-b", "b:")] == [
        "a-b", "-b", "b:",
    ]  # fmt: skip


def test_a_variable_has_a_name_behind_its_mark() -> None:
    assert as_variable(node("?X")).text == "?x"
    for text in ("x", "?", ":x"):
        with pytest.raises(InputError, match=r"expected a variable such as \?x, found '"):
            as_variable(node(text))


def test_an_error_stands_at_a_node_or_at_a_place() -> None:
    made = error(node("\n  a"), "odd", found="tabel", choices=["table"], remedy="Mend it")
    assert (made.file, made.line, made.column) == ("f.pddl", 2, 3)
    assert "Did you mean 'table'?" in str(made) and str(made).endswith("Mend it")
    assert warning(Place("g.pddl", 4, 5), "odd") == "g.pddl:4:5: odd"
