"""Streams that certify what actions change: what they find holds at the start, until an action ends it."""

from __future__ import annotations

import itertools

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.started import without_started
from tamp.symbolic.pddl.structs import Atom, Formula, Not
from tamp.verification.semantics import Semantics, State

CHANGED = parse_domain("""(define (domain d) (:predicates (thing ?x) (clean ?x) (shown ?x))
  (:action wash :parameters (?x) :precondition (thing ?x) :effect (clean ?x))
  (:action soil :parameters (?x) :precondition (thing ?x) :effect (not (clean ?x)))
  (:action show :parameters (?x) :precondition (clean ?x) :effect (shown ?x)))""")
SEEN = """(define (stream d) (:stream see :inputs (?x) :domain (thing ?x) :certified (clean ?x)))"""


@pytest.mark.parametrize("order", list(itertools.product(["wash", "soil"], repeat=2)))
@pytest.mark.parametrize("found", [True, False])
def test_what_a_stream_finds_holds_until_an_action_ends_it(
    found: bool, order: tuple[str, ...]
) -> None:
    made = without_started(
        CHANGED, parse_streams(SEEN, CHANGED, waiting=True), Atom("shown", ("cup",))
    )
    objects = {"cup": ("object",)}
    before, after = Semantics(CHANGED, objects), Semantics(made.domain, objects)
    (start,) = made.names
    plain = State.of({("thing", "cup"), *([("clean", "cup")] if found else [])})
    rewritten = State.of({("thing", "cup"), *([(start, "cup")] if found else [])})
    for name in order:
        plain = before.apply(before.actions[name], ("cup",), plain)
        rewritten = after.apply(after.actions[name], ("cup",), rewritten)
        ready = not before.unmet(before.actions["show"], ("cup",), plain)
        assert ready == (not after.unmet(after.actions["show"], ("cup",), rewritten))


def test_its_stream_certifies_what_never_changes() -> None:
    made = without_started(
        CHANGED, parse_streams(SEEN, CHANGED, waiting=True), Atom("shown", ("cup",))
    )
    (atom,) = made.streams.streams[0].certified
    assert atom.predicate not in made.domain.fluent_predicates and made.names == {
        atom.predicate: "clean"
    }


def test_a_task_whose_streams_certify_nothing_that_changes_stays_as_it_is() -> None:
    text = "(define (stream d) (:stream find :inputs () :outputs (?x) :certified (thing ?x)))"
    plain, goal = parse_streams(text, CHANGED), Atom("clean", ("cup",))
    made = without_started(CHANGED, plain, goal)
    assert made.domain is CHANGED and made.streams is plain and made.goal is goal
    assert made.names == {}


def test_a_name_that_the_domain_has_is_not_taken_again() -> None:
    taken = parse_domain("""(define (domain d) (:predicates (thing ?x) (clean ?x) (clean-start ?x))
      (:action wash :parameters (?x) :precondition (thing ?x) :effect (clean ?x)))""")
    made = without_started(taken, parse_streams(SEEN, taken, waiting=True), Atom("clean", ("cup",)))
    assert made.names == {"clean-start~": "clean"}
    assert made.goal == Atom("clean-now", ("cup",))


@pytest.mark.parametrize(
    ("streams", "goal", "words"),
    [
        (SEEN, Not(Atom("clean", ("cup",))), "'clean' has to be false here, and a test that may still pass"),
        (SEEN[:-1] + "(:stream wait :inputs (?x) :domain (clean ?x) :outputs (?y) :certified (thing ?y)))",
         Atom("shown", ("cup",)), "stream 'wait' waits for 'clean', which another stream certifies"),
        (SEEN[:-1] + "(:stream look :inputs (?x) :domain (thing ?x) :fluents (clean) :outputs (?y)"
         " :certified (thing ?y)))", Atom("shown", ("cup",)), "stream 'look' is shown 'clean' through :fluents"),
    ],
)  # fmt: skip
def test_what_cannot_be_moved_is_refused(streams: str, goal: Formula, words: str) -> None:
    with pytest.raises(InputError, match=words):
        without_started(CHANGED, parse_streams(streams, CHANGED, waiting=True), goal)
