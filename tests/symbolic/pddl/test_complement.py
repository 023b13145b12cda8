"""Complements: what has to be false is written as another predicate that holds, and means the same."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest

from tamp.symbolic.pddl.complement import (
    atoms_of_conditions,
    complement_name,
    negated_tests,
    with_complements,
)
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.structs import And, Atom, Domain, Fact, Forall, Formula, Not, Parameter
from tamp.verification.semantics import Semantics, State

DOMAIN = parse_domain("""(define (domain d) (:requirements :adl)
  (:types body - object)
  (:predicates (free ?a - body) (wet ?a - body) (done) (blocked ?a - body) (stuck ?a - body))
  (:derived (blocked ?a) (not (free ?a)))
  (:derived (stuck ?a) (and (blocked ?a) (wet ?a)))
  (:action go :parameters (?a - body) :precondition (and (wet ?a) (not (stuck ?a))) :effect (done))
  (:action see :parameters (?a - body) :precondition (stuck ?a) :effect (wet ?a))
  (:action test :parameters () :effect (forall (?a - body) (when (free ?a) (not (wet ?a))))))""")
GOAL = And((Atom("done", ()), Not(Atom("free", ("cup",)))))
OBJECTS = {"cup": ("body",), "box": ("body",)}


def signs(formula: Formula, domain: Domain) -> set[tuple[str, bool]]:
    return {(atom.predicate, sign) for atom, sign in atoms_of_conditions(domain, formula)}


def test_atoms_are_told_with_whether_they_help_by_holding() -> None:
    found = signs(GOAL, DOMAIN)
    assert {("done", True), ("free", False), ("stuck", False), ("stuck", True)} <= found
    assert ("blocked", True) in found and ("blocked", False) in found  # through the rule of `stuck`
    assert ("free", True) in found  # not stuck, so not blocked, so free; and the effect's condition


def test_a_complement_has_a_name_of_its_own() -> None:
    assert complement_name("free", DOMAIN) == "not-free"
    taken = parse_domain("(define (domain d) (:predicates (free) (not-free) (not-free~)))")
    assert complement_name("free", taken) == "not-free~~"


def test_nothing_is_rewritten_where_nothing_is_decided() -> None:
    assert with_complements(DOMAIN, GOAL, ()) == (DOMAIN, GOAL)
    assert with_complements(DOMAIN, GOAL, ("unheard-of",)) == (DOMAIN, GOAL)


def test_decided_predicates_are_needed_to_hold_only() -> None:
    domain, goal = with_complements(DOMAIN, GOAL, ("free",))
    assert to_text(goal) == "(and (done) (not-free cup))"
    # Effects' conditions are read both ways: what they ask is known before, see below.
    plain = replace(domain, actions=tuple(replace(one, effects=()) for one in domain.actions))
    found = signs(goal, plain)
    assert ("not-free", True) in found
    for predicate in ("free", "not-free"):
        assert (predicate, False) not in found, predicate
    assert domain.predicates["not-free"].parameters == DOMAIN.predicates["free"].parameters


def test_a_rule_needed_both_ways_has_a_copy_for_the_negation() -> None:
    domain, _ = with_complements(DOMAIN, GOAL, ("free",))
    heads = [rule.head.predicate for rule in domain.derived]
    assert sorted(heads) == ["blocked", "not-blocked", "not-stuck", "stuck"]


def test_an_effects_condition_has_to_be_known_before() -> None:
    domain, _ = with_complements(DOMAIN, GOAL, ("free",))
    (action,) = (one for one in domain.actions if one.name == "test")
    (known,) = [part for part in [action.precondition, *getattr(action.precondition, "parts", ())]
                if isinstance(part, Forall)]  # fmt: skip
    assert to_text(known.body) == "(or (free ?a) (not-free ?a))"


@pytest.mark.parametrize("free", [(), ("cup",), ("box",), ("cup", "box")])
@pytest.mark.parametrize("wet", [(), ("cup",), ("cup", "box")])
def test_with_the_complement_told_truly_all_conditions_mean_what_they_did(
    free: tuple[str, ...], wet: tuple[str, ...]
) -> None:
    domain, goal = with_complements(DOMAIN, GOAL, ("free",))
    facts: set[Fact] = {("free", one) for one in free} | {("wet", one) for one in wet} | {("done",)}
    told = facts | {("not-free", one) for one in OBJECTS if one not in free}
    before, after = Semantics(DOMAIN, OBJECTS), Semantics(domain, OBJECTS)

    assert before.holds(GOAL, State.of(facts)) == after.holds(goal, State.of(told))
    for name, action in before.actions.items():
        other = after.actions[name]
        for arguments in itertools.product(OBJECTS, repeat=len(action.parameters)):
            binding = {
                parameter.name: one
                for parameter, one in zip(action.parameters, arguments, strict=True)
            }
            old = before.holds(action.precondition, State.of(facts), binding)
            new = after.holds(other.precondition, State.of(told), binding)
            assert old == new, (name, arguments)
            if old:
                one = before.apply(action, arguments, State.of(facts))
                two = after.apply(other, arguments, State.of(told))
                assert one.all("wet") == two.all("wet")


STREAMS = """(define (stream s)
  (:stream test-free :inputs (?a) :domain (body ?a) :certified (free ?a))
  (:stream test-wet :inputs (?a) :domain (body ?a) :certified (and (wet ?a) (damp ?a)))
  (:stream sample :inputs (?a) :domain (body ?a) :outputs (?b) :certified (near ?a ?b)))"""


@pytest.mark.parametrize(
    ("goal", "tests"),
    [
        (Not(Atom("free", ("cup",))), ["free"]),
        (Atom("free", ("cup",)), []),
        (Not(Atom("wet", ("cup",))), []),  # its test certifies two at once
        (Not(Atom("near", ("cup", "box"))), []),  # no test: it has an output
        (Forall((Parameter("?a", ("body",)),), Not(Atom("free", ("?a",)))), ["free"]),
    ],
)
def test_only_what_one_test_alone_decides_can_fail(goal: Formula, tests: list[str]) -> None:
    domain = parse_domain("""(define (domain d) (:types body)
      (:predicates (free ?a - body) (wet ?a - body) (damp ?a - body) (near ?a ?b - body)))""")
    streams = parse_streams(STREAMS, domain)
    assert list(negated_tests(streams.streams, domain, goal)) == tests
