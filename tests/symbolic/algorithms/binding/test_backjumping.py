"""A failure goes back to the choice that it depends on, past those that it does not."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest

from tamp.stream import Call, Rejection
from tests.symbolic.algorithms.toys import replay, solve, stream_task

DOMAIN = """
(define (domain choices)
  (:requirements :typing)
  (:types slot number view)
  (:predicates (choice ?s - slot ?n - number) (chosen ?s - slot ?n - number) (filled ?s - slot) (next ?s ?s2 - slot)
               (view ?s - slot ?n - number ?v - view) (seen) (ready ?s - slot))
  (:action choose
    :parameters (?before ?s - slot ?n - number)
    :precondition (and (next ?before ?s) (filled ?before) (choice ?s ?n))
    :effect (and (chosen ?s ?n) (filled ?s)))
  (:action look
    :parameters (?first ?last - slot ?n - number ?v - view)
    :precondition (and (ready ?first) (ready ?last) (filled ?last) (chosen ?first ?n) (view ?first ?n ?v))
    :effect (seen)))
"""

STREAMS = """
(define (stream choices)
  (:stream draw :inputs (?s) :domain (slot ?s) :outputs (?n) :certified (choice ?s ?n))
  (:stream find-view :inputs (?s ?n) :domain (choice ?s ?n) {fluents} :outputs (?v) :certified (view ?s ?n ?v)))
"""


@pytest.mark.parametrize("fluents", ["", ":fluents (chosen)"])
@pytest.mark.parametrize("slots", [4, 8, 16])
def test_choices_in_between_are_not_searched(slots: int, fluents: str) -> None:
    """The view of the first slot's number is asked for last, and exists from the fifth number on only."""

    def draw(slot: str, call: Call) -> Iterator[int]:
        yield from itertools.count(1)

    def find_view(slot: str, number: int, call: Call) -> Iterator[object]:
        yield ("view", number) if number >= 5 else Rejection("too dark", (slot,))

    names = [f"s{i}" for i in range(slots + 1)]
    init = "(filled s0) (ready s1)" + "".join(
        f"(next {a} {b})" for a, b in itertools.pairwise(names)
    )
    problem = stream_task(
        DOMAIN,
        STREAMS.format(fluents=fluents),
        {"draw": draw, "find-view": find_view},
        dict.fromkeys(names, ("slot",)),
        init + f"(ready {names[-1]})",
        "(seen)",
    )
    result = solve("adaptive", problem)
    replay(problem, result)
    assert result.actions[-1].name == "look"
    assert result.objects.values[result.actions[-1].arguments[3]] == ("view", 5)
    assert result.effort.draws <= 25 * slots
