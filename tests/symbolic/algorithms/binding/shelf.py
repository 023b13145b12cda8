"""A thing that is drawn, tested and put: what the tests of skeletons and of their binding share."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

from tamp.stream import Call
from tamp.symbolic.algorithms.adaptive import start_adaptive
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.planning_run import Run, search_plan, skeleton_of
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
) -> tuple[Run, Skeleton]:
    """A run that has searched, and the skeleton of its first plan, not bound yet."""
    functions: dict[str, Callable[..., Any]] = {
        "sample-pose": poses,
        "test-clear": lambda cup, pose, call: clear(cup, pose),
    }
    problem = stream_task(
        DOMAIN, STREAMS, functions, {name: ("cup",) for name in cups.split()}, "", goal
    )
    run = start_adaptive(
        problem, lambda key: random.Random(key), Deadline(20.0), lambda effort: None
    )
    found = search_plan(run)
    assert found is not None
    return run, skeleton_of(run, found)
