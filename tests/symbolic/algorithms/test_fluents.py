"""Streams that look at the state: motions that bodies block, and generators that only take advice."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import pytest

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.result import Outcome, Result, StreamTask
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task

CORRIDOR = """
(define (domain corridor)
  (:requirements :typing :negative-preconditions)
  (:types block pose motion)
  (:predicates
    (at ?b - block ?p - pose) (holding ?b - block) (hand-free)
    (pose ?b - block ?p - pose) (aside ?b - block ?p - pose) (way ?b - block ?p - pose ?t - motion))
  (:action pick
    :parameters (?b - block ?p - pose ?t - motion)
    :precondition (and (way ?b ?p ?t) (at ?b ?p) (hand-free))
    :effect (and (holding ?b) (not (at ?b ?p)) (not (hand-free))))
  (:action place
    :parameters (?b - block ?p - pose ?t - motion)
    :precondition (and (aside ?b ?p) (way ?b ?p ?t) (holding ?b))
    :effect (and (at ?b ?p) (hand-free) (not (holding ?b)))))
"""

CORRIDOR_STREAMS = """
(define (stream corridor)
  (:stream sample-aside
    :inputs (?b) :domain (block ?b) :fluents (at)
    :outputs (?p) :certified (and (pose ?b ?p) (aside ?b ?p)))
  (:stream plan-way
    :inputs (?b ?p) :domain (pose ?b ?p) :fluents (at)
    :outputs (?t) :certified (way ?b ?p ?t)))
"""

State = Mapping[str, float]


class Corridor:
    """Blocks one behind the other at 1, 2, 3, ...: the hand comes from 0, and cannot pass a block. Aside is below 0.

    Args:
        count: Of blocks: a, b, c, ...
        goes_on: Whether a motion planner that failed tries again for ever, or ends.
        names_all: Whether it names all blocks in the way, or only the nearest.
    """

    def __init__(self, count: int, *, goes_on: bool = False, names_all: bool = True) -> None:
        self.start = {name: float(i + 1) for i, name in enumerate("abcdefgh"[:count])}
        self.goes_on = goes_on
        self.names_all = names_all
        self.shown: list[tuple[str, State]] = []

    def problem(self, goal: str) -> StreamTask:
        objects = {name: ("block",) for name in self.start} | {
            f"{name}_start": ("pose",) for name in self.start
        }
        return stream_task(
            CORRIDOR,
            CORRIDOR_STREAMS,
            {"sample-aside": self.sample_aside, "plan-way": self.plan_way},
            objects,
            "(hand-free)"
            + "".join(
                f"(at {name} {name}_start) (pose {name} {name}_start)" for name in self.start
            ),
            goal,
            {f"{name}_start": x for name, x in self.start.items()},
        )

    def sample_aside(self, block: str, call: Call) -> Iterator[float]:
        self.shown.append((block, state_of(call)))
        while True:
            yield -call.rng.uniform(1.0, 50.0)

    def plan_way(self, block: str, pose: float, call: Call) -> Iterator[object]:
        state = state_of(call)
        nearer = [other for other, x in sorted(state.items()) if other != block and 0.0 < x < pose]
        while nearer:
            yield Rejection("the way is blocked", tuple(nearer if self.names_all else nearer[:1]))
            if not self.goes_on:
                return
        yield ("way", block, pose, tuple(sorted(state.items())))

    def replay(self, result: Result) -> dict[str, float]:
        """Run the plan; every motion was planned in the very state in which it takes place."""
        state = dict(self.start)
        held = None
        for action in result.actions:
            block, pose, way = (result.objects.values[name] for name in action.arguments)
            assert way == ("way", block, pose, tuple(sorted(state.items())))
            assert not any(0.0 < x < pose for other, x in state.items() if other != block)
            if action.name == "pick":
                assert held is None and state.pop(block) == pose
                held = block
            else:
                assert held == block and pose < 0.0
                held, state[block] = None, pose
        return state


def state_of(call: Call) -> dict[str, float]:
    assert all(fact[0] == "at" and isinstance(fact[2], float) for fact in call.fluents)
    return {fact[1]: fact[2] for fact in call.fluents}


@pytest.mark.parametrize("names_all", [True, False])
@pytest.mark.parametrize("goes_on", [False, True])
@pytest.mark.parametrize("count", [1, 2, 3, 4])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_blockers_are_moved_first(
    algorithm: str, count: int, goes_on: bool, names_all: bool
) -> None:
    corridor = Corridor(count, goes_on=goes_on, names_all=names_all)
    last = list(corridor.start)[-1]
    problem = corridor.problem(f"(holding {last})")
    result = solve(algorithm, problem)
    replay(problem, result)
    corridor.replay(result)
    assert [action.arguments[0] for action in result.actions if action.name == "pick"] == list(
        corridor.start
    )
    assert result.effort.searches <= 20 * count


def test_motion_into_a_wall_is_given_up() -> None:
    """Nothing that can be moved is to blame, and the planner ends: no plan, soon."""
    corridor = Corridor(1)

    def plan_way(block: str, pose: float, call: Call) -> Iterator[Rejection]:
        yield Rejection("hits the wall")

    problem = corridor.problem("(holding a)")
    problem = StreamTask(
        problem.task,
        tuple(
            replace(stream, function=plan_way) if stream.name == "plan-way" else stream
            for stream in problem.streams
        ),
        problem.values,
    )
    result = solve("adaptive", problem, seconds=4.0)
    assert result.outcome in (Outcome.INFEASIBLE, Outcome.EXHAUSTED), (
        result.outcome,
        result.effort,
    )
    text = " ".join(result.explanation)
    assert "hits the wall" in text and "pick a: plan-way" in text


def test_advice_shows_where_the_other_bodies_are() -> None:
    """The poses that a generator is shown are values: those of the start, or those drawn earlier in the plan."""
    corridor = Corridor(3, goes_on=True)
    problem = corridor.problem("(holding c)")
    result = solve("adaptive", problem)
    replay(problem, result)
    final = corridor.replay(result)
    asked = [
        (block, state)
        for block, state in corridor.shown
        if block == "b" and state.get("a") == final["a"]
    ]
    assert asked, "nobody asked where to put b after a was put aside"
    assert all(state["c"] == 3.0 for _, state in asked)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_advice_is_taken_from_any_state(algorithm: str) -> None:
    """What an advisory stream yields in one state may be used in another: one value of each block is enough."""
    corridor = Corridor(2, goes_on=True)
    left = {"a": 1, "b": 1}

    def sample_aside(block: str, call: Call) -> Iterator[float]:
        if left[block]:
            left[block] -= 1
            yield -5.0

    problem = corridor.problem("(holding b)")
    problem = StreamTask(
        problem.task,
        tuple(
            replace(s, function=sample_aside) if s.name == "sample-aside" else s
            for s in problem.streams
        ),
        problem.values,
    )
    result = solve(algorithm, problem, seconds=4.0)
    replay(problem, result)
    corridor.replay(result)
