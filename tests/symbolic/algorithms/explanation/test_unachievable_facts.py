"""What nothing makes true is told by the precondition at which the nearest way to it ends."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.explanation.unachievable_facts import UnachievableFacts
from tamp.symbolic.algorithms.result import StreamTask
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain kitchen)
  (:requirements :typing :derived-predicates)
  (:types food stove pose)
  (:predicates (raw ?f - food) (hot ?s - stove) (lit ?s - stove) (gas ?s - stove) (cooked ?f - food) (eaten ?f - food)
               (pose ?f - food ?p - pose) (near ?f - food ?p - pose) (kept ?f - food))
  (:derived (hot ?s - stove) (and (lit ?s) (gas ?s)))
  (:action cook :parameters (?f - food ?s - stove) :precondition (and (raw ?f) (hot ?s)) :effect (cooked ?f))
  (:action eat :parameters (?f - food) :precondition (cooked ?f) :effect (eaten ?f))
  (:action light :parameters (?s - stove) :precondition (gas ?s) :effect (lit ?s))
  (:action keep :parameters (?f - food ?p - pose) :precondition (near ?f ?p) :effect (kept ?f)))
"""

STREAMS = """
(define (stream kitchen)
  (:stream sample-pose :inputs (?f) :domain (raw ?f) :outputs (?p) :certified (pose ?f ?p))
  (:stream test-near :inputs (?f ?p) :domain (pose ?f ?p) :certified (near ?f ?p)))
"""

OBJECTS = {"egg": ("food",), "ring": ("stove",)}


def missing(*facts: tuple[str, ...], assumed: tuple[str, ...] = ()) -> UnachievableFacts:
    functions = {
        "sample-pose": lambda food, call: iter(()),
        "test-near": lambda food, pose, call: False,
    }
    problem: StreamTask = stream_task(DOMAIN, STREAMS, functions, OBJECTS, "", "(eaten egg)")
    return UnachievableFacts(problem.task, problem.streams, facts, OBJECTS, assumed)


RAW = ("raw", "egg")


@pytest.mark.parametrize(
    ("facts", "reason"),
    [
        (
            (RAW,),
            "eat needs (cooked egg), and cook needs (hot some s), and being hot needs (lit some s) and (gas some s), "
            "and light needs (gas some s), which nothing makes true",
        ),
        (
            (RAW, ("lit", "ring")),
            "eat needs (cooked egg), and cook needs (hot some s), and being hot needs (gas ring), "
            "which nothing makes true",
        ),
        (
            (("hot", "ring"),),
            "eat needs (cooked egg), and cook needs (raw egg), which nothing makes true",
        ),
    ],
)
def test_the_chain_ends_at_what_nothing_makes_true(
    facts: tuple[tuple[str, ...], ...], reason: str
) -> None:
    said, terms = missing(*facts).reason(("eaten", "egg"))
    assert said == reason
    named = [word for word in reason.replace(")", " ").split() if word in ("egg", "ring")]
    assert [term for term in terms if term[:1] != "?"] == named


def test_what_no_action_makes_true() -> None:
    assert missing(RAW).reason(("raw", "ring")) == ("no action makes it true", ())
    assert missing().reason(("gas", "ring")) == ("no action makes it true", ())


def test_streams_are_ways_too() -> None:
    said, _ = missing().reason(("kept", "egg"))
    assert said.startswith(
        "keep needs (near egg some p), and test-near needs (pose egg some p), and sample-pose needs "
    )
    assert said.endswith("(raw egg), which nothing makes true")


def test_what_is_taken_to_hold_is_not_missed() -> None:
    assert "near" not in missing(RAW, assumed=("near",)).reason(("kept", "egg"))[0]
