"""Which calls a plan needs, and which of their values have to be the same."""

from __future__ import annotations

import random
from collections.abc import Iterator

from tamp.stream import Call
from tamp.symbolic.algorithms.adaptive import start_adaptive
from tamp.symbolic.algorithms.planning_run import search_plan, skeleton_of
from tamp.system.deadline import Deadline
from tests.symbolic.algorithms.binding.shelf import planned
from tests.symbolic.algorithms.toys import stream_task


def test_a_value_is_drawn_tested_and_used() -> None:
    _, skeleton = planned("(put tea)")
    drawn, tested = skeleton.nodes
    assert (drawn.stream.name, tested.stream.name) == ("sample-pose", "test-clear")
    (pose,) = drawn.outputs
    assert drawn.inputs == ("tea",) and tested.inputs == ("tea", pose)
    assert skeleton.actions == (("put", ("tea", pose)),)
    assert set(skeleton.certified) >= {("pose", ("tea", pose)), ("clear", ("tea", pose))}


def test_what_stays_in_the_state_is_the_same_value() -> None:
    _, skeleton = planned("(taken tea)")
    (put, (_, pose)), (take, (_, taken)) = skeleton.actions
    assert (put, take) == ("put", "take") and pose == taken
    assert len(skeleton.nodes) == 2


def test_things_of_their_own_have_values_of_their_own() -> None:
    _, skeleton = planned("(and (put tea) (put mug))")
    (_, (first, one)), (_, (second, other)) = skeleton.actions
    assert {first, second} == {"tea", "mug"} and one != other
    assert sum(node.stream.name == "sample-pose" for node in skeleton.nodes) == 2


def test_a_test_comes_as_soon_as_its_inputs_are_there() -> None:
    _, skeleton = planned("(and (put tea) (put mug))")
    known: set[int] = set()
    waiting = [node for node in skeleton.nodes if node.stream.is_test]
    for node in skeleton.nodes:
        assert {term for term in node.inputs if isinstance(term, int)} <= known
        ready = [
            one
            for one in waiting
            if {term for term in one.inputs if isinstance(term, int)} <= known
        ]
        assert node.stream.is_test or not ready
        waiting = [one for one in waiting if one is not node]
        known.update(node.outputs)


GUARD = """
(define (domain guard)
  (:requirements :adl)
  (:types spot grip)
  (:constants s - spot)
  (:predicates (grip ?s - spot ?g - grip) (firm ?g - object ?s - spot) (on ?s - spot) (held ?g - grip))
  (:action lift :parameters (?s - spot) :precondition (firm s s) :effect (on ?s))
  (:action hold :parameters (?g - grip ?s - spot)
    :precondition (and (firm ?g ?s) (forall (?q - spot) (imply (on ?q) (firm ?g s)))) :effect (held ?g)))
"""

GUARD_STREAMS = """
(define (stream guard)
  (:stream sample-grip :inputs (?s) :domain (spot ?s) :outputs (?g) :certified (grip ?s ?g))
  (:stream test-firm :inputs (?s ?g) :domain (grip ?s ?g) :certified (firm ?g ?s)))
"""


def test_what_is_asked_for_and_lifts_a_guard_as_well_is_one_value() -> None:
    def grips(spot: str, call: Call) -> Iterator[int]:
        yield from range(5)

    functions = {"sample-grip": grips, "test-firm": lambda spot, grip, call: grip == 3}
    goal = "(exists (?g - grip) (held ?g))"
    problem = stream_task(GUARD, GUARD_STREAMS, functions, {}, "(on s)", goal)
    run = start_adaptive(
        problem, lambda key: random.Random(key), Deadline(20.0), lambda effort: None
    )
    found = search_plan(run)
    assert found is not None
    skeleton = skeleton_of(run, found)
    assert [node.stream.name for node in skeleton.nodes] == ["sample-grip", "test-firm"]
    assert skeleton.actions[0][1][0] == skeleton.nodes[0].outputs[0]
