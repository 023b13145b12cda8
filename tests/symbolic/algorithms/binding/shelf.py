"""A thing that is drawn, tested and put: what the tests of skeletons and of their binding share."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

from tamp.stream import Call
from tamp.symbolic.algorithms.adaptive import Adaptive
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.system.deadline import Deadline
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain shelf)
  (:requirements :typing :negative-preconditions)
  (:types cup pose)
  (:predicates (pose ?c - cup ?p - pose) (clear ?c - cup ?p - pose) (at ?c - cup ?p - pose) (put ?c - cup)
               (taken ?c - cup))
  (:action put :parameters (?c - cup ?p - pose) :precondition (and (pose ?c ?p) (clear ?c ?p))
    :effect (and (at ?c ?p) (put ?c)))
  (:action take :parameters (?c - cup ?p - pose) :precondition (at ?c ?p)
    :effect (and (taken ?c) (not (at ?c ?p)))))
"""

STREAMS = """
(define (stream shelf)
  (:stream sample-pose :inputs (?c) :domain (cup ?c) :outputs (?p) :certified (pose ?c ?p))
  (:stream test-clear :inputs (?c ?p) :domain (pose ?c ?p) :certified (clear ?c ?p)))
"""


def poses(cup: str, call: Call) -> Iterator[int]:
    """1, 2, 3, 4: all there are."""
    yield from range(1, 5)


def planned(
    goal: str, clear: Callable[[str, int], bool] = lambda cup, pose: True, cups: str = "tea mug"
) -> tuple[Adaptive, Skeleton]:
    """A run that has searched, and the skeleton of its first plan, not bound yet."""
    functions: dict[str, Callable[..., Any]] = {
        "sample-pose": poses,
        "test-clear": lambda cup, pose, call: clear(cup, pose),
    }
    problem = stream_task(DOMAIN, STREAMS, functions, {name: ("cup",) for name in cups.split()}, "", goal)
    run = Adaptive(problem, lambda key: random.Random(key), Deadline(20.0), lambda effort: None)
    plan = run.search().plan
    assert plan is not None
    return run, run.skeleton(plan)
