"""Streams each of whose outputs feeds thirty more calls: imagining eight levels of them would never end."""

from __future__ import annotations

import pytest

from tamp.pddlstream import PDDLProblem, from_fn, from_test, solve
from tamp.symbolic.algorithms.registry import ALGORITHMS

PLACES = range(5)

DOMAIN = """
(define (domain search)
  (:predicates (Belief ?d) (Place ?l) (Moved ?a ?b ?d ?e) (Looked ?l ?d ?e) (Sure ?d ?l) (Is ?d) (Known ?l))
  (:functions (move-cost ?a ?b) (look-cost ?l ?d))
  (:action move :parameters (?a ?b ?d ?e) :precondition (and (Moved ?a ?b ?d ?e) (Is ?d))
    :effect (and (Is ?e) (not (Is ?d)) (increase (total-cost) (move-cost ?a ?b))))
  (:action look :parameters (?l ?d ?e) :precondition (and (Looked ?l ?d ?e) (Is ?d))
    :effect (and (Is ?e) (not (Is ?d)) (increase (total-cost) (look-cost ?l ?d))))
  (:derived (Known ?l) (exists (?d) (and (Sure ?d ?l) (is ?d)))))
"""

STREAMS = """
(define (stream search)
  (:function (move-cost ?a ?b) (and (Place ?a) (Place ?b)))
  (:function (look-cost ?l ?d) (and (Place ?l) (Belief ?d)))
  (:stream sure :inputs (?d ?l) :domain (and (Belief ?d) (Place ?l)) :outputs () :certified (Sure ?d ?l))
  (:stream after-move :inputs (?a ?b ?d) :domain (and (Place ?a) (Place ?b) (Belief ?d)) :outputs (?e)
    :certified (and (Belief ?e) (Moved ?a ?b ?d ?e)))
  (:stream after-look :inputs (?l ?d) :domain (and (Place ?l) (Belief ?d)) :outputs (?e)
    :certified (and (Belief ?e) (Looked ?l ?d ?e))))
"""

Belief = tuple[float, ...]


def scaled(weights: list[float]) -> Belief:
    return tuple(round(weight / sum(weights), 6) for weight in weights)


def after_look(place: int, belief: Belief) -> tuple[Belief]:
    return (scaled([p * (0.95 if i == place else 0.05) for i, p in enumerate(belief)]),)


def after_move(start: int, end: int, belief: Belief) -> tuple[Belief]:
    weights = list(belief)
    weights[end] += 0.9 * weights[start]
    weights[start] *= 0.1
    return (scaled(weights),)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_two_looks_are_found_among_thousands(algorithm: str) -> None:
    functions = {
        "sure": from_test(lambda belief, place: belief[place] >= 0.9),
        "after-move": from_fn(after_move),
        "after-look": from_fn(after_look),
        "move-cost": lambda start, end: 4.0,
        "look-cost": lambda place, belief: 1.0 / max(belief[place], 0.01),
    }
    start = (0.2,) * len(PLACES)
    init = [("Is", start), ("Belief", start), *(("Place", place) for place in PLACES)]
    solution = solve(
        PDDLProblem(DOMAIN, {}, STREAMS, functions, init, ("Known", 2)), algorithm, max_time=60.0
    )
    assert solution.plan is not None, solution.outcome
    belief = start
    for action in solution.plan:
        assert action.args[-2] == belief
        make = after_look if action.name == "look" else after_move
        assert make(*action.args[:-1]) == (action.args[-1],)
        belief = action.args[-1]
    assert belief[2] >= 0.9
