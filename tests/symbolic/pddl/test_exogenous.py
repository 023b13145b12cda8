"""Streams that wait for actions are asked at once; what they gave counts once their domain has been true."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.exogenous import compile_away, renamed
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Domain,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
)
from tamp.verification.semantics import Semantics, State

DOMAIN = parse_domain("""(define (domain safes)
  (:predicates (safe ?s) (lit ?s) (opens ?c ?s) (open ?s))
  (:action light :parameters (?s) :precondition (safe ?s) :effect (lit ?s))
  (:action dim :parameters (?s) :precondition (lit ?s) :effect (not (lit ?s)))
  (:action open :parameters (?s ?c) :precondition (opens ?c ?s) :effect (open ?s)))""")
STREAMS = parse_streams(
    """(define (stream safes)
  (:stream read :inputs (?s) :domain (and (safe ?s) (lit ?s)) :outputs (?c) :certified (opens ?c ?s)))""",
    DOMAIN,
    waiting=True,
)
GOAL = Atom("open", ("box",))


def test_a_task_whose_streams_wait_for_nothing_stays_as_it_is() -> None:
    plain = parse_streams(
        """(define (stream s)
      (:stream read :inputs (?s) :domain (safe ?s) :outputs (?c) :certified (opens ?c ?s)))""",
        DOMAIN,
    )
    made = compile_away(DOMAIN, plain, GOAL, frozenset({("safe", "box")}))
    assert (made.domain, made.streams, made.goal) == (DOMAIN, plain, GOAL)


def test_a_waiting_stream_is_asked_at_once_and_says_what_it_gave() -> None:
    made = compile_away(DOMAIN, STREAMS, GOAL, frozenset({("safe", "box")}))
    (stream,) = made.streams.streams
    assert [to_text(atom) for atom in stream.domain] == ["(safe ?s)"]  # of what never changes
    assert [to_text(atom) for atom in stream.certified] == ["(opens ?c ?s)", "(read-result ?s ?c)"]


def usable(domain: Domain, facts: set[Fact], code: str = "code") -> bool:
    """Whether the box can be opened with a code."""
    semantics = Semantics(domain, {"box": ("object",), code: ("object",)})
    action = semantics.actions["open"]
    return not semantics.unmet(action, ("box", code), State.of(facts))


def facts_of(state: State) -> set[Fact]:
    return {(name, *row) for name, rows in state.facts.items() for row in rows}


def test_what_it_gave_counts_once_its_domain_has_been_true() -> None:
    made = compile_away(DOMAIN, STREAMS, GOAL, frozenset({("safe", "box")}))
    semantics = Semantics(made.domain, {"box": ("object",), "code": ("object",)})
    state = State.of({("safe", "box"), ("read-result", "box", "code"), ("opens", "code", "box")})
    assert not usable(made.domain, facts_of(state))
    state = semantics.apply(semantics.actions["light"], ("box",), state)
    assert usable(made.domain, facts_of(state))
    state = semantics.apply(semantics.actions["dim"], ("box",), state)
    assert ("lit", "box") not in state and usable(
        made.domain, facts_of(state)
    )  # it was lit, that is enough


def test_what_is_true_or_given_at_first_needs_no_action() -> None:
    lit = compile_away(DOMAIN, STREAMS, GOAL, frozenset({("safe", "box"), ("lit", "box")}))
    assert usable(lit.domain, {*lit.facts, ("read-result", "box", "code")})
    known = compile_away(
        DOMAIN, STREAMS, GOAL, frozenset({("safe", "box"), ("opens", "code", "box")})
    )
    assert usable(known.domain, set(known.facts))


def test_what_waits_cannot_have_to_be_false() -> None:
    with pytest.raises(
        InputError,
        match=r"'opens' has to be false here, and its stream waits for what actions change",
    ):
        compile_away(DOMAIN, STREAMS, Not(Atom("opens", ("code", "box"))), frozenset())


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        (Atom("a", ("?x",)), "(b ?x)"),
        (Not(Atom("a", ())), "(not (b))"),
        (And((Atom("a", ()), Or((Atom("c", ()), Atom("a", ()))))), "(and (b) (or (c) (b)))"),
        (Exists((Parameter("?x"),), Atom("a", ("?x",))), "(exists (?x) (b ?x))"),
        (
            Forall((Parameter("?x"),), Not(Atom("a", ("?x",)))),
            "(forall (?x) (not (b ?x)))",
        ),
    ],
)
def test_predicates_are_renamed_wherever_they_stand(formula: Formula, text: str) -> None:
    assert to_text(renamed(formula, {"a": "b"})) == text
    assert renamed(formula, {}) == formula
