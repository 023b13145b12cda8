"""Typed lists: which names a type is behind, variables that stand twice, and what is no list."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.errors import InputError
from tamp.symbolic.pddl.nodes import Symbol
from tamp.symbolic.pddl.sexpr import read
from tamp.symbolic.pddl.structs import Parameter
from tamp.symbolic.pddl.typed import (
    declared_types,
    distinct,
    parameters,
    placeholders,
    refuse_duplicates,
    typed_list,
)

TYPES = {"object": "object", "body": "object", "pose": "object"}


def listed(text: str) -> list[tuple[str, tuple[str, ...]]]:
    return [
        (one.name.text, tuple(type_.text for type_ in one.types))
        for one in typed_list(read(text), "a name")
    ]


@pytest.mark.parametrize(
    ("text", "entries"),
    [
        ("", []),
        ("a b", [("a", ()), ("b", ())]),
        ("a b - body", [("a", ("body",)), ("b", ("body",))]),
        ("a - body b", [("a", ("body",)), ("b", ())]),
        (
            "a - body b c - pose d",
            [("a", ("body",)), ("b", ("pose",)), ("c", ("pose",)), ("d", ())],
        ),
        ("a - (either body pose)", [("a", ("body", "pose"))]),
        ("- body a", [("a", ())]),  # Fast Downward reads a type of no names
        ("A - Body", [("a", ("body",))]),
    ],
)
def test_a_type_is_of_all_names_before_it(text: str, entries: list) -> None:
    assert listed(text) == entries


@pytest.mark.parametrize(
    ("text", "words", "column"),
    [
        ("a -", "expected a type after '-', found the end of the list", 3),
        ("a (b) - body", r"expected a name, found '\(b\)'", 3),
        ("a - (or body pose)", r"expected a type or \(either type ...\), found '\(or ...\)'", 5),
        ("a - (either)", r"expected a type or \(either type ...\), found '\(either\)'", 5),
        ("a - (either (b))", "expected a type, found", 13),
    ],
)
def test_what_is_no_typed_list_is_refused_at_its_place(text: str, words: str, column: int) -> None:
    with pytest.raises(InputError, match=words) as told:
        listed(text)
    assert (told.value.line, told.value.column) == (1, column)


def test_parameters_are_variables_of_declared_types() -> None:
    assert parameters(read("?a ?b - body ?c"), TYPES) == (
        Parameter("?a", ("body",)),
        Parameter("?b", ("body",)),
        Parameter("?c", ("object",)),
    )
    assert parameters(read("?a - (either body pose body)"), TYPES) == (
        Parameter("?a", ("body", "pose")),
    )
    with pytest.raises(InputError, match=r"unknown type 'bdy'.*Did you mean 'body'"):
        parameters(read("?a - bdy"), TYPES)
    for wrong in ("a", "?", ":a"):
        with pytest.raises(
            InputError, match=f"expected a variable such as .x, found '.*{wrong[-1]}'"
        ):
            parameters(read(wrong), TYPES)


@given(
    st.lists(st.sampled_from(["?x", "?y", "?x~2", "?z"]), max_size=8),
    st.sets(st.sampled_from(["?x", "?y"])),
)
def test_names_made_distinct_differ_from_each_other_and_from_those_taken(
    names: list[str], taken: set[str]
) -> None:
    made = [one.name for one in distinct([Parameter(name, (name,)) for name in names], taken)]
    assert len({*made, *taken}) == len(made) + len(taken)
    for name, new in zip(names, made, strict=True):
        assert new == name or new.startswith(f"{name}~")
    first = {name: made[names.index(name)] for name in names if name not in taken}
    assert all(
        first[name] == name or name == "?x~2" for name in first
    )  # the first keeps its name where it can


def test_a_declaration_may_name_two_parameters_alike() -> None:
    assert [one.name for one in placeholders(read("?x ?x ?x - body"), TYPES)] == [
        "?x",
        "?x~2",
        "?x~3",
    ]


def test_types_are_checked_and_each_counts_once() -> None:
    symbols = [node for node in read("pose body pose") if isinstance(node, Symbol)]
    assert declared_types(symbols, TYPES) == ("pose", "body")
    assert declared_types((), TYPES) == ()


def test_the_second_of_two_equal_names_is_refused_with_the_line_of_the_first() -> None:
    symbols = [node for node in read("a\nb\nA") if isinstance(node, Symbol)]
    refuse_duplicates(symbols[:2], "object")
    with pytest.raises(InputError, match="object 'A' stands twice; first in line 1") as told:
        refuse_duplicates(symbols, "object")
    assert told.value.line == 3
