"""Plans that get better: fewer actions once they are possible, better values at once, never a worse plan."""

from __future__ import annotations

import random
from collections.abc import Iterator

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.anytime import solve_anytime
from tamp.symbolic.algorithms.result import Outcome, Result, StreamTask
from tamp.system.deadline import Deadline, OutOfTime
from tests.symbolic.algorithms.toys import replay, stream_task

DOMAIN = """
(define (domain detour)
  (:requirements :typing)
  (:types ticket way)
  (:predicates (ticket ?t - ticket) (way ?w - way) (short ?t - ticket) (at-start) (half ?w - way) (there ?w - way))
  (:action leap :parameters (?t - ticket ?w - way) :precondition (and (at-start) (short ?t) (way ?w))
    :effect (and (there ?w) (not (at-start))))
  (:action step :parameters (?w - way) :precondition (and (at-start) (way ?w))
    :effect (and (half ?w) (not (at-start))))
  (:action step-again :parameters (?w - way) :precondition (half ?w) :effect (there ?w)))
"""

STREAMS = """
(define (stream detour)
  (:stream draw-way :outputs (?w) :certified (way ?w))
  (:stream draw-ticket :outputs (?t) :certified (ticket ?t))
  (:stream test-short :inputs (?t) :domain (ticket ?t) :certified (short ?t)))
"""


def detour(valid: int) -> StreamTask:
    """One action where the `valid`-th ticket is drawn, two without any; ways have lengths."""

    def draw_way(call: Call) -> Iterator[int]:
        while True:
            yield call.rng.randrange(1000)

    def draw_ticket(call: Call) -> Iterator[int]:
        number = 0
        while True:
            number += 1
            yield number

    def test_short(ticket: int, call: Call) -> bool | Rejection:
        return True if ticket == valid else Rejection("expired")

    functions = {"draw-way": draw_way, "draw-ticket": draw_ticket, "test-short": test_short}
    return stream_task(
        DOMAIN, STREAMS, functions, {}, "(at-start)", "(exists (?w - way) (there ?w))"
    )


def run(
    problem: StreamTask, seed: int = 0, most: int = 60
) -> tuple[list[tuple[float, int]], list[float], Result]:
    """The improvements as (cost, length of the way), the lower bounds that were told, and the best result."""
    steps: list[tuple[float, int]] = []
    bounds: list[float] = []
    best: list[Result] = []
    told = 0

    def better(result: Result) -> bool:
        nonlocal told
        told += 1
        if told > most:
            raise OutOfTime
        replay(problem, result)
        value = next(
            result.objects.values[name]
            for name in result.actions[-1].arguments
            if name.startswith("w")
        )
        rank = sum(action.cost for action in result.actions), value
        if steps and rank >= steps[-1]:
            return False
        steps.append(rank)
        best[:] = [result]
        return True

    try:
        result = solve_anytime(
            problem,
            lambda key: random.Random(f"{seed} {key}"),
            Deadline(30.0),
            lambda effort: None,
            better,
            bounds.append,
            random.Random(seed),
        )
        assert result.outcome is not Outcome.SOLVED
        return steps, bounds, result
    except OutOfTime:
        return steps, bounds, best[0]


def test_a_plan_with_fewer_actions_is_found_once_it_is_possible() -> None:
    steps, bounds, result = run(detour(valid=30))
    assert steps[0][0] == 2.0 and bounds == [1.0]
    assert [action.name for action in result.actions] == ["leap"]


def test_values_are_drawn_anew_for_the_same_actions() -> None:
    steps, bounds, _ = run(detour(valid=-1))
    assert {cost for cost, _ in steps} == {2.0} and bounds == [1.0]
    lengths = [length for _, length in steps]
    assert len(lengths) > 2 and lengths == sorted(lengths, reverse=True) and lengths[-1] < 100


def test_the_same_seed_improves_in_the_same_steps() -> None:
    assert run(detour(valid=20), seed=3)[:2] == run(detour(valid=20), seed=3)[:2]


def test_without_a_plan_there_is_nothing_to_improve() -> None:
    problem = detour(valid=1)
    hopeless = StreamTask(problem.task, (), {})
    steps, bounds, result = run(hopeless)
    assert not steps and not bounds and result.outcome is Outcome.INFEASIBLE
