"""Explanations name what excludes what, what a fact lacks, which action failed how often, and what is proven."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import pytest

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.bound_stream import Objects, Streams
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount, blocking_objects
from tamp.symbolic.algorithms.explanation.explanation import explain_failures
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.deadline import Deadline
from tests.symbolic.algorithms.toys import ALGORITHMS, solve, stream_task

KITCHEN = """
(define (domain kitchen)
  (:requirements :typing)
  (:types food stove)
  (:predicates (fresh ?f - food) (gas) (hot ?s - stove) (broken ?s - stove) (cooked ?f - food) (raw ?f - food))
  (:action light :parameters (?s - stove) :precondition (and (gas) (not (hot ?s))) :effect (hot ?s))
  (:action cook :parameters (?f - food ?s - stove) :precondition (and (hot ?s) (fresh ?f) (raw ?f))
    :effect (and (cooked ?f) (not (raw ?f)))))
"""
THINGS = {"egg": ("food",), "ham": ("food",), "big": ("stove",), "small": ("stove",)}
NO_STREAMS = "(define (stream none))"


def causes(init: str, goal: str, algorithm: str = "adaptive") -> tuple[Cause, ...]:
    result = solve(algorithm, stream_task(KITCHEN, NO_STREAMS, {}, THINGS, init, goal))
    assert result.outcome is Outcome.INFEASIBLE
    assert result.explanation == tuple(cause.text for cause in result.causes)
    return result.causes


def explained(init: str, goal: str, algorithm: str = "adaptive") -> str:
    return "\n".join(cause.text for cause in causes(init, goal, algorithm))


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_the_missing_fact_is_named_through_a_chain_of_actions(algorithm: str) -> None:
    text = explained("(raw egg) (fresh egg)", "(cooked egg)", algorithm)
    assert (
        "cook needs (hot" in text and "light needs (gas)" in text and "nothing makes true" in text
    )


def test_only_what_is_missing_is_named() -> None:
    text = explained("(raw egg) (gas)", "(cooked egg)")
    assert "cook needs (fresh egg)" in text and "hot" not in text and "raw" not in text


def test_goals_that_exclude_each_other_are_named_and_no_others() -> None:
    text = explained(
        "(raw egg) (fresh egg) (raw ham) (fresh ham) (gas)",
        "(and (cooked egg) (raw egg) (cooked ham))",
    )
    assert "(cooked egg) and (raw egg) cannot both hold" in text
    assert "ham" not in text


def test_a_cause_lists_the_objects_of_the_goal_and_of_what_it_lacks() -> None:
    (cause,) = causes("(raw egg) (fresh egg)", "(cooked egg)")
    assert (cause.kind, cause.objects) == (CauseKind.UNREACHABLE, ("egg",))
    (cause,) = causes("(raw egg) (fresh egg)", "(hot small)")
    assert (cause.kind, cause.objects) == (CauseKind.UNREACHABLE, ("small",))


def test_goals_that_exclude_each_other_are_a_cause_with_the_objects_of_both() -> None:
    init = "(raw egg) (fresh egg) (raw ham) (fresh ham) (gas)"
    (cause,) = causes(init, "(and (cooked egg) (raw egg) (cooked ham))")
    assert (cause.kind, cause.objects) == (CauseKind.EXCLUSIVE, ("egg",))


def test_a_subformula_of_the_goal_lends_its_objects() -> None:
    (cause,) = causes("(raw egg) (fresh egg)", "(or (cooked egg) (broken big))")
    assert cause.kind is CauseKind.UNREACHABLE and set(cause.objects) >= {"egg", "big"}


GRASP = """
(define (domain grasp)
  (:requirements :typing)
  (:types thing grasp)
  (:predicates (grasp ?x - thing ?g - grasp) (held ?x - thing) (free))
  (:action pick :parameters (?x - thing ?g - grasp) :precondition (and (grasp ?x ?g) (free))
    :effect (and (held ?x) (not (free)))))
"""
GRASPS = """
(define (stream grasp)
  (:stream sample-grasp :inputs (?x) :domain (thing ?x) :outputs (?g) :certified (grasp ?x ?g)))
"""


@pytest.mark.parametrize("given_up", [True, False])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_stream_that_was_given_up_proves_nothing(algorithm: str, given_up: bool) -> None:
    def sample_grasp(thing: str, call: Call) -> Iterator[Rejection]:
        yield Rejection.hits("wall")
        yield replace(Rejection.hits("wall"), given_up=given_up)

    functions = {"sample-grasp": sample_grasp}
    objects = {"mug": ("thing",), "wall": ("thing",)}
    problem = stream_task(GRASP, GRASPS, functions, objects, "(free)", "(held mug)")
    result = solve(algorithm, problem)
    assert result.outcome is (Outcome.EXHAUSTED if given_up else Outcome.INFEASIBLE)
    assert "mug" in " ".join(result.explanation)
    assert {name for cause in result.causes for name in cause.objects} == {"mug", "wall"}
    assert {cause.kind for cause in result.causes} >= {CauseKind.NO_VALUE}
    if algorithm == "adaptive":
        (tally,) = result.tallies
        assert (tally.action, tally.stream, tally.always_failed) == (
            "pick mug",
            "sample-grasp",
            True,
        )
        assert tally.tries == tally.reasons["hits wall"] >= 2
        assert blocking_objects(result.tallies, problem.values) == (("wall", tally.tries),)


def test_the_call_that_raised_proves_nothing() -> None:
    def sample_grasp(thing: str, call: Call) -> Iterator[str]:
        raise ValueError("out of order")

    functions = {"sample-grasp": sample_grasp}
    problem = stream_task(GRASP, GRASPS, functions, {"mug": ("thing",)}, "(free)", "(held mug)")
    assert solve("adaptive", problem).outcome is Outcome.EXHAUSTED


def test_what_failed_once_is_not_blamed_before_what_failed_a_hundred_times() -> None:
    rows = [
        FailureCount("place cup", "test-pose-clear", 1, 0, Counter({"hits can": 1})),
        FailureCount("pick cup", "inverse-kinematics", 120, 2, Counter({"hits wall": 118})),
    ]
    problem = stream_task(KITCHEN, NO_STREAMS, {}, THINGS, "", "(cooked egg)")
    (first, *_) = explain_failures(
        problem, Streams({}, Objects({}, {}), lambda _: None, Deadline()), rows, True
    )
    assert first.text.startswith("pick cup: inverse-kinematics worked 2 times in 120 tries")
    rows[0] = FailureCount("place cup", "test-pose-clear", 30, 0, Counter({"hits can": 30}))
    (first, *_) = explain_failures(
        problem, Streams({}, Objects({}, {}), lambda _: None, Deadline()), rows, True
    )
    assert first.text == "place cup: test-pose-clear never worked in 30 tries: 30 hits can"
