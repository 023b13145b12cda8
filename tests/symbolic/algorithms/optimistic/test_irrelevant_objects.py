"""What the goal does not name is left alone, until it is in the way or the only way."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from typing import Any

from tamp.pddlstream import PDDLProblem, from_gen_fn, from_test
from tamp.pddlstream.problem import bind
from tamp.planner.assembly import random_streams
from tamp.symbolic.algorithms.adaptive import plan_adaptively, start_adaptive
from tamp.symbolic.algorithms.planning_run import Run
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.deadline import Deadline

DOMAIN = """
(define (domain pegs)
  (:predicates (Peg ?b) (Hole ?h) (Spot ?b ?p) (In ?p ?h) (Free ?b ?p ?o ?q) (At ?b ?p) (Stored ?b ?h) (Blocked ?b ?p)
    (Weighed) (Handle ?b ?x))
  (:constants box)
  (:action move :parameters (?b ?p ?q ?x)
    :precondition (and (Handle ?b ?x) (Spot ?b ?q) (At ?b ?p) (not (Blocked ?b ?q)))
    :effect (and (At ?b ?q) (not (At ?b ?p))))
  (:action weigh :parameters (?b) :precondition (and (Peg ?b) (Stored ?b box)) :effect (Weighed))
  (:derived (Stored ?b ?h) (exists (?p) (and (At ?b ?p) (In ?p ?h))))
  (:derived (Blocked ?b ?p)
    (exists (?o ?q) (and (Spot ?o ?q) (At ?o ?q) (not (= ?o ?b)) (Spot ?b ?p) (not (Free ?b ?p ?o ?q))))))
"""

STREAMS = """
(define (stream pegs)
  (:stream spot :inputs (?b ?h) :domain (and (Peg ?b) (Hole ?h)) :outputs (?p)
    :certified (and (Spot ?b ?p) (In ?p ?h)))
  (:stream free :inputs (?b ?p ?o ?q) :domain (and (Spot ?b ?p) (Spot ?o ?q)) :certified (Free ?b ?p ?o ?q)))
"""


class World:
    """Pegs in holes, no two in one place; `asked` are the pegs whose places were asked for."""

    def __init__(self, at: dict[str, tuple[str, int]], room: int) -> None:
        self.asked: set[str] = set()
        self.at = at
        self.room = room

    def spot(self, peg: str, hole: str) -> Iterator[tuple[tuple[str, int]]]:
        self.asked.add(peg)
        places = count() if hole == "floor" else range(self.room)
        yield from (((hole, place),) for place in places)

    def run(self, goal: tuple[Any, ...], fixed: tuple[str, ...] = ()) -> tuple[Run, Outcome]:
        init = [
            ("Hole", "box"),
            ("Hole", "floor"),
            *(("Handle", peg, "knob") for peg in self.at if peg not in fixed),
        ]
        for peg, place in self.at.items():
            init += [
                ("Peg", peg),
                ("Spot", peg, place),
                ("At", peg, place),
                ("In", place, place[0]),
            ]
        functions = {"spot": from_gen_fn(self.spot), "free": from_test(lambda b, p, o, q: p != q)}
        task = bind(PDDLProblem(DOMAIN, {}, STREAMS, functions, init, goal)).task
        run = start_adaptive(task, random_streams(0), Deadline(20.0), lambda effort: None)
        return run, plan_adaptively(run).outcome


def left(run: Run) -> set[Any]:
    return {run.task.problem.values[name] for name in run.knowledge.excluded_objects}


def test_what_stands_by_is_left_alone() -> None:
    world = World({f"b{i}": ("floor", i) for i in range(10)}, room=4)
    run, outcome = world.run(("Stored", "b0", "box"))
    assert outcome is Outcome.SOLVED
    assert world.asked == {"b0"}
    assert left(run) == {f"b{i}" for i in range(1, 10)}


def test_what_is_in_the_way_is_moved() -> None:
    """The box has room for one, and another peg is in it; the third is far away."""
    world = World({"b0": ("floor", 0), "b1": ("box", 0), "b3": ("floor", 3)}, room=1)
    run, outcome = world.run(("Stored", "b0", "box"))
    assert outcome is Outcome.SOLVED
    assert world.asked == {"b0", "b1"}
    assert left(run) == {"b3"}


def test_what_is_the_only_way_is_found() -> None:
    """Some peg has to be weighed in the box, and the one that the goal names cannot be moved."""
    world = World({"b0": ("floor", 0), "b1": ("floor", 1)}, room=2)
    run, outcome = world.run(("and", ("Weighed",), ("Stored", "b0", "floor")), fixed=("b0",))
    assert outcome is Outcome.SOLVED
    assert world.asked == {"b1"} and not run.knowledge.excluded_objects
    run, outcome = world.run(("and", ("Weighed",), ("Stored", "b0", "floor")), fixed=("b0", "b1"))
    assert outcome is not Outcome.SOLVED
