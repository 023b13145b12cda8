"""The frame of every PDDL file, and keyword and value pairs inside."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.nodes import Symbol
from tamp.symbolic.pddl.sections import items_of, keyword_values, read_sections, single
from tamp.symbolic.pddl.sexpr import read

KNOWN = (":types", ":predicates", ":action")


def read_domain(text: str) -> tuple[str, list[tuple[str, int]]]:
    name, found = read_sections(text, "domain", KNOWN, "d.pddl")
    return name.text, [(section.keyword.text, len(section.items)) for section in found]


def test_a_file_has_a_name_and_sections_in_their_order() -> None:
    text = "(define (domain Cupboard) (:types a b) (:action pick) (:Types) (:action place x y))"
    assert read_domain(text) == (
        "cupboard",
        [(":types", 2), (":action", 1), (":types", 0), (":action", 3)],
    )
    assert read_domain("(define (domain d))") == ("d", [])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", r"empty: expected \(define \(domain NAME\) ...\)"),
        ("domain", r"expected \(define \(domain NAME\) ...\), found 'domain'"),
        ("()", "expected .define"),
        ("(defin (domain d))", r"expected \(define \(domain NAME\) ...\), found '\(defin ...\)'"),
        ("(define)", "found nothing after 'define'"),
        ("(define d)", r"expected \(domain NAME\), found 'd'"),
        ("(define (problem d))", r"expected \(domain NAME\), found '\(problem ...\)'"),
        ("(define (domain))", "with one name, found 0 names"),
        ("(define (domain a b))", "with one name, found 2 names"),
        ("(define (domain ?d))", "expected a name, found '.d'"),
        (
            "(define (domain d) types)",
            r"expected a section of the domain such as \(:types ...\), found 'types'",
        ),
        ("(define (domain d) ())", r"expected a section of the domain, found '\(\)'"),
        (
            "(define (domain d) ((:types)))",
            "expected a section's keyword, one of :types, :predicates, :action",
        ),
        (
            "(define (domain d) (:typs a))",
            "unknown section ':typs' of the domain.*Did you mean ':types'",
        ),
        (
            "(define (domain d) (:durative-action a))",
            "':durative-action' is not supported: tamp has no durative",
        ),
        ("(define (domain d)) more", "expected the end of the text after"),
    ],
)
def test_what_is_no_such_file_is_said_with_its_place(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as told:
        read_domain(text)
    assert str(told.value).startswith("d.pddl:1:")


def test_a_section_that_may_stand_once() -> None:
    _, found = read_sections(
        "(define (domain d)\n(:types a)\n(:action x)\n(:types b))", "domain", KNOWN, None
    )
    assert single(found, ":predicates") is None and items_of(found, ":predicates") == ()
    action = single(found, ":action")
    assert action is not None and action.keyword.place.line == 3
    with pytest.raises(InputError, match="section ':types' stands twice; first in line 2") as told:
        single(found, ":types")
    assert told.value.line == 4


def values(text: str) -> dict[str, str]:
    found = keyword_values(read(text), "action 'pick'", (":parameters", ":effect"))
    return {
        key: node.text if isinstance(node, Symbol) else node.head or "()"
        for key, node in found.items()
    }


def test_keywords_have_one_value_each_in_any_order() -> None:
    assert values(":effect (on a) :Parameters ()") == {":effect": "on", ":parameters": "()"}
    assert values("") == {}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (":effect", "':effect' of action 'pick' has no value"),
        (":effect :parameters ()", "':effect' of action 'pick' has no value"),
        (":efect (on)", "unknown keyword ':efect' of action 'pick'.*Did you mean ':effect'"),
        (":effect (on) :effect (off)", "keyword ':effect' of action 'pick' stands twice"),
        ("(on)", "expected a keyword of action 'pick': :parameters, :effect, found"),
        (":duration 3", "':duration' is not supported: tamp has no durative actions"),
    ],
)
def test_wrong_pairs(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        values(text)
