"""Declared names: types and their parents, objects said twice, predicates and functions."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.declarations import (
    MAX_TYPE_DEPTH,
    check_requirements,
    parse_functions,
    parse_objects,
    parse_predicates,
    parse_types,
)
from tamp.symbolic.pddl.nodes import Group, Node
from tamp.symbolic.pddl.sexpr import read


def nodes(text: str) -> tuple[Node, ...]:
    """The entries of one section."""
    (group,) = read(f"({text})")
    assert isinstance(group, Group)
    return group.items


# ---------------------------------------------------------------- types


def test_a_type_stands_below_its_parent_and_object_below_itself() -> None:
    types = parse_types(nodes("mug bowl - dish dish tool"))
    assert types.parents == {
        "mug": "dish", "bowl": "dish", "dish": "object", "tool": "object", "object": "object",
    }  # fmt: skip
    assert not types.more_parents and not types.notes


def test_a_type_that_stands_twice_has_both_parents() -> None:
    types = parse_types(nodes("mug - dish mug - tool dish tool"))
    assert types.parents["mug"] == "dish" and types.more_parents == {"mug": ("tool",)}
    either = parse_types(nodes("mug - (either dish tool) dish tool"))
    assert (either.parents, either.more_parents) == (types.parents, types.more_parents)


def test_object_and_itself_as_parents_say_nothing() -> None:
    types = parse_types(nodes("mug - mug dish - object cup - (either object dish) object"))
    assert types.parents == {"mug": "object", "dish": "object", "cup": "dish", "object": "object"}
    assert types.more_parents == {}


def test_a_parent_that_is_not_listed_is_noted_with_what_was_meant() -> None:
    types = parse_types(nodes("mug - dishh dish"))
    assert types.parents["dishh"] == "object"
    (note,) = types.notes
    assert "'dishh' is not listed itself, only as a parent. Did you mean 'dish'?" in note


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("object - mug mug", "cannot stand below another one"),
        ("b - c c - a a - b", "types form a cycle: b - c - a - b"),
        (" ".join(f"t{i} - t{i + 1}" for i in range(MAX_TYPE_DEPTH + 2)), str(MAX_TYPE_DEPTH)),
    ],
    ids=["root", "circle", "depth"],
)
def test_types_that_cannot_be(text: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_types(nodes(text))
    assert words in caught.value.message


# ---------------------------------------------------------------- objects

TYPES = {"object": "object", "dish": "object", "mug": "dish", "tool": "object"}


def test_objects_have_their_types_and_without_one_they_are_objects() -> None:
    notes: list[str] = []
    found = parse_objects(nodes("a b - mug c - (either dish tool) d"), TYPES, "an object", notes)
    assert found == {"a": ("mug",), "b": ("mug",), "c": ("dish", "tool"), "d": ("object",)}
    assert not notes


def test_an_object_said_again_is_noted_and_with_another_type_refused() -> None:
    notes: list[str] = []
    found = parse_objects(nodes("a - mug\na - mug"), TYPES, "an object", notes)
    assert found == {"a": ("mug",)}
    assert len(notes) == 1 and "object 'a' stands twice; first in line 1" in notes[0]
    with pytest.raises(InputError, match="stands twice; first in line 1, of type mug, here tool"):
        parse_objects(nodes("a - mug\na - tool"), TYPES, "an object", [])


def test_a_constant_of_the_domain_may_be_said_again_as_it_is() -> None:
    notes: list[str] = []
    constants = {"a": ("mug",)}
    assert parse_objects(nodes("a - mug b"), TYPES, "an object", notes, constants) == {
        "b": ("object",)
    }
    assert "'a' is already a constant of the domain" in notes[0]
    with pytest.raises(InputError, match="already a constant of the domain, of type mug"):
        parse_objects(nodes("a - tool"), TYPES, "an object", [], constants)


def test_an_unknown_type_is_refused_with_what_was_meant() -> None:
    with pytest.raises(InputError) as caught:
        parse_objects(nodes("a - mugg"), TYPES, "an object", [])
    assert "mugg" in str(caught.value) and "mug" in (caught.value.choices or ())


# ---------------------------------------------------------------- predicates, functions


def test_predicates_have_typed_parameters() -> None:
    found = parse_predicates(nodes("(on ?a - mug ?b) (free)"), TYPES)
    on = found.by_name["on"]
    assert [(one.name, one.types) for one in on.parameters] == [
        ("?a", ("mug",)), ("?b", ("object",)),
    ]  # fmt: skip
    assert found.by_name["free"].parameters == ()


def test_the_same_declaration_may_stand_twice_and_no_other() -> None:
    found = parse_predicates(nodes("(on ?a ?b) (on ?c ?d)"), TYPES)
    assert len(found.by_name) == 1 and len(found.notes) == 1
    with pytest.raises(InputError, match="on"):
        parse_predicates(nodes("(on ?a ?b) (on ?a)"), TYPES)


@pytest.mark.parametrize("name", ["and", "when", "=", "either"])
def test_a_word_of_pddl_names_no_predicate(name: str) -> None:
    with pytest.raises(InputError):
        parse_predicates(nodes(f"({name} ?a)"), TYPES)


def test_functions_are_numbers() -> None:
    found = parse_functions(nodes("(total-cost) - number (distance ?a - mug) (weight ?a)"), TYPES)
    assert list(found.by_name) == ["total-cost", "distance", "weight"]
    assert parse_functions(nodes("- mug"), TYPES).by_name == {}  # the type of nothing


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("(f ?a) - mug", "object fluents"),
        ("(f ?a) - thing", "functions have numbers as values, found 'thing'"),
        ("(f ?a) g", "expected a function such as (distance ?a ?b), found 'g'"),
        ("(f ?a) -", "found '-'"),
    ],
)
def test_functions_of_other_values_are_refused(text: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_functions(nodes(text), TYPES)
    assert words in caught.value.message


def test_a_word_that_is_no_requirement_is_noted_with_what_was_meant() -> None:
    (note,) = check_requirements(nodes(":strips :typng :adl"))
    assert "unknown requirement ':typng'. Did you mean ':typing'?" in note
