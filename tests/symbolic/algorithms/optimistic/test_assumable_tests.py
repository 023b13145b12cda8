"""Which tests are taken to hold wherever they are asked for: those that can only lift a guard."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.optimistic.assumable_tests import assumable, atoms_of
from tamp.symbolic.algorithms.result import StreamTask
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain places)
  (:requirements :typing :negative-preconditions :derived-predicates :conditional-effects)
  (:types thing pose)
  (:predicates (pose ?o - thing ?p - pose) (at ?o - thing ?p - pose) (free ?o - thing ?p - pose ?q - pose) (done)
    (blocked ?o - thing ?p - pose) (given ?o - thing) EXTRA)
  (:derived (blocked ?o - thing ?p - pose)
    (exists (?o2 - thing ?q - pose) (and (at ?o2 ?q) (not (free ?o ?p ?q)))))
  (:action put :parameters (?o - thing ?p - pose)
    :precondition (and (pose ?o ?p) (not (blocked ?o ?p)) CONDITION)
    :effect (and (at ?o ?p) (when EFFECT (done)))))
"""
STREAMS = """
(define (stream places)
  (:stream draw :inputs (?o) :domain (thing ?o) :outputs (?p) :certified (pose ?o ?p))
  (:stream test :inputs (?o ?p ?q) :domain (and (pose ?o ?p) (pose ?o ?q)) :certified (free ?o ?p ?q))
  MORE)
"""


def task(
    condition: str = "(thing ?o)",
    effect: str = "(thing ?o)",
    more: str = "",
    streams: str = STREAMS,
) -> StreamTask:
    domain = DOMAIN.replace("CONDITION", condition).replace("EFFECT", effect).replace("EXTRA", "")
    functions = dict.fromkeys(("draw", "test", "other", "next"), lambda *values, call: iter(()))
    return stream_task(
        domain, streams.replace("MORE", more), functions, {"cup": ("thing",)}, "", "(done)"
    )


def names(problem: StreamTask) -> dict[str, str]:
    return {
        key: stream.name for key, (stream, _) in assumable(problem.streams, problem.task).items()
    }


def test_a_test_that_only_lifts_a_guard_is_assumable() -> None:
    problem = task()
    assert names(problem) == {"free": "test"}
    _, atom = assumable(problem.streams, problem.task)["free"]
    assert atom.terms == ("?o", "?p", "?q")


@pytest.mark.parametrize(
    "condition", ["(free ?o ?p ?p)", "(not (free ?o ?p ?p))", "(or (free ?o ?p ?p) (done))"]
)
def test_a_test_that_an_action_asks_for_is_not(condition: str) -> None:
    """In an action's condition even a negation counts as help: only rules become guards."""
    assert names(task(condition=condition)) == {}
    assert names(task(effect=condition)) == {}


@pytest.mark.parametrize(
    "more",
    [
        "(:stream other :inputs (?o ?p ?q) :domain (and (pose ?o ?p) (pose ?o ?q)) :certified (free ?o ?p ?q))",
        "(:stream next :inputs (?o ?p) :domain (free ?o ?p ?p) :outputs (?q) :certified (pose ?o ?q))",
    ],
)
def test_a_test_whose_fact_another_stream_certifies_or_needs_is_not(more: str) -> None:
    assert names(task(more=more)) == {}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (":certified (free ?o ?p ?q))", ":certified (and (free ?o ?p ?q) (pose ?o ?q)))"),
        (":certified (free ?o ?p ?q))", ":certified (free ?o ?p ?p))"),
        (
            ":certified (free ?o ?p ?q))",
            ":outputs (?r) :certified (and (pose ?o ?r) (free ?o ?p ?q)))",
        ),
        (
            "(and (pose ?o ?p) (pose ?o ?q)) :certified (free",
            "(and (given ?o) (pose ?o ?p) (pose ?o ?q)) :certified (free",
        ),
    ],
)
def test_it_certifies_one_fact_of_all_its_inputs_and_is_asked_of_what_streams_give(
    old: str, new: str
) -> None:
    assert STREAMS.count(old) == 1
    assert names(task(streams=STREAMS.replace(old, new))) == {}


def test_atoms_of_a_task_have_the_signs_of_guards() -> None:
    found = list(atoms_of(task(condition="(not (given ?o))").task))
    signs = {atom.predicate: sign for atom, sign in found}
    assert signs == {
        "done": True, "pose": True, "blocked": True, "given": True, "thing": True, "at": True, "free": False
    }  # fmt: skip
    assert found[0][0].predicate == "done"
