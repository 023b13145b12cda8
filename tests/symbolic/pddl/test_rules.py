"""Rules of derived predicates in both spellings, with types from where they are said."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.rules import parse_rule, redefinition, rule_head
from tamp.symbolic.pddl.sections import Section, read_sections
from tamp.symbolic.pddl.structs import Derived

DOMAIN = parse_domain("""(define (domain d) (:requirements :typing) (:types cup plate - body body - object)
  (:predicates (on ?a - body ?b - plate) (clean ?a - body) (high ?a - body) (ready)))""")


def section(rule: str) -> Section:
    _, (found,) = read_sections(
        f"(define (domain d) {rule})", "domain", (":derived", ":axiom"), "d.pddl"
    )
    return found


def parsed(rule: str, notes: list[str] | None = None) -> Derived:
    return parse_rule(section(rule), DOMAIN, notes)


def checked(rule: str) -> None:
    """Look at a rule in the order in which a domain is read: the head of each first, then its body."""
    rule_head(section(rule), DOMAIN)
    parse_rule(section(rule), DOMAIN)


@pytest.mark.parametrize(
    ("rule", "head", "types", "body"),
    [
        ("(:derived (high ?x) (clean ?x))", "(high ?x)", [("body",)], "(clean ?x)"),
        ("(:derived (high ?x - cup) (clean ?x))", "(high ?x)", [("cup",)], "(clean ?x)"),
        ("(:derived (on ?x ?y) (and))", "(on ?x ?y)", [("body",), ("plate",)], "(and)"),
        (
            "(:derived (ready) (exists (?x - cup) (clean ?x)))",
            "(ready)",
            [],
            "(exists (?x - cup) (clean ?x))",
        ),
        ("(:axiom (high ?x) (clean ?x))", "(high ?x)", [("body",)], "(clean ?x)"),
        (
            "(:axiom :parameters (?x - cup) :context (clean ?x) :implies (high ?x))",
            "(high ?x)",
            [("cup",)],
            "(clean ?x)",
        ),
        ("(:axiom :context (clean ?x) :implies (high ?x))", "(high ?x)", [("body",)], "(clean ?x)"),
    ],
)
def test_rules_in_any_spelling(rule: str, head: str, types: list, body: str) -> None:
    found = parsed(rule)
    assert (to_text(found.head), to_text(found.body)) == (head, body)
    assert [parameter.types for parameter in found.parameters] == types
    assert rule_head(section(rule), DOMAIN) == found.head.predicate
    assert found.place is not None and found.place.column == 20


def test_a_variable_twice_in_the_head_is_one() -> None:
    found = parsed("(:derived (on ?x ?x) (clean ?x))")
    first, second = found.head.terms
    assert (
        first != second
        and "(=" in to_text(found.body)
        and first in to_text(found.body)
        and second in to_text(found.body)
    )


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        ("(:derived (high ?x))", "':derived' takes a fact and a condition, found 1 part$"),
        ("(:derived (high ?x) (ready) (ready))", "found 3 parts"),
        ("(:derived () (ready))", r"expected a fact such as \(on \?a \?b\), found '\(\)'"),
        ("(:derived high (ready))", "expected a fact such as .*, found 'high'"),
        (
            "(:derived (and (high ?x)) (ready))",
            r"a rule defines one predicate, found '\(and ...\)'",
        ),
        ("(:derived (hihg ?x) (ready))", "unknown predicate 'hihg'.*Did you mean 'high'"),
        (
            "(:derived (high ?x ?y) (ready))",
            r"'high' takes 1 argument, found 2. Its form is \(high \?a\)",
        ),
        ("(:derived (high x) (ready))", "expected a variable such as .x, found 'x'"),
        ("(:derived (high ?x) (clean ?y))", "unknown variable '.y'"),
        ("(:axiom :context (ready))", "the axiom has no :implies"),
        ("(:axiom :implies (ready))", "the axiom has no :context"),
        ("(:axiom :contxt (ready) :implies (ready))", "unknown keyword ':contxt' of the axiom"),
    ],
)
def test_what_is_no_rule_is_refused(rule: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        checked(rule)


def test_a_head_with_another_number_of_arguments_declares_anew_with_a_warning() -> None:
    (found,) = redefinition(section("(:derived (high ?x ?y) (ready))"), DOMAIN.predicates)
    name, (predicate, note) = found
    assert name == "high" and [one.name for one in predicate.parameters] == ["?x", "?y"]
    assert note.endswith("'high' is declared with 1, defined with 2 arguments") and note.startswith(
        "d.pddl:1:"
    )
    assert list(redefinition(section("(:derived (high ?x) (ready))"), DOMAIN.predicates)) == []
    assert list(redefinition(section("(:derived (new ?x) (ready))"), DOMAIN.predicates)) == []
