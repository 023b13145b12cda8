"""A derived precondition over what a stream gave: the value that is there is the value that was tested."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.stream import Call
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task

DOMAIN = """
(define (domain cups)
  (:requirements :typing :derived-predicates)
  (:types cup pose)
  (:predicates (pose ?c - cup ?p - pose) (stood ?c - cup ?p - pose) (at ?c - cup ?p - pose) (upright ?c - cup)
               (drunk ?c - cup))
  (:derived (upright ?c - cup) (exists (?p - pose) (and (stood ?c ?p) (at ?c ?p))))
  (:action put :parameters (?c - cup ?p - pose) :precondition (pose ?c ?p) :effect (at ?c ?p))
  (:action drink :parameters (?c - cup) :precondition (upright ?c) :effect (drunk ?c)))
"""

STREAMS = """
(define (stream cups)
  (:stream sample-pose :inputs (?c) :domain (cup ?c) :outputs (?p) :certified (pose ?c ?p))
  (:stream test-upright :inputs (?c ?p) :domain (pose ?c ?p) :certified (stood ?c ?p)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("good", [1, 3])
def test_what_is_put_down_is_what_was_tested(algorithm: str, good: int) -> None:
    def poses(cup: str, call: Call) -> Iterator[int]:
        yield from range(1, 5)

    def upright(cup: str, pose: int, call: Call) -> bool:
        return pose == good

    functions = {"sample-pose": poses, "test-upright": upright}
    problem = stream_task(DOMAIN, STREAMS, functions, {"tea": ("cup",)}, "", "(drunk tea)")
    result = solve(algorithm, problem)
    replay(problem, result)
    assert [result.objects.values[name] for name in result.actions[0].arguments] == ["tea", good]
