"""Relations as users write them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grounding.demonstrate.relation import (
    KINDS,
    PRESETS,
    Argument,
    DemonstratedRelation,
    parse_relation,
)
from grounding.relations.options import TAKEN
from tamp.errors import InputError


@pytest.mark.parametrize(
    ("text", "name", "kinds"),
    [
        ("stack(a, b)", "stack", ["object", "object"]),
        ("(stack ?a ?b)", "stack", ["object", "object"]),
        (" Upright ( o ) ", "upright", ["object"]),
        ("within(a, b: container)", "within", ["object", "container"]),
        ("lying(o, shelf)", "lying", ["object", "surface"]),
        ("set_table(cup, plate, fork)", "set_table", ["cup", "plate", "stick"]),
        ("pack(box: container, a, b, c)", "pack", ["container", "object", "object", "object"]),
    ],
)
def test_what_is_understood(text: str, name: str, kinds: list[str]) -> None:
    relation = parse_relation(text)
    assert relation.name == name
    assert [one.kind for one in relation.arguments] == kinds


@pytest.mark.parametrize("text", PRESETS)
def test_presets_are_relations_with_a_meaning(text: str) -> None:
    assert parse_relation(text).meaning == PRESETS[text]


names = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True).filter(lambda name: name not in TAKEN)


@given(names, st.lists(names, min_size=1, max_size=4, unique=True), st.data())
def test_what_is_written_is_read_again(
    name: str, arguments: list[str], data: st.DataObject
) -> None:
    kinds = [data.draw(st.sampled_from(KINDS[:-1])) for _ in arguments]
    relation = DemonstratedRelation(name, tuple(map(Argument, arguments, kinds)))
    assert parse_relation(str(relation)) == relation


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no relation with its arguments"),
        ("stack", "no relation with its arguments"),
        ("stack(a, b", "no relation with its arguments"),
        ("stack()", "has 0 arguments"),
        ("stack(a, b, c, d, e)", "has 5 arguments"),
        ("stack(a, a)", "argument of 'stack' twice"),
        ("stack(a, b c)", "'b c' cannot be the name of an argument"),
        ("2(a)", "'2' cannot be the name of a relation"),
        ("not(a)", "the name 'not' is taken"),
        ("in(a, b: contaner)", "unknown kind 'contaner'"),
        ("onto(s: surface, a)", "first argument of 'onto' is a surface"),
        ("onto(a, s: surface, t: surface)", "two surfaces"),
        ("x" * 41 + "(a)", "cannot be the name of a relation"),
    ],
)
def test_what_is_refused(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        parse_relation(text)
