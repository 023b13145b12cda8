"""One fact that several calls can certify, and things of which it takes two values of one call."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.stream import Call
from tamp.symbolic.algorithms.result import Outcome
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task

DOOR = """
(define (domain door)
  (:requirements :typing :negative-preconditions)
  (:types thing place)
  (:predicates (place ?t - thing ?p - place) (ready ?t - thing) (open) (done ?t - thing))
  (:action open-up :parameters () :precondition (not (open)) :effect (open))
  (:action finish :parameters (?t - thing) :precondition (ready ?t) :effect (done ?t)))
"""

DOOR_STREAMS = """
(define (stream door)
  (:stream sample-place :inputs (?t) :domain (thing ?t) :outputs (?p) :certified (place ?t ?p))
  (:stream plan-ready :inputs (?t ?p) :domain (place ?t ?p) :fluents (open) :certified (ready ?t)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("good", [1, 2, 3])
@pytest.mark.parametrize("opened", [False, True])
def test_a_call_that_fails_in_a_state_speaks_for_itself_alone(
    algorithm: str, good: int, opened: bool
) -> None:
    """The thing is ready for one of its places, whichever that is, and where wanted with the door open alone."""

    def places(thing: str, call: Call) -> Iterator[int]:
        yield from (1, 2, 3)

    def ready(thing: str, place: int, call: Call) -> bool:
        return place == good and (("open",) in call.fluents) is opened

    functions = {"sample-place": places, "plan-ready": ready}
    problem = stream_task(DOOR, DOOR_STREAMS, functions, {"cup": ("thing",)}, "", "(done cup)")
    result = solve(algorithm, problem)
    assert result.outcome is Outcome.SOLVED, result.explanation
    assert [action.name for action in result.actions] == ["open-up"] * opened + ["finish"]
    assert result.effort.refuted == 0


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_where_all_calls_fail_in_all_states_there_is_no_plan(algorithm: str) -> None:
    def places(thing: str, call: Call) -> Iterator[int]:
        yield from (1, 2, 3)

    functions = {"sample-place": places, "plan-ready": lambda thing, place, call: False}
    problem = stream_task(DOOR, DOOR_STREAMS, functions, {"cup": ("thing",)}, "", "(done cup)")
    assert solve(algorithm, problem).outcome is Outcome.INFEASIBLE


PAIR = """
(define (domain pair)
  (:requirements :typing :negative-preconditions)
  (:types thing grip)
  (:predicates (grip ?t - thing ?g - grip) (turned ?t - thing) (used ?t - thing ?g - grip))
  (:action use
    :parameters (?t - thing ?g - grip)
    :precondition (and (grip ?t ?g) (not (used ?t ?g)))
    :effect (used ?t ?g))
  (:action turn :parameters (?t - thing ?g ?h - grip) :precondition {turn} :effect (turned ?t)))
"""

PAIR_STREAMS = """
(define (stream pair)
  (:stream sample-grip :inputs (?t) :domain (thing ?t) :outputs (?g) :certified (grip ?t ?g)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize(
    "turn",
    [
        "(and (grip ?t ?g) (grip ?t ?h) (not (= ?g ?h)))",
        "(and (grip ?t ?g) (grip ?t ?h) (used ?t ?g) (not (used ?t ?h)))",
    ],
)
def test_two_values_of_one_call(algorithm: str, count: int, turn: str) -> None:
    """A placeholder is one value: that it cannot differ from itself proves nothing."""

    def grips(thing: str, call: Call) -> Iterator[int]:
        yield from range(count)

    text = PAIR.replace("{turn}", turn)
    problem = stream_task(
        text, PAIR_STREAMS, {"sample-grip": grips}, {"cup": ("thing",)}, "", "(turned cup)"
    )
    result = solve(algorithm, problem)
    if count == 2:
        replay(problem, result)
    else:
        assert result.outcome in (Outcome.INFEASIBLE, Outcome.EXHAUSTED)


ANYTHING = """
(define (domain anything)
  (:requirements :adl :derived-predicates)
  (:types thing grip)
  (:predicates (grip ?t - thing ?g - grip) (good ?t - thing) (graspable ?t - thing ?g - grip)
               (fine ?t - thing) (dirty ?t - thing) (ready ?t - thing))
  (:derived (graspable ?t - thing ?g - grip) (good ?t))
  (:derived (fine ?t - thing) (exists (?g - grip) (and (graspable ?t ?g) (not (dirty ?t)))))
  (:action clean :parameters (?t - thing) :precondition (dirty ?t) :effect (not (dirty ?t)))
  (:action finish :parameters (?t - thing) :precondition (fine ?t) :effect (ready ?t)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("goal", ["(fine cup)", "(ready cup)", "(exists (?t - thing) (fine ?t))"])
def test_a_rule_asks_that_there_is_a_value_of_which_it_says_nothing(
    algorithm: str, goal: str
) -> None:
    """`graspable` is unfolded into `fine`, where only its type names the grip: the plan still has to draw one."""

    def grips(thing: str, call: Call) -> Iterator[int]:
        yield 1

    init = "(good cup) (dirty cup)"
    problem = stream_task(
        ANYTHING, PAIR_STREAMS, {"sample-grip": grips}, {"cup": ("thing",)}, init, goal
    )
    result = solve(algorithm, problem)
    replay(problem, result)
    assert any(fact[0] == "grip" for fact in result.certified) and result.effort.refuted == 0


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_the_type_of_what_the_goal_names_is_not_certified(algorithm: str) -> None:
    """`ready` is unfolded into the goal: that a cup is a thing is no fact of a stream."""
    text = ANYTHING.replace(
        "(:action clean", "(:derived (shiny ?t - thing) (not (dirty ?t))) (:action clean"
    )
    text = text.replace("(dirty ?t - thing)", "(dirty ?t - thing) (shiny ?t - thing)")
    init = "(good cup) (dirty cup)"
    functions = {"sample-grip": lambda thing, call: iter(())}
    problem = stream_task(text, PAIR_STREAMS, functions, {"cup": ("thing",)}, init, "(shiny cup)")
    result = solve(algorithm, problem)
    replay(problem, result)
    assert result.certified == ()
