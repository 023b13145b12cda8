"""Constants of the domain, and types with several parents, stand where objects do."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.stream import Call
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task

DOMAIN = """
(define (domain depots)
  (:requirements :typing)
  (:types crate - (either thing load) thing load site pose - object)
  (:constants depot - site)
  (:predicates (pose ?x - thing ?p - pose ?s - site) (at ?x - thing ?p - pose) (stored ?x - thing))
  (:action store
    :parameters (?x - thing ?p - pose)
    :precondition (pose ?x ?p depot)
    :effect (and (at ?x ?p) (stored ?x))))
"""

STREAMS = """
(define (stream depots)
  (:stream sample-pose
    :inputs (?x ?s) :domain (and ({kind} ?x) (site ?s))
    :outputs (?p) :certified (pose ?x ?p ?s)))
"""


@pytest.mark.parametrize("kind", ["crate", "thing", "load"])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_constant_is_an_input(algorithm: str, kind: str) -> None:
    def sample_pose(thing: str, site: str, call: Call) -> Iterator[tuple[str, str]]:
        yield (thing, site)

    problem = stream_task(
        DOMAIN,
        STREAMS.format(kind=kind),
        {"sample-pose": sample_pose},
        {"box": ("crate",)},
        "",
        "(stored box)",
    )
    result = solve(algorithm, problem, seconds=2.0)
    replay(problem, result)
    assert result.objects.values[result.actions[0].arguments[1]] == ("box", "depot")
