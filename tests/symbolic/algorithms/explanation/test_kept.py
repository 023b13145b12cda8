"""What stays as it is and forbids an action: said as the state that the action wants not to hold, and why."""

from __future__ import annotations

from collections.abc import Sequence

from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.explanation.kept import kept_from
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain yard)
  (:requirements :adl :derived-predicates :typing)
  (:types thing)
  (:predicates (upon ?a ?b - thing) (loaded ?b - thing) (moved ?b - thing) (wet ?b - thing)
    (free ?a - thing) (heavy ?a - thing) (stuck ?b - thing))
  (:action move :parameters (?b - thing) :precondition (and {wants}) :effect (moved ?b))
  (:action rinse :parameters (?b - thing) :precondition (free ?b) :effect (wet ?b))
  (:action unload :parameters (?a ?b - thing) :precondition (and (upon ?a ?b) (free ?a))
    :effect (not (upon ?a ?b)))
  (:derived (loaded ?b - thing) (exists (?a - thing) (and (upon ?a ?b) (heavy ?a))))
  (:derived (stuck ?b - thing) (wet ?b)))
"""
THINGS = dict.fromkeys(("can", "crate", "leaf"), ("thing",))
NO_VALUE = Cause("no grasp of crate", CauseKind.NO_VALUE, ("crate",))


def kept(
    wants: str,
    init: str,
    calls: Sequence[tuple[frozenset[str], Cause]] = (),
    goal: Sequence[str] = ("can",),
) -> list[Cause]:
    problem = stream_task(
        DOMAIN.format(wants=wants), "(define (stream none))", {}, THINGS, init, "(moved can)"
    )
    task = problem.task
    return list(kept_from(problem, instantiate(task, (), {}), calls, goal))


def test_the_state_is_named_with_whom_it_concerns() -> None:
    (cause,) = kept("(not (loaded ?b))", "(upon crate can) (heavy crate)")
    assert cause.text == "can stays loaded with crate, so that move is never possible"
    assert cause.kind is CauseKind.FORBIDDEN and set(cause.objects) == {"can", "crate"}


def test_why_the_other_thing_cannot_be_moved_is_added() -> None:
    calls = [(frozenset({"crate"}), NO_VALUE), (frozenset({"leaf"}), NO_VALUE)]
    (cause,) = kept("(not (loaded ?b))", "(upon crate can) (heavy crate)", calls)
    assert cause.text.endswith("so that move is never possible (no grasp of crate)")


def test_a_fact_that_the_action_itself_forbids_is_said_plainly() -> None:
    (cause,) = kept("(not (upon ?b ?b))", "(upon can can)")
    assert cause.text == "move wants (upon can can) not to hold, which nothing makes false"


def test_what_a_rule_does_not_lead_to_is_not_named_as_the_state() -> None:
    """The leaf is light: it does not load the can, and forbids nothing."""
    assert kept("(not (loaded ?b))", "(upon leaf can)") == []


def test_what_may_change_is_told_only_with_a_reason_why_it_does_not() -> None:
    """The crate is free, so it might be taken off; a call about it failed."""
    init = "(upon crate can) (heavy crate) (free crate)"
    assert kept("(not (loaded ?b))", init) == []
    (cause,) = kept("(not (loaded ?b))", init, [(frozenset({"crate"}), NO_VALUE)])
    assert cause.text == "can is loaded with crate (no grasp of crate)"
    assert kept("(not (loaded ?b))", init, [(frozenset({"leaf"}), NO_VALUE)]) == []


def test_actions_that_are_not_about_the_goal_are_left_out() -> None:
    init = "(upon crate can) (heavy crate)"
    assert kept("(not (loaded ?b))", init, goal=("leaf",)) == []


def test_at_most_two_reasons_are_named() -> None:
    calls = [
        (frozenset({"crate"}), Cause(f"no grasp {i}", CauseKind.NO_VALUE, ())) for i in range(4)
    ]
    (cause,) = kept("(not (loaded ?b))", "(upon crate can) (heavy crate)", calls)
    assert cause.text.endswith("(no grasp 0, no grasp 1)")
